#pragma once

#include <string>
#include <vector>

#include "tests/host/planner/planar/slow/search.hpp"

namespace pinjaw::planner::slow {

/// What came of laying the planner's list beside the slow search's. Fixtures are alike by holes and pose.
struct Tally {
  int parts = 0;
  int fixtures = 0;     ///< listed by the planner and confirmed by the definition, or borderline
  int borderlines = 0;  ///< poses in one list only that rounding decides
  int overlooked = 0;   ///< confirmed by the definition, but not found by the slow search
  std::vector<std::string> disagreements;  ///< a sentence each

  Tally& operator+=(const Tally& other);
};

/// Every pose of the slow search must be in `ours` with the least of its labels, every fixture of `ours` must
/// be one by the definition, be told canonically, and none may be there twice.
Tally compare(const Task& task, const std::vector<PlanarFixture>& ours, const std::string& name);

}  // namespace pinjaw::planner::slow
