#include "host/model/profile.hpp"

namespace pinjaw::model {

std::vector<Feature> features_of(const Profile& profile) {
  std::vector<Feature> features;
  for (std::size_t loop = 0; loop < profile.loops.size(); ++loop) {
    for (std::size_t edge = 0; edge < profile.loops[loop].size(); ++edge) {
      const ProfileEdge& from = profile.loops[loop][edge];
      if (!from.graspable) continue;
      Feature feature;
      feature.id = static_cast<int>(features.size());
      feature.loop = static_cast<int>(loop);
      feature.edge = static_cast<int>(edge);
      feature.curve = from.curve;
      feature.bulge = from.reversed ? Bulge::Concave : Bulge::Convex;
      feature.reach_mm = {{0, geometry::length_mm(from.curve)}};
      features.push_back(feature);
    }
  }
  return features;
}

}  // namespace pinjaw::model
