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

/// A direction (need not be a unit vector), and the name it is told by; unnamed, its components tell it.
struct Heading {
  Heading(Vector3d along, std::string called = {}) : direction(std::move(along)), name(std::move(called)) {}

  Vector3d direction;
  std::string name;
};

/// Weight at the centroid, one load per pose: a pose says where down is in the part frame.
struct Gravity {
  std::string name;
  std::vector<Heading> poses = {Vector3d(-Vector3d::UnitZ())};
};

/// Inertia of the part under a peak acceleration, at the centroid, one load per listed direction.
struct Acceleration {
  std::string name;
  double peak_g = 0;
  std::vector<Heading> along;
  bool every_direction = false;  ///< then `along` is empty
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

/// A drill at `at_mm` that feeds along `axis` (into the part): thrust along it, the drill's torque about it,
/// and the pull against it when the drill breaks through.
struct Drilling {
  enum class Turns { Right, Left, Both };  ///< an ordinary drill turns right: torque along the feed

  std::string name;
  Vector3d at_mm = Vector3d::Zero();
  Vector3d axis = -Vector3d::UnitZ();
  double thrust_n = 0;
  double torque_nmm = 0;
  double pull_n = 0;
  Turns turns = Turns::Right;
};

/// Something pressed into the part along `along`, with a side load up to `side_n` any way across it.
struct Insertion {
  std::string name;
  Vector3d at_mm = Vector3d::Zero();
  Vector3d along = -Vector3d::UnitZ();
  double force_n = 0;
  double side_n = 0;
};

/// A tool that follows straight runs from point to point: a constant force, and one along its travel.
struct Path {
  std::string name;
  std::vector<Vector3d> points_mm;  ///< 2 or more, neighbours apart
  Vector3d force_n = Vector3d::Zero();
  double drag_n = 0;            ///< along the travel
  bool back_and_forth = false;  ///< drags the other way, too
};

/// A cutter whose force turns in the plane across its axis, at one point or along straight runs.
struct Milling {
  std::string name;
  std::vector<Vector3d> points_mm;  ///< 1 or more
  Vector3d axis = -Vector3d::UnitZ();
  double side_n = 0;      ///< any way across the axis
  double axial_n = 0;     ///< either way along it
  double torque_nmm = 0;  ///< either way about it
};

/// What a task says of one disturbance; everything in the part frame, before `side` turns it.
using SingleSource =
    std::variant<Gravity, Acceleration, Spray, PointForce, PlainWrench, Drilling, Insertion, Path, Milling>;

/// Sources that act at the same time: one load for each choice of one load from each. At most one is a spray.
struct Together {
  std::string name;
  std::vector<SingleSource> of;
};

using DisturbanceSource = std::variant<Gravity, Acceleration, Spray, PointForce, PlainWrench, Drilling,
                                       Insertion, Path, Milling, Together>;

/// Force of a jet that the surface turns back: F = 2 rho Q^2 / A (BB 4.1).
/// `nozzle_mm` aperture diameter, `flow_l_s` litres per second, `density_kg_m3` of the liquid.
struct Nozzle {
  double nozzle_mm = 0;
  double flow_l_s = 0;
  double density_kg_m3 = 1000;
};
double jet_force_n(const Nozzle& nozzle);

}  // namespace pinjaw::model
