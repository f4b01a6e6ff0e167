#include "host/planner/robust/robust.hpp"

#include <algorithm>
#include <nlopt.hpp>
#include <numbers>

#include "host/planner/force/force.hpp"

namespace pinjaw::planner {
namespace {

constexpr double kDegPerRad = 180 / std::numbers::pi;
constexpr int kPins = 4;
constexpr int kMostTries = 200;        // chosen: eight unknowns, a smooth function but for its creases
constexpr double kTrustRegion = 0.25;  // chosen: of the half range

Grasp grasp_of(const model::Design& design, const ClosedPart& part, double theta_rad, double mu) {
  Grasp grasp;
  grasp.mu = mu;
  grasp.x_P = geometry::direction(-theta_rad);
  for (std::size_t pin = 0; pin < part.contacts.size(); ++pin) {
    const ClosedPart::Contact& at = part.contacts[pin];
    const model::Interval& z_mm = design.pins[pin].contact_z_mm;
    PointContact contact;
    contact.n_P = at.n_P;
    contact.jaw = design.pins[pin].hole.jaw;
    contact.pin = static_cast<int>(pin);
    contact.p_P_mm = {at.p_P_mm.x(), at.p_P_mm.y(), z_mm.lo};
    grasp.contacts.push_back(contact);
    if (z_mm.hi <= z_mm.lo) continue;
    contact.p_P_mm.z() = z_mm.hi;
    grasp.contacts.push_back(contact);
  }
  return grasp;
}

RobustPoint fails(const char* how, std::size_t critical = 0) {
  return {std::nullopt, how, critical};
}

RobustPoint force_at(const RobustCase& of, Grasp grasp, double friction) {
  grasp.mu = of.ranges.friction_about(of.friction).hi;
  if (wedging_jaw(grasp)) return fails("wedges");
  if (jamming_contact(grasp)) return fails("jams");
  grasp.mu = friction;
  const ForceVerdict verdict = evaluate(grasp, of.wrenches, {.friction = of.model, .stop_above_n = {}});
  if (const auto* holds = std::get_if<Holds>(&verdict)) return {holds->required_n, {}, holds->critical};
  if (const auto* not_resistable = std::get_if<NotResistable>(&verdict))
    return fails("not_resistable", not_resistable->critical);
  return fails(std::holds_alternative<Wedges>(verdict) ? "wedges" : "jams");
}

RobustPoint point_of(const RobustCase& of, const model::Design& design, const std::optional<ClosedPart>& part,
                     double friction) {
  if (!part) return fails("does_not_close");
  const bool on_features = std::ranges::all_of(part->contacts, &ClosedPart::Contact::on_feature);
  if (!on_features) return fails("leaves_a_feature");
  return force_at(of, grasp_of(design, *part, design.part_pose.theta_rad + part->turned_rad, friction),
                  friction);
}

/// Every corner of the errors that the ranges leave, the nominal point first.
std::vector<model::PinErrors> corners_of(const model::Ranges& ranges) {
  const bool across = ranges.pin_position_mm > 0;
  const bool towards = across || ranges.pin_radius_mm > 0 || ranges.part_size_mm > 0;
  std::vector<model::PinErrors> corners{model::PinErrors{}};
  if (!towards) return corners;
  const int count = across ? 1 << (2 * kPins) : 1 << kPins;
  const auto sign = [](int bits, int bit) { return ((bits >> bit) & 1) != 0 ? 1.0 : -1.0; };
  for (int bits = 0; bits < count; ++bits) {
    model::PinErrors& corner = corners.emplace_back();
    for (int pin = 0; pin < kPins; ++pin) {
      corner[static_cast<std::size_t>(pin)] = {sign(bits, pin), across ? sign(bits, kPins + pin) : 0.0};
    }
  }
  return corners;
}

/// Worse: a failure before any squeeze, then the greater squeeze.
bool worse(const RobustPoint& a, const RobustPoint& b) {
  if (!b.required_n) return false;
  return !a.required_n || *a.required_n > *b.required_n;
}

/// The worst point so far.
struct Worst {
  RobustPoint point;
  model::PinErrors errors;

