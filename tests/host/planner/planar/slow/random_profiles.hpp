#pragma once

#include <span>

#include "host/base/random.hpp"
#include "host/model/kit.hpp"
#include "host/model/profile.hpp"

namespace pinjaw::planner::slow {

/// One kind of small part, some 25 to 45 mm across, made at random.
struct Family {
  const char* name;
  /// Measures are round on purpose (multiples of the spacing, axis-aligned, exactly as wide as a pin), so
  /// that feet stand exactly at ends and pins touch two walls.
  bool degenerate;
  model::Profile (*make)(base::Random& random, const model::Kit& kit);
};

std::span<const Family> families();

/// A kit of 2 or 3 columns and 3 to 5 rows on an 11 mm grid, with pins of 2 to 3 mm; sometimes with a jaw
/// range or a foot margin that leaves fixtures out.
model::Kit random_kit(base::Random& random);

}  // namespace pinjaw::planner::slow
