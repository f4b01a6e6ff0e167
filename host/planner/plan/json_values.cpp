#include "host/planner/plan/json_values.hpp"

#include <cmath>
#include <limits>

#include "host/config/fields.hpp"
#include "host/planner/plan/certify_json.hpp"
#include "host/planner/plan/robust_json.hpp"

namespace pinjaw::planner {

namespace {

using base::JsonField;
using nlohmann::ordered_json;

ordered_json pair_json(double first, double second) {
  return ordered_json::array({first, second});
}

/// A part may stand far from its origin; chosen: beyond a kilometre a micrometre is lost to rounding.
base::NumberRule coordinate() {
  return {"a coordinate from -1e6 to 1e6 mm", -1e6, 1e6};
}

base::NumberRule force_or_margin() {
  return {"newtons from -1e6 to 1e6", -config::kStrongest_n, config::kStrongest_n};
}

geometry::Interval read_interval(const JsonField& field, const base::NumberRule& rule) {
  const std::vector<double> ends = field.numbers(2, rule);
  if (ends[0] > ends[1]) field.mistake("expected the lower end first");
  return {ends[0], ends[1]};
}

model::Vector2d read_vector2(const JsonField& field, const base::NumberRule& rule) {
  const std::vector<double> values = field.numbers(2, rule);
  return {values[0], values[1]};
}

ordered_json pin_json(const model::PinDesign& pin) {
  return {{"jaw", pin.hole.jaw == model::JawSide::Left ? "left" : "right"},
          {"col", pin.hole.column},
          {"row", pin.hole.row},
          {"length_mm", pin.length_mm},
          {"top_z_mm", pin.top_z_mm},
          {"contact_z_mm", pair_json(pin.contact_z_mm.lo, pin.contact_z_mm.hi)},
          {"contact_mm", pair_json(pin.contact_mm.x(), pin.contact_mm.y())},
          {"normal", pair_json(pin.normal.x(), pin.normal.y())},
          {"foot_margin_mm", pin.foot_margin_mm},
          {"feature", pin.feature}};
}

constexpr int kMostHoles = 64;             // of a row or column, as in kit files
constexpr double kMostOfAUnit = 1 + 1e-9;  // chosen: the rounding of a written unit vector

base::WholeRule hole_number() {
  return config::whole_between("the number of a hole", 0, kMostHoles - 1);
}

int whole(const JsonField& field, const base::WholeRule& rule) {
  return static_cast<int>(field.whole(rule));
}

model::PinDesign read_pin(const JsonField& field) {
  model::PinDesign pin;
  pin.hole.jaw =
      field.at("jaw").one_of({"left", "right"}) == 0 ? model::JawSide::Left : model::JawSide::Right;
  pin.hole.column = whole(field.at("col"), hole_number());
  pin.hole.row = whole(field.at("row"), hole_number());
  pin.length_mm = field.at("length_mm").number(config::length_at_least_0());
  pin.top_z_mm = field.at("top_z_mm").number(coordinate());
  pin.contact_z_mm = read_interval(field.at("contact_z_mm"), coordinate());
  pin.contact_mm = read_vector2(field.at("contact_mm"), coordinate());
  pin.normal = read_vector2(field.at("normal"), {"a number from -1 to 1", -kMostOfAUnit, kMostOfAUnit});
  pin.foot_margin_mm = field.at("foot_margin_mm").number(coordinate());
  pin.feature = whole(field.at("feature"), {"the number of a feature", -1, std::numeric_limits<int>::max()});
  return pin;
}

}  // namespace

ordered_json vector_json(const model::Vector3d& v) {
  return ordered_json::array({v.x(), v.y(), v.z()});
}

ordered_json pose_json(const geometry::Pose2& pose) {
  return {{"x_mm", pose.t_mm.x()}, {"y_mm", pose.t_mm.y()}, {"theta_deg", pose.theta_rad / kDegree}};
}

ordered_json funnel_json(const Funnel& funnel) {
  return {
      {"features", funnel.features}, {"planar", funnel.planar},           {"heights", funnel.heights},
      {"loadable", funnel.loadable}, {"not_wedging", funnel.not_wedging}, {"resistable", funnel.resistable},
      {"strong", funnel.strong}};
}

ordered_json friction_json(const Friction& friction) {
  return {{"mu", friction.mu},
          {"model", friction.model == model::FrictionModel::Pyramid ? "pyramid" : "cone"}};
}

ordered_json kit_json(const model::Kit& kit) {
  ordered_json jaws = {{"separation_mm", pair_json(kit.jaws.separation_mm.lo, kit.jaws.separation_mm.hi)},
                       {"plate_gap_mm", kit.jaws.plate_gap_mm},
                       {"plate_thickness_mm", kit.jaws.plate_thickness_mm}};
  if (kit.jaws.opening_mm) jaws["opening_mm"] = *kit.jaws.opening_mm;
  for (const model::JawBody& body : kit.jaws.bodies) {
    jaws["bodies"].push_back({{"x_mm", pair_json(body.x_mm.lo, body.x_mm.hi)},
                              {"y_mm", pair_json(body.y_mm.lo, body.y_mm.hi)},
                              {"z_mm", pair_json(body.z_mm.lo, body.z_mm.hi)}});
  }
  return {{"name", kit.name},
          {"sha256", kit.sha256},
          {"grid",
           {{"spacing_mm", kit.grid.spacing_mm},
            {"columns", kit.grid.columns},
            {"rows", kit.grid.rows},
            {"edge_offset_mm", kit.grid.edge_offset_mm}}},
          {"pins",
           {{"radius_mm", kit.pins.radius_mm},
            {"lengths_mm", kit.pins.lengths_mm},
            {"min_engagement_mm", kit.pins.min_engagement_mm},
            {"protrusion_mm", kit.pins.protrusion_mm},
            {"clearance_mm", kit.pins.clearance_mm},
            {"min_foot_margin_mm", kit.pins.min_foot_margin_mm}}},
          {"jaws", jaws},
          {"actuator",
           {{"max_squeeze_n", kit.actuator.max_squeeze_n},
            {"force_uncertainty_n", kit.actuator.force_uncertainty_n}}},
          {"grip",
           {{"light_n", kit.grip.light_n},
            {"separation_tol_mm", kit.grip.separation_tol_mm},
            {"slip_tol_mm", kit.grip.slip_tol_mm},
            {"stable_ms", kit.grip.stable_ms}}}};
}

/// Without the difference where it is endless: the one found a surface where the other has none.
ordered_json exact_json(const model::Exact& exact) {
  ordered_json json;
  if (std::isfinite(exact.largest_difference_mm)) json["largest_difference_mm"] = exact.largest_difference_mm;
  json["contact_gap_mm"] = exact.contact_gap_mm;
  json["least_clearance_mm"] = exact.least_clearance_mm;
  return json;
}

model::Exact read_exact(const JsonField& field) {
  model::Exact exact;
  exact.largest_difference_mm = field.has("largest_difference_mm")
                                    ? field.at("largest_difference_mm").number(config::length_at_least_0())
                                    : std::numeric_limits<double>::infinity();
  exact.contact_gap_mm = field.at("contact_gap_mm").number(config::length_at_least_0());
  exact.least_clearance_mm = field.at("least_clearance_mm").number(config::coordinate());
  return exact;
}

ordered_json design_json(const model::Design& design) {
  ordered_json pins = ordered_json::array();
  for (const model::PinDesign& pin : design.pins) pins.push_back(pin_json(pin));
  ordered_json alternatives = ordered_json::array();
  for (const model::Alternative& other : design.alternatives) {
    alternatives.push_back({{"left_shift", other.left_shift},
                            {"right_shift", other.right_shift},
                            {"jaw_separation_mm", other.jaw_separation_mm}});
  }
  const model::Squeeze& squeeze = design.squeeze;
  ordered_json json = {{"id", design.id},
                       {"split", model::to_string(design.split)},
                       {"jaw_separation_mm", design.jaw_separation_mm},
                       {"jaw_open_mm", design.jaw_open_mm},
                       {"closure_margin", design.closure_margin},
                       {"part_pose", pose_json(design.part_pose)},
                       {"pins", pins},
                       {"squeeze",
                        {{"required_n", squeeze.required_n},
                         {"usable_n", squeeze.usable_n},
                         {"limit_n", squeeze.limit_n},
                         {"margin_n", squeeze.margin_n},
                         {"critical", squeeze.critical}}},
                       {"other_column_shifts", alternatives}};
  if (design.certified) json["certified"] = certified_json(*design.certified);
  if (design.robust) json["robust"] = robust_json(*design.robust);
  if (design.exact) json["exact"] = exact_json(*design.exact);
  return json;
}

model::Vector3d read_vector3(const JsonField& field) {
  const std::vector<double> values = field.numbers(3, coordinate());
  return {values[0], values[1], values[2]};
}

geometry::Pose2 read_pose(const JsonField& field) {
  return {field.at("theta_deg").number({"an angle from -1e6 to 1e6 degrees", -1e6, 1e6}) * kDegree,
          {field.at("x_mm").number(coordinate()), field.at("y_mm").number(coordinate())}};
}

Friction read_friction(const JsonField& field) {
  const bool pyramid = field.at("model").one_of({"pyramid", "cone"}) == 0;
  return {field.at("mu").number({"a friction coefficient from 0 to 10", 0, 10}),
          pyramid ? model::FrictionModel::Pyramid : model::FrictionModel::Cone};
}

namespace {

model::PinStock read_pins_json(const JsonField& field) {
  model::PinStock pins;
  pins.radius_mm = field.at("radius_mm").number(config::length_above_0());
  for (const JsonField& length : field.at("lengths_mm").list()) {
    pins.lengths_mm.push_back(length.number(config::length_above_0()));
  }
  pins.min_engagement_mm = field.at("min_engagement_mm").number(config::length_above_0());
  pins.protrusion_mm = field.at("protrusion_mm").number(config::length_at_least_0());
  pins.clearance_mm = field.at("clearance_mm").number(config::length_at_least_0());
  pins.min_foot_margin_mm = field.at("min_foot_margin_mm").number(config::length_at_least_0());
  return pins;
}

model::Jaws read_jaws_json(const JsonField& field) {
  model::Jaws jaws;
  jaws.separation_mm = read_interval(field.at("separation_mm"), config::length_at_least_0());
  jaws.plate_gap_mm = field.at("plate_gap_mm").number(config::length_at_least_0());
  jaws.plate_thickness_mm = field.at("plate_thickness_mm").number(config::length_above_0());
  if (field.has("opening_mm")) jaws.opening_mm = field.at("opening_mm").number(config::length_above_0());
  if (!field.has("bodies")) return jaws;
  for (const JsonField& body : field.at("bodies").list()) {
    jaws.bodies.push_back({read_interval(body.at("x_mm"), config::coordinate()),
                           read_interval(body.at("y_mm"), config::coordinate()),
                           read_interval(body.at("z_mm"), config::coordinate())});
    if (jaws.bodies.size() > model::Jaws::kMaxBodies) body.mistake("one box more than a jaw may have");
  }
  return jaws;
}

}  // namespace

model::Kit read_kit_json(const JsonField& field) {
  model::Kit kit;
  kit.name = field.text("name");
  kit.sha256 = field.text("sha256");
  const JsonField grid = field.at("grid");
  kit.grid.spacing_mm = grid.at("spacing_mm").number(config::length_above_0());
  kit.grid.columns = whole(grid.at("columns"), config::whole_between("a count of columns", 1, kMostHoles));
  kit.grid.rows = whole(grid.at("rows"), config::whole_between("a count of rows", 1, kMostHoles));
  kit.grid.edge_offset_mm = grid.at("edge_offset_mm").number(config::length_at_least_0());
  kit.pins = read_pins_json(field.at("pins"));
  kit.jaws = read_jaws_json(field.at("jaws"));
  kit.actuator.max_squeeze_n = field.at("actuator").at("max_squeeze_n").number(config::force_at_least_0());
  kit.actuator.force_uncertainty_n =
      field.at("actuator").at("force_uncertainty_n").number(config::force_at_least_0());
  const JsonField grip = field.at("grip");
  kit.grip = {grip.at("light_n").number(config::force_at_least_0()),
              grip.at("separation_tol_mm").number(config::length_above_0()),
              grip.at("slip_tol_mm").number(config::length_above_0()),
              grip.at("stable_ms").number({"milliseconds from 0 to 60000", 0, 60000})};
  return kit;
}

model::Design read_design(const JsonField& field) {
  model::Design design;
  design.id = field.text("id");
  const std::vector<model::Split> splits = {model::Split::TwoTwo, model::Split::ThreeOne,
                                            model::Split::OneThree};
  design.split = splits[field.at("split").one_of({"2+2", "3+1", "1+3"})];
  design.jaw_separation_mm = field.at("jaw_separation_mm").number(config::length_at_least_0());
  design.jaw_open_mm = field.at("jaw_open_mm").number(config::length_at_least_0());
  design.closure_margin = field.at("closure_margin").number({"a share from -1 to 1", -1, 1});
  design.part_pose = read_pose(field.at("part_pose"));
  for (const JsonField& pin : field.at("pins").list()) design.pins.push_back(read_pin(pin));
  if (design.pins.size() != 3 && design.pins.size() != 4) {
    field.at("pins").mistake("expected 4 pins, of a pallet 3");
  }
  const JsonField squeeze = field.at("squeeze");
  design.squeeze = {squeeze.at("required_n").number(config::force_at_least_0()),
                    squeeze.at("usable_n").number(force_or_margin()),
                    squeeze.at("limit_n").number(config::force_at_least_0()),
                    squeeze.at("margin_n").number(force_or_margin()), squeeze.text("critical")};
  const base::WholeRule shift = config::whole_between("a number of columns", -kMostHoles, kMostHoles);
  for (const JsonField& other : field.at("other_column_shifts").list()) {
    design.alternatives.push_back({whole(other.at("left_shift"), shift),
                                   whole(other.at("right_shift"), shift),
                                   other.at("jaw_separation_mm").number(config::length_at_least_0())});
  }
  if (field.has("certified")) design.certified = read_certified(field.at("certified"));
  if (field.has("robust")) design.robust = read_robust(field.at("robust"));
  if (field.has("exact")) design.exact = read_exact(field.at("exact"));
  return design;
}

}  // namespace pinjaw::planner
