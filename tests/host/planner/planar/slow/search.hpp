#pragma once

#include <vector>

#include "tests/host/planner/planar/slow/stand.hpp"

namespace pinjaw::planner::slow {

/// A fixture or what is one but for rounding, canonical.
struct Found {
  Stand stand;
  Verdict verdict;
};

/// What a slow search of another design finds: every jaw's pairs of pins as ladders that slide along the
/// standing part; where a left and a right ladder lean alike and stand a whole number of rows apart, or a
/// third pin of a ladder's jaw meets a feature, the pins are settled and judged by the definition. No
/// symmetry is used: all theta, both jaws. Once for each labelling; sorted by holes, features, theta.
/// It may miss fixtures that lie within a chord (0.05 mm) of a turning point.
std::vector<Found> search(const Task& task);

}  // namespace pinjaw::planner::slow