  void take(const RobustPoint& other, const model::PinErrors& at) {
    if (!worse(other, point)) return;
    point = other;
    errors = at;
  }
};

/// Climbs from the worst corner to where it is worse still.
void climb(const RobustCase& of, const model::Design& design, const Closing& closing, double friction,
           Worst& worst) {
  const unsigned unknowns = of.ranges.pin_position_mm > 0 ? 2 * kPins : kPins;
  const auto errors_of = [](const std::vector<double>& x) {
    model::PinErrors errors;
    for (std::size_t i = 0; i < x.size(); ++i) {
      model::PinError& error = errors[i % kPins];
      (i < kPins ? error.towards : error.across) = x[i];
    }
    return errors;
  };
  std::vector<double> x;
  for (unsigned i = 0; i < unknowns; ++i) {
    const model::PinError& error = worst.errors[i % kPins];
    x.push_back(i < kPins ? error.towards : error.across);
  }
  auto needed_n = [&](const std::vector<double>& at) {
    const model::PinErrors errors = errors_of(at);
    const RobustPoint point = point_of(of, design, closing.at(of.ranges, errors), friction);
    worst.take(point, errors);
    if (!point.required_n) throw nlopt::forced_stop();
    return *point.required_n;
  };
  using Needed = decltype(needed_n);
  nlopt::opt search(nlopt::LN_BOBYQA, unknowns);
  search.set_lower_bounds(-1);
  search.set_upper_bounds(1);
  search.set_initial_step(kTrustRegion);
  search.set_maxeval(kMostTries);
  search.set_ftol_rel(1e-6);
  const nlopt::vfunc call = [](const std::vector<double>& at, std::vector<double>& /*gradient*/, void* data) {
    return (*static_cast<const Needed*>(data))(at);
  };
  search.set_max_objective(call, &needed_n);
  double best_n = 0;
  try {
    search.optimize(x, best_n);
  } catch (const std::exception&) {
    // a failure ends it, and so may rounding; what was met counts either way
  }
}

}  // namespace

RobustPoint robust_at(const RobustCase& of, const model::Design& design, double friction,
                      const model::PinErrors& errors) {
  const Closing closing(design, of.features, of.kit, of.centroid_P_mm);
  return point_of(of, design, closing.at(of.ranges, errors), friction);
}

LocationError location_error(const RobustCase& of, const model::Design& design) {
  const Closing closing(design, of.features, of.kit, of.centroid_P_mm);
  LocationError error;
  for (const model::PinErrors& corner : corners_of(of.ranges)) {
    const auto part = closing.at(of.ranges, corner);
    if (!part) continue;
    error.moved_mm = std::max(error.moved_mm, part->moved_mm);
    error.turned_deg = std::max(error.turned_deg, kDegPerRad * std::abs(part->turned_rad));
  }
  return error;
}

model::Robust robust_of(const RobustCase& of, const model::Design& design) {
  const Closing closing(design, of.features, of.kit, of.centroid_P_mm);
  const double friction = of.ranges.friction_about(of.friction).lo;
  model::Robust robust;
  Worst worst;
  worst.point.required_n = -1;
  for (const model::PinErrors& corner : corners_of(of.ranges)) {
    worst.take(point_of(of, design, closing.at(of.ranges, corner), friction), corner);
    if (!worst.point.required_n) break;
  }
  const bool errors_range =
      of.ranges.pin_position_mm > 0 || of.ranges.pin_radius_mm > 0 || of.ranges.part_size_mm > 0;
  if (worst.point.required_n && errors_range) climb(of, design, closing, friction, worst);

  const LocationError off = location_error(of, design);
  robust.location_error_mm = off.moved_mm;
  robust.location_error_deg = off.turned_deg;
  robust.worst_required_n = worst.point.required_n;
  robust.failure = worst.point.failure;
  robust.friction = friction;
  robust.pins = worst.errors;
  robust.critical = of.disturbances.empty() ? "none" : of.disturbances[worst.point.critical].name;
  const model::Actuator& actuator = of.kit.actuator;
  robust.usable_n = of.ranges.air_pressure.lo * actuator.max_squeeze_n - 2 * actuator.force_uncertainty_n;
  robust.margin_n = worst.point.required_n ? robust.usable_n - *worst.point.required_n : 0;
  if (const auto bound = closing.bound(of.ranges)) {
    robust.location_bound_mm = bound->moved_mm;
    robust.location_bound_deg = kDegPerRad * bound->turned_rad;
  }
  return robust;
}

}  // namespace pinjaw::planner
