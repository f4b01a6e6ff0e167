#include "host/planner/features/features.hpp"

#include <algorithm>
#include <cmath>

#include "host/planner/features/carrier.hpp"
#include "host/planner/features/projection.hpp"
#include "host/planner/features/reach.hpp"
#include "host/planner/features/visibility.hpp"

namespace pinjaw::planner {
namespace {

/// A feature shorter than eps is no edge of its own.
constexpr double kLeastFeatureMm = model::kEps_mm;

/// A drawing shows a step from this height on.
constexpr double kDrawnStepMm = 0.1;

/// The visible stretches of one carrier, joined, and where its edgelets end.
struct VisibleCarrier {
  std::vector<Stretch> stretches;
  std::vector<double> splits_mm;
};

VisibleCarrier visible_on(const std::vector<Carrier>& carriers, std::size_t which,
                          const Projection& projection, const geometry::Surface& surface,
                          double engagement_mm, FeatureCounts& counts) {
  VisibleCarrier result;
  result.splits_mm = split_positions_mm(carriers, which, projection.others);
  std::vector<Stretch> stretches;
  for (std::size_t i = 1; i < result.splits_mm.size(); ++i) {
    const geometry::Interval edgelet_mm{result.splits_mm[i - 1], result.splits_mm[i]};
    if (!carriers[which].covers((edgelet_mm.lo + edgelet_mm.hi) / 2, 0)) continue;
    ++counts.edgelets;
    const auto found = jumping_stretches(surface, carriers[which], edgelet_mm, engagement_mm);
    if (!found.empty()) ++counts.visible;
    stretches.insert(stretches.end(), found.begin(), found.end());
  }
  result.stretches = joined(std::move(stretches), carriers[which]);
  return result;
}

model::Feature feature_of(const Carrier& carrier, const Stretch& stretch) {
  model::Feature feature;
  feature.curve = carrier.curve_over(stretch.along_mm, stretch.side);
  feature.bulge =
      carrier.round && stretch.side == FreeSide::Left ? model::Bulge::Concave : model::Bulge::Convex;
  double middle_mm = (stretch.along_mm.lo + stretch.along_mm.hi) / 2;
  if (carrier.round && middle_mm > carrier.circumference_mm()) middle_mm -= carrier.circumference_mm();
  if (const Piece* piece = carrier.piece_at(middle_mm)) {
    feature.edge = piece->source;
    feature.approximate = piece->approximate;
  }
  return feature;
}

/// Split positions of the carrier as arc lengths on the feature.
std::vector<double> breaks_on(const Carrier& carrier, const Stretch& stretch,
                              const std::vector<double>& splits_mm) {
  std::vector<double> breaks_mm;
  for (const double split_mm : splits_mm) {
    const bool backwards = !carrier.round && stretch.side == FreeSide::Left;
    breaks_mm.push_back(backwards ? stretch.along_mm.hi - split_mm : split_mm - stretch.along_mm.lo);
    if (carrier.round) breaks_mm.push_back(split_mm + carrier.circumference_mm() - stretch.along_mm.lo);
  }
  return breaks_mm;
}

Features features_of_profile(const model::Profile& profile) {
  Features result;
  result.features = model::features_of(profile);
  const int count = static_cast<int>(result.features.size());
  result.counts.candidates = count;
  result.counts.edgelets = count;
  result.counts.visible = count;
  result.counts.features = count;
  result.counts.reachable = count;
  return result;
}

std::vector<geometry::Curve> steps_seen(const part::Part& part) {
  FeatureCounts counts;
  Projection projection = projected(part, counts);
  for (const auto& chords : projection.others) {
    for (std::size_t i = 1; i < chords.size(); ++i) {
      if ((chords[i] - chords[i - 1]).norm() < kSameCarrierMm) continue;
      projection.curves.push_back({geometry::Segment{chords[i - 1], chords[i]}, 0, false, true});
    }
  }
  projection.others.clear();
  const auto carriers = carriers_of(projection.curves);
  std::vector<geometry::Curve> curves;
  for (std::size_t i = 0; i < carriers.size(); ++i) {
    const auto visible = visible_on(carriers, i, projection, part.surface, kDrawnStepMm, counts);
    for (const Stretch& stretch : visible.stretches) {
      curves.push_back(carriers[i].curve_over(stretch.along_mm, stretch.side));
    }
  }
  return curves;
}

}  // namespace

Features find_features(const part::Part& part, const model::PinStock& pins) {
  if (part.profile) return features_of_profile(*part.profile);
  Features result;
  FeatureCounts& counts = result.counts;
  const Projection projection = projected(part, counts);
  const auto carriers = carriers_of(projection.curves);
  for (std::size_t i = 0; i < carriers.size(); ++i) {
    const auto visible = visible_on(carriers, i, projection, part.surface, pins.min_engagement_mm, counts);
    for (const Stretch& stretch : visible.stretches) {
      if (stretch.along_mm.length() < kLeastFeatureMm) {
        ++counts.too_short;
        continue;
      }
      model::Feature feature = feature_of(carriers[i], stretch);
      feature.id = static_cast<int>(result.features.size());
      feature.reach_mm =
          reach_of(feature, breaks_on(carriers[i], stretch, visible.splits_mm), part.surface, pins);
      if (!feature.reach_mm.empty()) ++counts.reachable;
      result.features.push_back(std::move(feature));
    }
  }
  counts.features = static_cast<int>(result.features.size());
  return result;
}

Outlines outlines(const part::Part& part) {
  Outlines result;
  result.from_below = steps_seen(part);
  for (const geometry::Curve& curve : steps_seen(part::turned(part, model::Side::Above))) {
    result.from_above.push_back(part::mirrored(curve, 0));
  }
  return result;
}

}  // namespace pinjaw::planner
