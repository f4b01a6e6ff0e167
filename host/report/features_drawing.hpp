#pragma once

#include <string>
#include <vector>

#include "host/model/feature.hpp"

namespace pinjaw::report {

/// What a features drawing shows, all in plan, in the part frame turned by the task's side.
struct FeaturesDrawing {
  std::string title;
  std::vector<model::Feature> features;
  std::vector<geometry::Curve> seen_from_gripper;  ///< outline as the gripper sees it
  double pin_radius_mm = 0;
};

/// An SVG at 1:1 mm: the outline thin and grey; each feature bold where a closed pin has room, dashed where
/// not, with its number; a scale bar. A pin is drawn for size.
std::string features_svg(const FeaturesDrawing& drawing);

}  // namespace pinjaw::report
