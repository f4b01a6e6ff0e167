#pragma once

#include <vector>

#include "host/model/feature.hpp"
#include "host/model/kit.hpp"
#include "host/model/tolerance.hpp"
#include "host/part/part.hpp"
#include "host/planner/features/fate.hpp"

namespace pinjaw::planner {

/// Where the edges, walls and silhouettes of a part went in phase 1, and how many pieces of them it looked
/// at.
struct FeatureCounts {
  FateCounts edges;  ///< all edges of the file, or of the profile
  FateCounts walls;
  FateCounts silhouettes;
  FateCounts contours;  ///< of a mesh, which has nothing else: its chained and fitted edges
  int edgelets = 0;     ///< pieces between intersections, coincident ones once
  int visible = 0;      ///< edgelets with some length that jumps by the engagement
  int too_short = 0;    ///< joined stretches shorter than eps, left out
  int features = 0;     ///< after adjacent survivors are joined
  int reachable = 0;    ///< features with room for a closed pin somewhere
  friend bool operator==(const FeatureCounts&, const FeatureCounts&) = default;
};

struct Features {
  std::vector<model::Feature> features;  ///< all, reachable or not; id = position
  FeatureCounts counts;
};

/// Phase 1 (DESIGN 3, BB 3.3): the edges of `part`, as its gripper sees it, that a pin of this stock can
/// touch.
///
/// On a CAD part each feature's `reach_mm` is where a closed pin has room (DESIGN 3.1 no. 4). On a profile
/// the features are model::features_of, reachable over their whole length.
Features find_features(const part::Part& part, const model::PinStock& pins);

}  // namespace pinjaw::planner
