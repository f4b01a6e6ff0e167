#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace pinjaw::model {

using Eigen::Vector3d;

/// Force first (N), then torque (N mm), about the origin of the frame it is given in.
using Wrench = Eigen::Matrix<double, 6, 1>;

/// A wrench on the part that a design must resist, and the name it is told by (`spray[17]`).
struct Disturbance {
  std::string name;
  Wrench wrench = Wrench::Zero();
};

/// Weight along `direction` (need not be a unit vector), in the part frame, at the centroid.
struct Gravity {
  std::string name;
  Vector3d direction = -Vector3d::UnitZ();
};

/// Inertia of the part under a peak acceleration, at the centroid, one load per listed direction.
struct Acceleration {
  std::string name;
  double peak_g = 0;
  std::vector<Vector3d> along;
};

/// Sampled jet forces on the surface (BB 4.1).
struct Spray {
  std::string name;
  double force_n = 0;
  int count = 0;
  std::uint64_t seed = 1;
  std::optional<Vector3d> from;      ///< where the jet comes from, as a direction from the part
  std::optional<double> within_rad;  ///< half-angle about `from`
};

struct PointForce {
  std::string name;
  Vector3d at_mm = Vector3d::Zero();
  Vector3d force_n = Vector3d::Zero();
};

struct PlainWrench {
  std::string name;
  Vector3d force_n = Vector3d::Zero();
  Vector3d torque_nmm = Vector3d::Zero();
};

/// What a task says of one disturbance; everything in the part frame, before `side` turns it.
using DisturbanceSource = std::variant<Gravity, Acceleration, Spray, PointForce, PlainWrench>;

/// Force of a jet that the surface turns back: F = 2 rho Q^2 / A (BB 4.1).
/// `nozzle_mm` aperture diameter, `flow_l_s` litres per second, `density_kg_m3` of the liquid.
struct Nozzle {
  double nozzle_mm = 0;
  double flow_l_s = 0;
  double density_kg_m3 = 1000;
};
double jet_force_n(const Nozzle& nozzle);

}  // namespace pinjaw::model
