#include "host/planner/plan/check.hpp"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <set>
#include <tuple>

#include "host/planner/force/force.hpp"
#include "host/planner/heights/heights.hpp"
#include "host/planner/loading/loading.hpp"
#include "host/planner/plan/check_certified.hpp"
#include "host/planner/plan/check_robust.hpp"
#include "host/planner/plan/check_tolerances.hpp"
#include "host/planner/plan/claim_list.hpp"
#include "host/planner/plan/design_names.hpp"
#include "host/planner/plan/pin_places.hpp"

namespace pinjaw::planner {

namespace {

using geometry::Vector2d;
using geometry::Vector3d;

constexpr double kLengthTolMm = 1e-6;  // chosen: plans state lengths to the last bit; poses lose some 1e-13
constexpr double kHeightTolMm = 1e-4;  // chosen: a foot moved by kLengthTolMm on a steep facet

void check_holes(const Plan& plan, const model::Design& design, ClaimList& report) {
  const model::Kit& kit = plan.kit;
  std::set<model::Hole> holes;
  bool in_range = true;
  for (const model::PinDesign& pin : design.pins) {
    holes.insert(pin.hole);
    in_range = in_range && pin.hole.column >= 0 && pin.hole.column < kit.grid.columns && pin.hole.row >= 0 &&
               pin.hole.row < kit.grid.rows;
  }
  report.claim("four pins in four holes of the kit", in_range && design.pins.size() == 4 && holes.size() == 4,
               fmt::format("{} pins in {} holes", design.pins.size(), holes.size()));
  const auto left = std::ranges::count(design.pins, model::JawSide::Left,
                                       [](const model::PinDesign& pin) { return pin.hole.jaw; });
  const int of_split = design.split == model::Split::TwoTwo     ? 2
                       : design.split == model::Split::ThreeOne ? 3
                                                                : 1;
  report.claim("the split is that of the pins", left == of_split,
               fmt::format("{} stand on the left jaw", left));
  // fixtures that the plan did not keep may have had the digits, too: a number tells equal ones apart
  const std::string digits = DesignNames("gripper").next(design);
  report.claim("the id is that of the layout", design.id == digits || design.id.starts_with(digits + "-"),
               "it is " + digits);
  double nearest_mm = std::numeric_limits<double>::infinity();
  for (const model::PinDesign& one : design.pins) {
    for (const model::PinDesign& other : design.pins) {
      if (!(one.hole < other.hole)) continue;
      const double apart_mm = (model::p_GHole_mm(kit.grid, one.hole, design.jaw_separation_mm) -
                               model::p_GHole_mm(kit.grid, other.hole, design.jaw_separation_mm))
                                  .norm();
      nearest_mm = std::min(nearest_mm, apart_mm);
    }
  }
  report.claim("no two pins overlap", nearest_mm >= 2 * kit.pins.radius_mm - kLengthTolMm,
               fmt::format("two axes are {:.6f} mm apart", nearest_mm));
  const model::Interval range = kit.jaws.separation_mm;
  report.claim("the jaw separation is in the kit's range",
               design.jaw_separation_mm >= range.lo - kLengthTolMm &&
                   design.jaw_separation_mm <= range.hi + kLengthTolMm,
               fmt::format("{:.6f} mm", design.jaw_separation_mm));
  report.equal("the jaws open as far as the kit lets them", design.jaw_open_mm,
               model::open_separation_mm(kit.jaws, design.jaw_separation_mm), kLengthTolMm);
}

void check_contacts(const Plan& plan, const Scene& scene, const model::Design& design, ClaimList& report) {
  for (const model::PinDesign& pin : design.pins) {
    const std::string name = "pin " + name_of(pin.hole);
    const Vector2d axis_mm = model::p_GHole_mm(plan.kit.grid, pin.hole, design.jaw_separation_mm);
    const Vector2d foot_mm = axis_mm + plan.kit.pins.radius_mm * pin.normal;
    report.claim(
        name + " touches at its stated contact",
        (foot_mm - pin.contact_mm).norm() <= kLengthTolMm && std::abs(pin.normal.norm() - 1) <= kUnitTol,
        fmt::format("the pin's side is {:.9f} mm away", (foot_mm - pin.contact_mm).norm()));
    const double closing = pin.hole.jaw == model::JawSide::Left ? pin.normal.x() : -pin.normal.x();
    report.claim(name + " pushes the part inwards", closing > 0,
                 fmt::format("share of closing {:.6f}", closing));

    const Foot foot{foot_in_part_mm(design, pin), normal_in_part(design, pin)};
    const double plate_mm = plate_top_mm(plan.kit, scene.turned.surface, scene.attached);
    const auto height = pin_height(scene.turned.surface, plan.kit.pins, plate_mm, foot);
    report.claim(name + " has room to stand", height.has_value(),
                 height ? std::string() : std::string(to_string(height.error())));
    if (!height) continue;
    report.equal(name + " top", pin.top_z_mm, height->top_mm, kHeightTolMm);
    report.equal(name + " length", pin.length_mm, height->length_mm, kHeightTolMm);
    report.equal(name + " lowest contact", pin.contact_z_mm.lo, height->contact_z_mm.lo, kHeightTolMm);
    report.equal(name + " highest contact", pin.contact_z_mm.hi, height->contact_z_mm.hi, kHeightTolMm);
  }
}

/// Multipliers, their sum 1, with which the four contacts' planar wrenches add to zero; the least of them is
/// the closure margin, above 0 in strict form closure.
double closure_margin(const model::Design& design) {
  Eigen::Matrix<double, 3, 4> wrenches;
  Vector2d mean_mm = Vector2d::Zero();
  for (const model::PinDesign& pin : design.pins) mean_mm += pin.contact_mm / 4;
  for (Eigen::Index i = 0; i < 4; ++i) {
    const model::PinDesign& pin = design.pins[static_cast<std::size_t>(i)];
    const Vector2d arm_mm = pin.contact_mm - mean_mm;
    wrenches.col(i) << pin.normal, (arm_mm.x() * pin.normal.y() - arm_mm.y() * pin.normal.x());
  }
  Eigen::Vector4d multipliers;
  for (Eigen::Index i = 0; i < 4; ++i) {
    Eigen::Matrix3d others;
    for (Eigen::Index j = 0, column = 0; j < 4; ++j) {
      if (j != i) others.col(column++) = wrenches.col(j);
    }
    multipliers[i] = (i % 2 == 0 ? 1 : -1) * others.determinant();
  }
  return (multipliers / multipliers.sum()).minCoeff();
}

/// The design's pins as a planar fixture, back from its stated numbers.
PlanarFixture fixture_of(const Plan& plan, const model::Design& design) {
  PlanarFixture fixture;
  fixture.split = design.split;
  fixture.theta_rad = design.part_pose.theta_rad;
  std::array<int, 2> column = {plan.kit.grid.columns, plan.kit.grid.columns};
  int row = plan.kit.grid.rows;
  for (const model::PinDesign& pin : design.pins) {
    int& least = column[static_cast<std::size_t>(pin.hole.jaw)];
    least = std::min(least, pin.hole.column);
    row = std::min(row, pin.hole.row);
  }
  const model::Grid& grid = plan.kit.grid;
  fixture.span_mm =
      design.jaw_separation_mm + 2 * grid.edge_offset_mm + (column[0] + column[1]) * grid.spacing_mm;
  const Vector2d origin_mm =
      model::p_GHole_mm(grid, {model::JawSide::Left, column[0], row}, design.jaw_separation_mm);
  fixture.x_left_mm = design.part_pose.t_mm.x() - origin_mm.x();
  fixture.y_mm = design.part_pose.t_mm.y() - origin_mm.y();
  fixture.closure_margin = design.closure_margin;
  for (std::size_t i = 0; i < fixture.pins.size(); ++i) {
    const model::PinDesign& pin = design.pins[i];
    model::Hole hole = pin.hole;
    hole.column -= column[static_cast<std::size_t>(hole.jaw)];
    hole.row -= row;
    fixture.pins[i] = {
        hole, pin.feature, 0, pin.foot_margin_mm, foot_in_part_mm(design, pin), normal_in_part(design, pin)};
  }
  return fixture;
}

void check_loading(const Plan& plan, const Scene& scene, const model::Design& design, ClaimList& report) {
  const PlanarFixture fixture = fixture_of(plan, design);
  std::array<PinToLoad, 4> pins;
  for (std::size_t i = 0; i < pins.size(); ++i) {
    const model::PinDesign& pin = design.pins[i];
    pins[i] = {i, pin.length_mm, pin.top_z_mm, pin.contact_z_mm};
  }
  const std::vector<geometry::Surface> others = others_of(scene);
  const Surroundings surroundings{&scene.turned.surface, others,
                                  plate_top_mm(plan.kit, scene.turned.surface, scene.attached)};
  const LoadingOptions options{plan.loading_2d ? SweepHeights::Infinite : SweepHeights::Pins,
                               JawMotion::Closes};
  const auto loaded = load(fixture, pins, plan.kit, surroundings, options);
  report.claim("the open gripper comes along z and closes without touching anything", loaded.has_value(),
               loaded ? std::string() : std::string(to_string(loaded.error())));
  if (!loaded) return;
  report.equal("jaw separation", design.jaw_separation_mm, loaded->jaw_separation_mm, kLengthTolMm);
  const auto same = [](const model::Alternative& one, const model::Alternative& other) {
    return one.left_shift == other.left_shift && one.right_shift == other.right_shift &&
           std::abs(one.jaw_separation_mm - other.jaw_separation_mm) <= kLengthTolMm;
  };
  report.claim(
      "the other column shifts are those that load",
      std::ranges::equal(design.alternatives, loaded->alternatives, same),
      fmt::format("{} are stated, {} load", design.alternatives.size(), loaded->alternatives.size()));
}

/// The contact forces under the critical load are in equilibrium with it, inside friction, and squeeze as
/// stated.
void check_balance(const Grasp& grasp, const model::Design& design, const model::Wrench& wrench,
                   model::FrictionModel model, SqueezeSolver& solver, ClaimList& report) {
  const auto forces = solver.balancing_forces_n(wrench, model);
  report.claim("contact forces balance the critical load", forces.has_value(), "none were found");
  if (!forces) return;
  model::Wrench sum = wrench;
  double squeeze_n = 0;
  double worst_n = 0;
  for (std::size_t i = 0; i < forces->size(); ++i) {
    const PointContact& contact = grasp.contacts[i];
    const Vector3d& force = (*forces)[i];
    sum.head<3>() += force;
    sum.tail<3>() += contact.p_P_mm.cross(force);
    squeeze_n += squeeze_share(grasp, contact, force);
    const Vector3d normal(contact.n_P.x(), contact.n_P.y(), 0);
    const double pressing_n = force.dot(normal);
    worst_n = std::max({worst_n, -pressing_n, (force - pressing_n * normal).norm() - grasp.mu * pressing_n});
  }
  constexpr double kLeverMm = 25;
  report.claim(
      "they are in equilibrium with it",
      sum.head<3>().norm() <= kForceTolN && sum.tail<3>().norm() <= kForceTolN * kLeverMm,
      fmt::format("{:.3g} N and {:.3g} N mm are left over", sum.head<3>().norm(), sum.tail<3>().norm()));
  report.claim("each presses and stays inside its friction cone", worst_n <= kForceTolN,
               fmt::format("one is {:.3g} N outside", worst_n));
  report.equal("their squeeze is the required one", design.squeeze.required_n, std::max(0.0, squeeze_n),
               kForceTolN);
}

void check_force(const Plan& plan, const model::Design& design, ClaimList& report) {
  const Grasp grasp = grasp_of(design, plan.friction);
  report.claim("no contact jams", !jamming_contact(grasp).has_value(), "one cannot be closed by sliding");
  report.claim("neither jaw wedges the part", !wedging_jaw(grasp).has_value(), "one does alone");

  SqueezeSolver solver(grasp);
  double needed_n = 0;
  double critical_n = 0;
  bool all_resistable = true;
  for (const model::Disturbance& disturbance : plan.disturbances) {
    const model::Wrench wrench = turned(disturbance.wrench, plan.side);
    const SqueezeOutcome outcome = solver.least_squeeze(wrench, plan.friction_model);
    const auto* required = std::get_if<Required>(&outcome);
    all_resistable = all_resistable && required != nullptr;
    if (required == nullptr) continue;
    needed_n = std::max(needed_n, required->force_n);
    if (disturbance.name != design.squeeze.critical) continue;
    critical_n = std::max(0.0, required->force_n);
    check_balance(grasp, design, wrench, plan.friction_model, solver, report);
  }
  report.claim("every disturbance can be resisted", all_resistable, "one cannot");
  report.equal("required squeeze over all disturbances", design.squeeze.required_n, needed_n, kForceTolN);
  if (!plan.disturbances.empty()) {
    report.equal("required squeeze of the critical disturbance", design.squeeze.required_n, critical_n,
                 kForceTolN);
  }
  report.equal("usable squeeze", design.squeeze.usable_n, plan.kit.actuator.usable_squeeze_n(), kForceTolN);
  report.equal("margin", design.squeeze.margin_n, design.squeeze.usable_n - design.squeeze.required_n,
               kForceTolN);
  report.claim("the usable force holds it", design.squeeze.margin_n >= 0, "the margin is negative");
}

bool ids_are_unique(const Plan& plan) {
  std::set<std::string> ids;
  return std::ranges::all_of(plan.designs,
                             [&](const model::Design& design) { return ids.insert(design.id).second; });
}

/// What each phase lost is what it let through less than it was given.
void check_losses(const Plan& plan, ClaimList& report) {
  const Funnel& f = plan.funnel;
  const std::vector<std::tuple<std::string, std::int64_t, std::int64_t>> phases = {
      {"heights", f.planar, f.heights}, {"loading", f.heights, f.loadable}, {"force", f.loadable, f.strong}};
  for (const auto& [phase, given, left] : phases) {
    std::int64_t lost = 0;
    if (const auto found = plan.losses.find(phase); found != plan.losses.end()) {
      for (const auto& [reason, count] : found->second) lost += count;
    }
    report.claim("the losses of " + phase + " close with the funnel", given - lost == left,
                 fmt::format("{} less {} is not {}", given, lost, left));
  }
}

/// Smallest required squeeze first; ranked by worst, those that tell it come first, least worst first.
bool in_order(const Plan& plan) {
  const auto nominal_n = [](const model::Design& design) { return design.squeeze.required_n; };
  if (!plan.ranked_by_worst) return std::ranges::is_sorted(plan.designs, {}, nominal_n);
  const auto rest = std::ranges::find_if(plan.designs, [](const model::Design& d) { return !d.robust; });
  const auto worst_n = [](const model::Design& design) {
    return design.robust->worst_required_n.value_or(std::numeric_limits<double>::infinity());
  };
  return std::ranges::is_sorted(plan.designs.begin(), rest, {}, worst_n) &&
         std::ranges::is_sorted(rest, plan.designs.end(), {}, nominal_n);
}

}  // namespace

std::vector<Claim> check_plan(const Plan& plan, const Scene& scene) {
  ClaimList report("");
  report.claim("the part's file is the one that was planned", plan.part.sha256 == scene.part.sha256,
               "its SHA-256 is " + scene.part.sha256);
  report.claim("the designs come in the order of their rank", in_order(plan), "they do not");
  const Funnel& f = plan.funnel;
  report.claim("no phase of the funnel gains fixtures",
               f.planar >= f.heights && f.heights >= f.loadable && f.loadable >= f.not_wedging &&
                   f.not_wedging >= f.resistable && f.resistable >= f.strong,
               "one does");
  check_losses(plan, report);
  report.claim("no two designs have one id", ids_are_unique(plan), "two do");
  report.claim("the plan lists no more designs than are strong",
               static_cast<std::int64_t>(plan.designs.size()) <= f.strong,
               fmt::format("{} designs of {}", plan.designs.size(), f.strong));
  report.equal("mass", plan.part.mass_kg, scene.part.mass_kg, 1e-9);
  report.claim("centroid", (plan.part.centroid_mm - scene.part.centroid_mm).norm() <= kLengthTolMm,
               "it lies elsewhere");
  return report.take();
}

std::vector<Claim> check_design(const Plan& plan, const Scene& scene, const model::Design& design) {
  ClaimList report(design.id);
  check_holes(plan, design, report);
  if (design.pins.size() != 4) return report.take();
  check_contacts(plan, scene, design, report);
  const double margin = closure_margin(design);
  report.equal("closure margin", design.closure_margin, margin, 1e-6);
  report.claim("the pins hold the part in strict planar form closure", margin > 0,
               fmt::format("margin {:.3g}", margin));
  check_loading(plan, scene, design, report);
  check_force(plan, design, report);
  std::vector<Claim> claims = report.take();
  std::ranges::move(check_certified(plan, scene, design), std::back_inserter(claims));
  std::ranges::move(check_robust(plan, scene, design), std::back_inserter(claims));
  return claims;
}

}  // namespace pinjaw::planner
