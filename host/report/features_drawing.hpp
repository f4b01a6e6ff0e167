#pragma once

#include <string>
#include <vector>

#include "host/model/feature.hpp"
#include "host/report/sheet.hpp"

namespace pinjaw::report {

/// What a features drawing shows, all in plan, in the part frame turned by the task's side.
struct FeaturesDrawing {
  std::string title;
  std::vector<model::Feature> features;
  std::vector<SheetEdge> edges;  ///< of the part; those seen from below are drawn
  double pin_radius_mm = 0;
};

/// An SVG at 1:1 mm: the edges that the gripper sees thin and grey; each feature bold where a closed pin has
/// room, dashed where not, with its number where that is shorter than the feature; a scale bar. A pin is
/// drawn for size.
std::string features_svg(const FeaturesDrawing& drawing);

}  // namespace pinjaw::report
