#include "host/sequence/loads.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "host/planner/force/disturbances.hpp"

namespace pinjaw::sequence {

namespace {

constexpr double kStandardGravity = 9.80665;  // m/s^2, CGPM 1901
constexpr double kStopSeconds = 0.05;         // chosen: an arm's bounce on its stops lasts some 50 ms
constexpr double kHitSeconds = 0.05;          // chosen: a jet moves on by its own width in some 50 ms

/// The wrench of a force at the centroid.
model::Wrench at_centroid(const Carried& carried, const model::Vector3d& force_n) {
  model::Wrench wrench;
  wrench << force_n, carried.centroid_mm.cross(force_n);
  return wrench;
}

model::Wrench inertia(const Carried& carried, double g, const model::Vector3d& along) {
  return at_centroid(carried, carried.mass_kg * g * kStandardGravity * along.normalized());
}

}  // namespace

model::Wrench weight(const Carried& carried) {
  return inertia(carried, 1, carried.down);
}

std::vector<Load> loads_of(const model::MoveStep& move, const Carried& carried,
                           const model::Vector3d& along) {
  const double ramp_s = std::min(kStopSeconds, move.seconds / 2);
  const model::Wrench still = weight(carried);
  return {{"speeding up", still + inertia(carried, move.peak_g, -along), ramp_s},
          {"moving", still, std::max(0.0, move.seconds - 2 * ramp_s)},
          {"slowing down", still + inertia(carried, move.peak_g, along), ramp_s}};
}

std::vector<Load> loads_of(const model::RotateStep& rotate, const Carried& carried,
                           const model::Vector3d& axis) {
  const double stop_s = std::min(kStopSeconds, rotate.seconds / 5);
  const double swing_s = std::max(0.0, rotate.seconds - 4 * stop_s);
  const auto at_angle = [&](double angle_rad) {
    Carried turned = carried;
    turned.down = turned_down(carried.down, axis, angle_rad);
    return turned;
  };
  std::vector<Load> loads;
  const auto stop = [&](const Carried& here, const char* name) {
    for (const double sign : {1.0, -1.0}) {
      const model::Vector3d along = sign * model::Vector3d::UnitZ();
      loads.push_back({name, weight(here) + inertia(here, rotate.peak_g, along), stop_s});
    }
  };
  stop(carried, "leaving the stop");
  constexpr int kPieces = 12;
  for (int i = 1; i <= kPieces; ++i) {
    const Carried here = at_angle(rotate.angle_rad * i / kPieces);
    loads.push_back({fmt::format("turned {} of {}", i, kPieces), weight(here), swing_s / kPieces});
  }
  stop(at_angle(rotate.angle_rad), "hitting the stop");
  return loads;
}

base::Expected<std::vector<Load>> loads_of(const model::SprayStep& spray, const Carried& carried,
                                           const planner::Scene& scene) {
  model::Spray jet;
  jet.force_n = spray.force_n;
  jet.count = std::max(1, static_cast<int>(std::lround(spray.seconds / kHitSeconds)));
  jet.seed = spray.seed;
  const auto hits = planner::spray_hits(jet, scene.part.surface);
  if (!hits) return tl::unexpected(hits.error());
  std::vector<Load> loads;
  for (std::size_t i = 0; i < hits->size(); ++i) {
    const planner::SprayHit& hit = (*hits)[i];
    model::Wrench wrench;
    wrench << hit.force_n, hit.p_mm.cross(hit.force_n);
    loads.push_back({fmt::format("spray[{}]", i), weight(carried) + wrench, spray.seconds / jet.count});
  }
  return loads;
}

model::Vector3d turned_down(const model::Vector3d& down, const model::Vector3d& axis, double angle_rad) {
  // the station turns with the part; seen from the part, down turns the other way
  return Eigen::AngleAxisd(-angle_rad, axis.normalized()) * down;
}

}  // namespace pinjaw::sequence
