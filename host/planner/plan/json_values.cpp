#include "host/planner/plan/json_values.hpp"

#include <numbers>

namespace pinjaw::planner {

namespace {

using base::JsonField;
using nlohmann::ordered_json;

constexpr double kDegree = std::numbers::pi / 180;

ordered_json pair_json(double first, double second) {
  return ordered_json::array({first, second});
}

geometry::Interval read_interval(const JsonField& field) {
  const std::vector<double> ends = field.numbers(2);
  if (ends[0] > ends[1]) field.mistake("expected the lower end first");
  return {ends[0], ends[1]};
}

model::Vector2d read_vector2(const JsonField& field) {
  const std::vector<double> values = field.numbers(2);
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

model::PinDesign read_pin(const JsonField& field) {
  model::PinDesign pin;
  pin.hole.jaw =
      field.at("jaw").one_of({"left", "right"}) == 0 ? model::JawSide::Left : model::JawSide::Right;
  pin.hole.column = static_cast<int>(field.whole("col"));
  pin.hole.row = static_cast<int>(field.whole("row"));
  pin.length_mm = field.number("length_mm");
  pin.top_z_mm = field.number("top_z_mm");
  pin.contact_z_mm = read_interval(field.at("contact_z_mm"));
  pin.contact_mm = read_vector2(field.at("contact_mm"));
  pin.normal = read_vector2(field.at("normal"));
  pin.foot_margin_mm = field.number("foot_margin_mm");
  pin.feature = static_cast<int>(field.whole("feature"));
  return pin;
}

double not_negative(const JsonField& field) {
  const double value = field.number();
  if (value < 0) field.mistake("expected 0 or a number above");
  return value;
}

double positive(const JsonField& field) {
  const double value = field.number();
  if (value <= 0) field.mistake("expected a number above 0");
  return value;
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
  return {{"id", design.id},
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
}

model::Vector3d read_vector3(const JsonField& field) {
  const std::vector<double> values = field.numbers(3);
  return {values[0], values[1], values[2]};
}

geometry::Pose2 read_pose(const JsonField& field) {
  return {field.number("theta_deg") * kDegree, {field.number("x_mm"), field.number("y_mm")}};
}

Friction read_friction(const JsonField& field) {
  const bool pyramid = field.at("model").one_of({"pyramid", "cone"}) == 0;
  return {field.number("mu"), pyramid ? model::FrictionModel::Pyramid : model::FrictionModel::Cone};
}

model::Kit read_kit_json(const JsonField& field) {
  model::Kit kit;
  kit.name = field.text("name");
  kit.sha256 = field.text("sha256");
  const JsonField grid = field.at("grid");
  kit.grid.spacing_mm = positive(grid.at("spacing_mm"));
  kit.grid.columns = static_cast<int>(grid.whole("columns"));
  kit.grid.rows = static_cast<int>(grid.whole("rows"));
  kit.grid.edge_offset_mm = grid.number("edge_offset_mm");
  const JsonField pins = field.at("pins");
  kit.pins.radius_mm = positive(pins.at("radius_mm"));
  for (const JsonField& length : pins.at("lengths_mm").list())
    kit.pins.lengths_mm.push_back(positive(length));
  kit.pins.min_engagement_mm = pins.number("min_engagement_mm");
  kit.pins.protrusion_mm = pins.number("protrusion_mm");
  kit.pins.clearance_mm = pins.number("clearance_mm");
  kit.pins.min_foot_margin_mm = pins.number("min_foot_margin_mm");
  const JsonField jaws = field.at("jaws");
  kit.jaws.separation_mm = read_interval(jaws.at("separation_mm"));
  kit.jaws.plate_gap_mm = jaws.number("plate_gap_mm");
  kit.jaws.plate_thickness_mm = jaws.number("plate_thickness_mm");
  if (jaws.has("opening_mm")) kit.jaws.opening_mm = jaws.number("opening_mm");
  if (jaws.has("bodies")) {
    for (const JsonField& body : jaws.at("bodies").list()) {
      kit.jaws.bodies.push_back(
          {read_interval(body.at("x_mm")), read_interval(body.at("y_mm")), read_interval(body.at("z_mm"))});
    }
  }
  kit.actuator.max_squeeze_n = not_negative(field.at("actuator").at("max_squeeze_n"));
  kit.actuator.force_uncertainty_n = field.at("actuator").number("force_uncertainty_n");
  const JsonField grip = field.at("grip");
  kit.grip = {grip.number("light_n"), grip.number("separation_tol_mm"), grip.number("slip_tol_mm"),
              grip.number("stable_ms")};
  return kit;
}

model::Design read_design(const JsonField& field) {
  model::Design design;
  design.id = field.text("id");
  const std::vector<model::Split> splits = {model::Split::TwoTwo, model::Split::ThreeOne,
                                            model::Split::OneThree};
  design.split = splits[field.at("split").one_of({"2+2", "3+1", "1+3"})];
  design.jaw_separation_mm = field.number("jaw_separation_mm");
  design.jaw_open_mm = field.number("jaw_open_mm");
  design.closure_margin = field.number("closure_margin");
  design.part_pose = read_pose(field.at("part_pose"));
  for (const JsonField& pin : field.at("pins").list()) design.pins.push_back(read_pin(pin));
  const JsonField squeeze = field.at("squeeze");
  design.squeeze = {squeeze.number("required_n"), squeeze.number("usable_n"), squeeze.number("limit_n"),
                    squeeze.number("margin_n"), squeeze.text("critical")};
  for (const JsonField& other : field.at("other_column_shifts").list()) {
    design.alternatives.push_back({static_cast<int>(other.whole("left_shift")),
                                   static_cast<int>(other.whole("right_shift")),
                                   other.number("jaw_separation_mm")});
  }
  return design;
}

}  // namespace pinjaw::planner
