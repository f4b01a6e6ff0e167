#include "host/model/feature.hpp"

namespace pinjaw::model {

geometry::Vector2d outward_normal_at(const Feature& feature, double along_mm) {
  const geometry::Vector2d t = geometry::tangent_at(feature.curve, along_mm);
  const geometry::Vector2d right(t.y(), -t.x());
  return feature.bulge == Bulge::Convex ? right : geometry::Vector2d(-right);
}

}  // namespace pinjaw::model
