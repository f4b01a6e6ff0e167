#include "host/planner/plan/planar_json.hpp"

#include <nlohmann/json.hpp>

#include "host/planner/plan/json_values.hpp"
#include "host/planner/planar/column_shifts.hpp"

namespace pinjaw::planner {

namespace {

using nlohmann::ordered_json;

ordered_json fixture_json(const PlanarFixture& fixture, const std::vector<model::Feature>& features,
                          const model::Kit& kit) {
  const PlacedFixture placed = placed_least(kit, fixture);
  ordered_json pins = ordered_json::array();
  for (std::size_t i = 0; i < fixture.pins.size(); ++i) {
    const model::Hole& hole = placed.holes[i];
    const model::Feature& feature = features[static_cast<std::size_t>(fixture.pins[i].feature)];
    pins.push_back({{"jaw", hole.jaw == model::JawSide::Left ? "left" : "right"},
                    {"col", hole.column},
                    {"row", hole.row},
                    {"loop", feature.loop},
                    {"edge", feature.edge}});
  }
  return {{"split", model::to_string(fixture.split)},
          {"theta_deg", fixture.theta_rad / kDegree},
          {"span_mm", fixture.span_mm},
          {"jaw_separation_mm", placed.jaw_separation_mm},
          {"part_pose", pose_json(placed.part_pose)},
          {"pins", pins}};
}

ordered_json point_json(const geometry::Vector2d& p) {
  return ordered_json::array({p.x(), p.y()});
}

ordered_json curve_json(const geometry::Curve& curve) {
  if (const auto* segment = std::get_if<geometry::Segment>(&curve)) {
    return {{"line_mm", ordered_json::array({point_json(segment->a_mm), point_json(segment->b_mm)})}};
  }
  const auto& arc = std::get<geometry::Arc>(curve);
  return {{"arc",
           {{"center_mm", point_json(arc.center_mm)},
            {"radius_mm", arc.radius_mm},
            {"from_deg", arc.from_rad / kDegree},
            {"sweep_deg", arc.sweep_rad / kDegree}}}};
}

ordered_json fates_json(const FateCounts& counts) {
  ordered_json result = {{"total", counts.total}};
  for (const Fate fate : kFates) result[std::string(to_string(fate))] = counts[fate];
  return result;
}

}  // namespace

std::string to_json(const std::vector<PlanarFixture>& fixtures, const std::vector<model::Feature>& features,
                    const model::Kit& kit) {
  ordered_json document = {{"format", "pinjaw-planar/1"}, {"count", fixtures.size()}};
  document["fixtures"] = ordered_json::array();
  for (const PlanarFixture& fixture : fixtures)
    document["fixtures"].push_back(fixture_json(fixture, features, kit));
  return document.dump(1) + "\n";
}

std::string features_json(const std::string& task, const std::vector<model::Feature>& features,
                          const FeatureCounts& counts,
                          const std::vector<std::pair<std::string, int>>& mesh_counts) {
  ordered_json document = {{"format", "pinjaw-features/1"},
                           {"task", task},
                           {"counts",
                            {{"edges", fates_json(counts.edges)},
                             {"walls", fates_json(counts.walls)},
                             {"silhouettes", fates_json(counts.silhouettes)},
                             {"contours", fates_json(counts.contours)},
                             {"edgelets", counts.edgelets},
                             {"visible", counts.visible},
                             {"too_short", counts.too_short},
                             {"features", counts.features},
                             {"reachable", counts.reachable}}}};
  for (const auto& [name, count] : mesh_counts) document["mesh"][name] = count;
  document["features"] = ordered_json::array();
  for (const model::Feature& feature : features) {
    ordered_json reach = ordered_json::array();
    for (const geometry::Interval& piece : feature.reach_mm) reach.push_back({piece.lo, piece.hi});
    ordered_json entry = {{"id", feature.id},
                          {"edge", feature.edge},
                          {"free_side", feature.bulge == model::Bulge::Convex ? "outside" : "inside"},
                          {"approximate", model::is_approximate(feature)},
                          {"error_mm", feature.error_mm},
                          {"reach_mm", reach}};
    entry.update(curve_json(feature.curve));
    document["features"].push_back(std::move(entry));
  }
  return document.dump(1) + "\n";
}

}  // namespace pinjaw::planner
