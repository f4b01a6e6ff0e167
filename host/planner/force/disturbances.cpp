#include "host/planner/force/disturbances.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <map>

namespace pinjaw::planner {
namespace {

using geometry::Vector3d;
using model::Disturbance;
using model::Wrench;
using Loads = base::Expected<std::vector<Disturbance>>;

constexpr double kStandardGravity = 9.80665;  // m/s2, by definition, CGPM 1901

Wrench force_at(const Vector3d& p_mm, const Vector3d& force_n) {
  Wrench wrench;
  wrench << force_n, p_mm.cross(force_n);
  return wrench;
}

std::string named(const std::string& name, const char* kind) {
  return name.empty() ? kind : name;
}

/// `+z` along an axis, else the direction's unit components.
std::string label_of(const Vector3d& direction) {
  const Vector3d unit = direction.normalized();
  constexpr double kOnAxis = 1e-9;
  for (int k = 0; k < 3; ++k) {
    if (std::abs(unit[k]) > 1 - kOnAxis) return fmt::format("{}{}", unit[k] > 0 ? '+' : '-', "xyz"[k]);
  }
  return fmt::format("{:.3g},{:.3g},{:.3g}", unit.x(), unit.y(), unit.z());
}

/// The loads of one source, each with the name it is told by.
struct LoadsOf {
  const Body& body;

  Loads operator()(const model::Gravity& gravity) const {
    if (body.mass_kg <= 0) return base::failure("gravity needs the part's mass: give a material or mass_kg");
    const Vector3d weight_n = body.mass_kg * kStandardGravity * gravity.direction.normalized();
    return std::vector<Disturbance>{{named(gravity.name, "gravity"), force_at(body.centroid_mm, weight_n)}};
  }

  Loads operator()(const model::Acceleration& acceleration) const {
    if (body.mass_kg <= 0) {
      return base::failure("an acceleration needs the part's mass: give a material or mass_kg");
    }
    std::vector<Disturbance> loads;
    const std::string name = named(acceleration.name, "acceleration");
    const double force_n = body.mass_kg * acceleration.peak_g * kStandardGravity;
    for (const Vector3d& along : acceleration.along) {
      loads.push_back({fmt::format("{}[{}]", name, label_of(along)),
                       force_at(body.centroid_mm, force_n * along.normalized())});
    }
    return loads;
  }

  Loads operator()(const model::Spray& spray) const {
    if (body.surface == nullptr) return base::failure("a spray needs the part's surface");
    const auto hits = spray_hits(spray, *body.surface);
    if (!hits) return tl::unexpected(hits.error());
    std::vector<Disturbance> loads;
    const std::string name = named(spray.name, "spray");
    for (const SprayHit& hit : *hits) {
      loads.push_back({fmt::format("{}[{}]", name, loads.size()), force_at(hit.p_mm, hit.force_n)});
    }
    return loads;
  }

  Loads operator()(const model::PointForce& force) const {
    return std::vector<Disturbance>{{named(force.name, "force"), force_at(force.at_mm, force.force_n)}};
  }

  Loads operator()(const model::PlainWrench& plain) const {
    Wrench wrench;
    wrench << plain.force_n, plain.torque_nmm;
    return std::vector<Disturbance>{{named(plain.name, "wrench"), wrench}};
  }
};

/// Several loads of one source share their source's number: `spray[3]`, then `spray#2[3]`.
void tell_apart(std::vector<Disturbance>& loads, std::map<std::string, int>& seen) {
  if (loads.empty()) return;
  const std::string base = loads.front().name.substr(0, loads.front().name.find('['));
  const int number = ++seen[base];
  if (number == 1) return;
  for (Disturbance& load : loads) load.name.insert(base.size(), fmt::format("#{}", number));
}

}  // namespace

base::Expected<std::vector<Disturbance>> disturbances_of(const model::Task& task, const Body& body) {
  Wrench always = Wrench::Zero();
  for (const model::DisturbanceSource& source : task.always) {
    Loads loads = std::visit(LoadsOf{body}, source);
    if (!loads) return loads;
    if (loads->size() != 1) {
      return base::failure(
          "always: a source of several loads cannot act all at once; list it under disturbances");
    }
    always += loads->front().wrench;
  }
  std::vector<Disturbance> all;
  std::map<std::string, int> seen;
  for (const model::DisturbanceSource& source : task.disturbances) {
    Loads loads = std::visit(LoadsOf{body}, source);
    if (!loads) return loads;
    tell_apart(*loads, seen);
    for (Disturbance& load : *loads) {
      load.wrench += always;
      all.push_back(std::move(load));
    }
  }
  if (all.empty() && !task.always.empty()) all.push_back({"always", always});
  return all;
}

Wrench turned(const Wrench& wrench, model::Side side) {
  if (side == model::Side::Below) return wrench;
  Wrench result = wrench;
  for (const int k : {0, 2, 3, 5}) result[k] = -result[k];
  return result;
}

std::vector<Wrench> turned_wrenches(const std::vector<Disturbance>& disturbances, model::Side side) {
  std::vector<Wrench> wrenches;
  wrenches.reserve(disturbances.size());
  for (const Disturbance& disturbance : disturbances) wrenches.push_back(turned(disturbance.wrench, side));
  return wrenches;
}

}  // namespace pinjaw::planner
