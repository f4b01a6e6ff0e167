#pragma once

#include <variant>

#include "host/geometry/surface.hpp"

namespace pinjaw::geometry {

/// An upright cylinder, or what it sweeps when it moves sideways: a plan region times a z interval.
struct SweptCylinder {
  Sweep plan;
  Interval z_mm;  ///< an end may be infinite
};

/// An upright block: a plan rectangle times a z interval.
struct Block {
  Rectangle plan;
  Interval z_mm;  ///< an end may be infinite
};

using Solid = std::variant<SweptCylinder, Block>;

enum class Overlap {
  Apart,
  Overlapping,
  Undecided,  ///< the iterations ran out; to be treated as overlapping
};

/// Distance in plan between two shapes; 0 where they touch or overlap.
double plan_distance_mm(const Sweep& a, const Sweep& b);
double plan_distance_mm(const Sweep& a, const Rectangle& b);

/// Whether two solids overlap (libccd's GJK: of libccd's two algorithms the one that bounds its iterations).
/// Apart is only said with a separating plane that was checked. Solids that only touch may be reported either
/// way.
Overlap overlap(const Solid& a, const Solid& b);

/// Chosen: over twice what the hardest took of 800 000 random pairs, half of them within 1e-5 mm of touching
/// (85).
inline constexpr unsigned long kOverlapIterations = 200;

}  // namespace pinjaw::geometry
