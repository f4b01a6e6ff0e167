#include "host/planner/plan/plan_json.hpp"

#include <numbers>

#include "host/base/json_document.hpp"
#include "host/base/json_fields.hpp"
#include "host/base/json_places.hpp"
#include "host/planner/plan/certify_json.hpp"
#include "host/planner/plan/json_values.hpp"
#include "host/planner/plan/robust_json.hpp"

namespace pinjaw::planner {

namespace {

using base::JsonField;
using nlohmann::ordered_json;

constexpr const char* kFormat = "pinjaw-plan/1";

Funnel read_funnel(const JsonField& field) {
  return {field.whole("features"), field.whole("planar"),      field.whole("heights"),
          field.whole("loadable"), field.whole("not_wedging"), field.whole("resistable"),
          field.whole("strong")};
}

Losses read_losses(const JsonField& field) {
  Losses losses;
  for (const std::string& phase : field.keys()) {
    for (const std::string& reason : field.at(phase).keys())
      losses[phase][reason] = field.at(phase).whole(reason);
  }
  return losses;
}

ordered_json obstacles_json(const std::vector<model::Obstacle>& obstacles) {
  ordered_json list = ordered_json::array();
  for (const model::Obstacle& obstacle : obstacles) {
    ordered_json entry = {{"file", obstacle.file.string()}, {"pose", pose_json(obstacle.pose)}};
    entry["pose"]["z_mm"] = obstacle.z_mm;
    list.push_back(std::move(entry));
  }
  return list;
}

std::vector<model::Obstacle> read_obstacles(const JsonField& field) {
  std::vector<model::Obstacle> obstacles;
  for (const JsonField& entry : field.list()) {
    const JsonField pose = entry.at("pose");
    obstacles.push_back({entry.text("file"), read_pose(pose), pose.number("z_mm")});
  }
  return obstacles;
}

}  // namespace

std::string to_json(const Plan& plan) {
  ordered_json document;
  document["format"] = kFormat;
  document["task"] = plan.task;
  document["part"] = {{"file", plan.part.file},
                      {"sha256", plan.part.sha256},
                      {"up", vector_json(plan.part.up)},
                      {"mass_kg", plan.part.mass_kg},
                      {"centroid_mm", vector_json(plan.part.centroid_mm)}};
  document["kit"] = kit_json(plan.kit);
  document["side"] = plan.side == model::Side::Below ? "below" : "above";
  document["loading"] = plan.loading_2d ? "2d" : "3d";
  if (!plan.obstacles.empty()) document["obstacles"] = obstacles_json(plan.obstacles);
  if (plan.attached)
    document["attached"] = {{"file", plan.attached->file.string()}, {"base", plan.attached->base}};
  document["friction"] = friction_json({plan.friction, plan.friction_model});
  document["random"] = plan.random_algorithm;
  document["disturbances"] = disturbances_json(plan.disturbances);
  if (!plan.jets.empty()) document["jets"] = jets_json(plan.jets);
  document["funnel"] = funnel_json(plan.funnel);
  document["losses"] = plan.losses;
  if (plan.ranges) document["ranges"] = ranges_json(*plan.ranges);
  document["rank"] = plan.ranked_by_worst ? "robust" : "nominal";
  document["designs"] = ordered_json::array();
  for (const model::Design& design : plan.designs) document["designs"].push_back(design_json(design));
  return document.dump(1) + "\n";
}

base::Checked<Plan> read_plan(const std::filesystem::path& path) {
  const auto document = base::read_json_document(path, kFormat);
  if (!document) return tl::unexpected(document.error());

  base::Diagnostics mistakes;
  const JsonField top(&document->value, "", &document->name, &mistakes);
  Plan plan;
  plan.task = top.text("task");
  const JsonField part = top.at("part");
  plan.part = {part.text("file"), part.text("sha256"), read_vector3(part.at("up")),
               part.at("mass_kg").number({"a mass from 0 to 1e6 kg", 0, 1e6}),
               read_vector3(part.at("centroid_mm"))};
  plan.kit = read_kit_json(top.at("kit"));
  plan.side = top.at("side").one_of({"below", "above"}) == 0 ? model::Side::Below : model::Side::Above;
  plan.loading_2d = top.at("loading").one_of({"3d", "2d"}) == 1;
  if (top.has("obstacles")) plan.obstacles = read_obstacles(top.at("obstacles"));
  if (top.has("attached")) {
    plan.attached = model::Attached{top.at("attached").text("file"), top.at("attached").text("base")};
  }
  const Friction friction = read_friction(top.at("friction"));
  plan.friction = friction.mu;
  plan.friction_model = friction.model;
  plan.random_algorithm = top.text("random");
  plan.disturbances = read_disturbances(top.at("disturbances"));
  if (top.has("jets")) plan.jets = read_jets(top.at("jets"));
  plan.funnel = read_funnel(top.at("funnel"));
  plan.losses = read_losses(top.at("losses"));
  if (top.has("ranges")) plan.ranges = read_ranges_json(top.at("ranges"));
  if (top.has("rank")) plan.ranked_by_worst = top.at("rank").one_of({"nominal", "robust"}) == 1;
  for (const JsonField& design : top.at("designs").list()) plan.designs.push_back(read_design(design));
  if (!mistakes.empty()) return tl::unexpected(base::placed_in_json(mistakes, document->text));
  return plan;
}

}  // namespace pinjaw::planner
