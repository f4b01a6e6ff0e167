#include "tests/host/planner/robust/vise.hpp"

#include <cmath>
#include <cstddef>
#include <nlopt.hpp>

namespace pinjaw::planner {
namespace {

using geometry::Vector2d;

/// Within this of the design's own pose, in mm and hundredths of a radian, it is the only rest.
const std::vector<double> kReach{0.5, 0.5, 3, 0.5};
constexpr double kOpen_mm = 0.1;  // where it starts

/// Distance of a point from a feature, positive on its free side.
double clearance_mm(const model::Feature& feature, const Vector2d& p_mm) {
  if (const auto* segment = std::get_if<geometry::Segment>(&feature.curve)) {
    const Vector2d along = segment->b_mm - segment->a_mm;
    const Vector2d to = p_mm - segment->a_mm;
    return (along.y() * to.x() - along.x() * to.y()) / along.norm();  // right of travel is free
  }
  const auto& arc = std::get<geometry::Arc>(feature.curve);
  const double from_center_mm = std::hypot(p_mm.x() - arc.center_mm.x(), p_mm.y() - arc.center_mm.y());
  return feature.bulge == model::Bulge::Convex ? from_center_mm - arc.radius_mm
                                               : arc.radius_mm - from_center_mm;
}

struct Vise {
  const model::Design& design;
  const std::vector<model::Feature>& features;
  const model::Kit& kit;
  const std::array<PinOff, 4>& off;

  /// Unknowns: what the design's pose and separation change by: x, y, theta in hundredths, s.
  [[nodiscard]] Vised at(const double* x) const {
    const geometry::Pose2& pose = design.part_pose;
    return {{pose.theta_rad + x[2] / 100, pose.t_mm + Vector2d(x[0], x[1])}, design.jaw_separation_mm + x[3]};
  }
  [[nodiscard]] double room_mm(const double* x, std::size_t pin) const {
    const Vised vised = at(x);
    const model::PinDesign& of = design.pins[pin];
    const Vector2d axis_mm = model::p_GHole_mm(kit.grid, of.hole, vised.separation_mm) + off[pin].axis_mm;
    return clearance_mm(features[static_cast<std::size_t>(of.feature)], vised.part_pose.inverse() * axis_mm) -
           kit.pins.radius_mm - off[pin].radius_mm - off[pin].feature_mm;
  }
};

/// Central differences, so that nothing of the solver under test is used.
template <class F>
void differentiate(const F& f, unsigned n, const double* x, double* gradient) {
  constexpr double kStep = 1e-5;
  std::array<double, 4> at{};
  std::copy(x, x + n, at.begin());
  for (unsigned i = 0; i < n; ++i) {
    at[i] = x[i] + kStep;
    const double above = f(at.data());
    at[i] = x[i] - kStep;
    gradient[i] = (above - f(at.data())) / (2 * kStep);
    at[i] = x[i];
  }
}

double separation(unsigned /*n*/, const double* x, double* gradient, void* /*data*/) {
  if (gradient != nullptr) std::fill(gradient, gradient + 3, 0.0), gradient[3] = 1;
  return x[3];
}

void intrusions(unsigned m, double* result, unsigned n, const double* x, double* gradient, void* data) {
  const Vise& vise = *static_cast<const Vise*>(data);
  for (unsigned pin = 0; pin < m; ++pin) {
    const auto inside = [&](const double* at) { return -vise.room_mm(at, pin); };
    result[pin] = inside(x);
    if (gradient != nullptr) differentiate(inside, n, x, gradient + std::size_t{pin} * n);
  }
}

}  // namespace

std::optional<Vised> closed_by_vise(const model::Design& design, const std::vector<model::Feature>& features,
                                    const model::Kit& kit, const std::array<PinOff, 4>& off) {
  Vise vise{design, features, kit, off};
  nlopt::opt search(nlopt::LD_SLSQP, 4);
  search.set_min_objective(separation, nullptr);
  search.add_inequality_mconstraint(intrusions, &vise, std::vector<double>(4, 1e-10));
  search.set_lower_bounds({-kReach[0], -kReach[1], -kReach[2], -kReach[3]});
  search.set_upper_bounds(kReach);
  search.set_xtol_rel(1e-12);
  search.set_maxeval(500);
  std::vector<double> x{0, 0, 0, kOpen_mm};
  double least = 0;
  try {
    search.optimize(x, least);
  } catch (const nlopt::roundoff_limited&) {
    // as near as doubles come
  } catch (const std::exception&) {
    return std::nullopt;
  }
  return vise.at(x.data());
}

}  // namespace pinjaw::planner
