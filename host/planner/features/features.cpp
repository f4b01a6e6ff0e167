#include "host/planner/features/features.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <tuple>

#include "host/planner/features/carrier.hpp"
#include "host/planner/features/projection.hpp"
#include "host/planner/features/reach.hpp"
#include "host/planner/features/visibility.hpp"

namespace pinjaw::planner {
namespace {

/// A feature shorter than eps is no edge of its own.
constexpr double kLeastFeatureMm = model::kEps_mm;

/// A drawing shows a step from this height on.

/// A piece of a carrier between two splits; why it has no visible stretch, if it has none.
struct Edgelet {
  geometry::Interval along_mm;
  std::vector<const PlanCurve*> curves;  ///< that cover it, the lowest first
  std::optional<Fate> left_out;
};

/// One carrier cut into edgelets, and its visible stretches, joined.
struct SeenCarrier {
  std::vector<double> splits_mm;
  std::vector<Edgelet> edgelets;
  std::vector<Stretch> stretches;
};

SeenCarrier seen(const std::vector<Carrier>& carriers, std::size_t which, const geometry::Surface& surface,
                 double engagement_mm) {
  const Carrier& carrier = carriers[which];
  SeenCarrier result;
  result.splits_mm = split_positions_mm(carriers, which);
  std::vector<Stretch> stretches;
  for (std::size_t i = 1; i < result.splits_mm.size(); ++i) {
    Edgelet edgelet{{result.splits_mm[i - 1], result.splits_mm[i]}, {}, {}};
    const double middle_mm = (edgelet.along_mm.lo + edgelet.along_mm.hi) / 2;
    edgelet.curves = carrier.curves_at(middle_mm);
    if (edgelet.curves.empty()) continue;
    const auto z_mm = [p_mm = carrier.point_at(middle_mm)](const PlanCurve* curve) {
      return z_near_mm(*curve, p_mm);
    };
    std::ranges::stable_sort(edgelet.curves, {}, z_mm);
    const auto found = jumping_stretches(surface, carrier, edgelet.along_mm, engagement_mm);
    if (found.empty())
      edgelet.left_out = why_no_stretch(surface, carrier, edgelet.along_mm, z_mm(edgelet.curves.front()));
    stretches.insert(stretches.end(), found.begin(), found.end());
    result.edgelets.push_back(std::move(edgelet));
  }
  result.stretches = joined(stretches, carrier);
  return result;
}

bool overlap(const geometry::Interval& a, const geometry::Interval& b) {
  return std::min(a.hi, b.hi) - std::max(a.lo, b.lo) > 0;
}

/// Whether the stretch, which may run on beyond a circle's angle 0, has some of the edgelet.
bool has(const Stretch& stretch, const Edgelet& edgelet, const Carrier& carrier) {
  if (overlap(stretch.along_mm, edgelet.along_mm)) return true;
  const double turn_mm = carrier.round ? carrier.circumference_mm() : 0;
  return overlap(stretch.along_mm, {edgelet.along_mm.lo + turn_mm, edgelet.along_mm.hi + turn_mm});
}

/// The curve that names a stretch about `along_mm`: edges before silhouettes before walls, exact before
/// fitted, then the least number.
const PlanCurve* naming_curve(const Carrier& carrier, double along_mm, const std::vector<Source>& sources) {
  const auto rank = [&](const PlanCurve* curve) {
    const Source& source = sources[curve->source];
    return std::tuple(source.kind, curve->error_mm > model::kExactMm, source.number);
  };
  const auto curves = carrier.curves_at(along_mm);
  const auto first = std::ranges::min_element(curves, {}, rank);
  return first == curves.end() ? nullptr : *first;
}

model::Feature feature_of(const Carrier& carrier, const Stretch& stretch,
                          const std::vector<Source>& sources) {
  model::Feature feature;
  feature.curve = carrier.curve_over(stretch.along_mm, stretch.side);
  feature.bulge =
      carrier.round && stretch.side == FreeSide::Left ? model::Bulge::Concave : model::Bulge::Convex;
  double middle_mm = (stretch.along_mm.lo + stretch.along_mm.hi) / 2;
  if (carrier.round && middle_mm > carrier.circumference_mm()) middle_mm -= carrier.circumference_mm();
  if (const PlanCurve* curve = naming_curve(carrier, middle_mm, sources)) {
    feature.edge = sources[curve->source].number;
    feature.error_mm = curve->error_mm;
  }
  return feature;
}

/// The lowest curve of an edgelet meets its fate, the others only run above it.
void meet(const Edgelet& edgelet, Fate fate, std::vector<Source>& sources) {
  const bool is_seen = !edgelet.left_out;
  sources[edgelet.curves.front()->source].met(fate);
  for (std::size_t i = 1; i < edgelet.curves.size(); ++i)
    sources[edgelet.curves[i]->source].met(is_seen ? Fate::Coincident : fate);
}

void count_fates(const part::EdgeCounts& edges, const std::vector<Source>& sources, FeatureCounts& counts) {
  counts.edges.add(Fate::Seam, edges.seams);
  counts.edges.add(Fate::Degenerate, edges.degenerate);
  const auto of_kind = [&](Source::Kind kind) -> FateCounts& {
    switch (kind) {
      case Source::Kind::Edge:
        return counts.edges;
      case Source::Kind::Silhouette:
        return counts.silhouettes;
      case Source::Kind::Wall:
        return counts.walls;
      case Source::Kind::Contour:
        break;
    }
    return counts.contours;
  };
  for (const Source& source : sources) of_kind(source.kind).add(source.fate.value_or(Fate::TooShort));
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
  int edges = 0;
  for (const auto& loop : profile.loops) edges += static_cast<int>(loop.size());
  result.counts.edges.add(Fate::Kept, count);
  result.counts.edges.add(Fate::NotGraspable, edges - count);
  result.counts.edgelets = count;
  result.counts.visible = count;
  result.counts.features = count;
  result.counts.reachable = count;
  return result;
}

}  // namespace

Features find_features(const part::Part& part, const model::PinStock& pins) {
  if (part.profile) return features_of_profile(*part.profile);
  Features result;
  FeatureCounts& counts = result.counts;
  Projection projection = projected(part);
  const auto carriers = carriers_of(projection);
  for (std::size_t i = 0; i < carriers.size(); ++i) {
    const SeenCarrier seen_here = seen(carriers, i, part.surface, pins.min_engagement_mm);
    counts.edgelets += static_cast<int>(seen_here.edgelets.size());
    for (const Edgelet& edgelet : seen_here.edgelets) {
      if (!edgelet.left_out) ++counts.visible;
      if (edgelet.left_out) meet(edgelet, *edgelet.left_out, projection.sources);
    }
    for (const Stretch& stretch : seen_here.stretches) {
      Fate fate = Fate::TooShort;
      if (stretch.along_mm.length() >= kLeastFeatureMm) {
        model::Feature feature = feature_of(carriers[i], stretch, projection.sources);
        feature.id = static_cast<int>(result.features.size());
        feature.reach_mm =
            reach_of(feature, breaks_on(carriers[i], stretch, seen_here.splits_mm), part.surface, pins);
        fate = feature.reach_mm.empty() ? Fate::NoRoom : Fate::Kept;
        result.features.push_back(std::move(feature));
      }
      counts.too_short += fate == Fate::TooShort ? 1 : 0;
      counts.reachable += fate == Fate::Kept ? 1 : 0;
      for (const Edgelet& edgelet : seen_here.edgelets) {
        if (!edgelet.left_out && has(stretch, edgelet, carriers[i])) meet(edgelet, fate, projection.sources);
      }
    }
  }
  count_fates(part.edge_counts, projection.sources, counts);
  counts.features = static_cast<int>(result.features.size());
  return result;
}

}  // namespace pinjaw::planner
