#pragma once

#include <string>
#include <vector>

#include "host/model/kit.hpp"
#include "host/model/profile.hpp"

namespace pinjaw::planner {

/// One pin of a known case: the profile's edge it touches and its canonical hole.
struct KnownPin {
  model::Hole hole;
  int loop = 0;
  int edge = 0;
  friend auto operator<=>(const KnownPin&, const KnownPin&) = default;
};

struct KnownFixture {
  std::string split;
  double theta_rad = 0;
  double span_mm = 0;
  bool borderline = false;     ///< a margin under 1e-5: may be in a list or not
  std::vector<KnownPin> pins;  ///< sorted
};

struct KnownCase {
  model::Profile profile;
  model::Kit kit;
  std::vector<KnownFixture> fixtures;
};

/// Reads tests/host/planner/planar/cases/NAME; throws where the files are not as they were copied.
KnownCase read_case(const std::string& name);

/// The loop through `points`, counter-clockwise for an outer loop.
std::vector<model::ProfileEdge> polygon(const std::vector<geometry::Vector2d>& points);

}  // namespace pinjaw::planner
