#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "host/geometry/plane.hpp"
#include "host/model/kit.hpp"
#include "host/model/robust.hpp"

namespace pinjaw::model {

/// How many pins each jaw has: left + right.
enum class Split { TwoTwo, ThreeOne, OneThree };
std::string_view to_string(Split split);

/// One pin of a design. Positions in the gripper frame, heights in the part frame turned by the task's side.
struct PinDesign {
  Hole hole;
  double length_mm = 0;
  double top_z_mm = 0;
  Interval contact_z_mm;  ///< one point where lo == hi
  Vector2d contact_mm = Vector2d::Zero();
  Vector2d normal = Vector2d::Zero();  ///< unit, from the pin into the part
  double foot_margin_mm = 0;
  int feature = 0;
};

struct Squeeze {
  double required_n = 0;
  double usable_n = 0;
  double limit_n = 0;
  double margin_n = 0;   ///< usable_n - required_n
  std::string critical;  ///< name of the disturbance that needs required_n
};

/// Another column shift of the same design that also loads.
struct Alternative {
  int left_shift = 0;
  int right_shift = 0;
  double jaw_separation_mm = 0;
};

/// The spray that needs the most squeeze of a design, anywhere a jet reaches the part: a bracket. Part frame.
struct Certified {
  double sampled_n = 0;  ///< the most that a sampled spray needs; never above low_n
  double low_n = 0;      ///< needed by the spray at `at_mm`, which a jet reaches; +inf: no squeeze resists it
  double high_n = 0;     ///< none needs more, wherever it hits
  std::string spray;     ///< name of that spray, and of what acts with it where that has several states
  Eigen::Vector3d at_mm = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< unit, outward; the force acts against it
  Eigen::Vector3d from = Eigen::Vector3d::Zero();    ///< unit: the jet comes from there
  bool curved = false;                               ///< whether it hits a curved face
  bool closed = true;                                ///< whether the ends met as near as the search aims at
};

/// What a design comes to on the part's exact faces, of which phases 3 and 4 know the triangles. In mm.
struct Exact {
  double largest_difference_mm = 0;  ///< between triangles and faces, over all heights and contacts asked
  double contact_gap_mm = 0;         ///< of the pin that is farthest from just touching, to either side
  double least_clearance_mm = 0;     ///< of the jaws, and of pins from obstacles, on the whole way
};

/// A planar fixture made 3-d: one pin layout that holds the part.
struct Design {
  std::string id;
  Split split = Split::TwoTwo;
  double jaw_separation_mm = 0;
  double jaw_open_mm = 0;
  double closure_margin = 0;    ///< least form-closure multiplier, their sum being 1
  geometry::Pose2 part_pose;    ///< X_GP of the part turned by the task's side
  std::vector<PinDesign> pins;  ///< sorted by hole
  Squeeze squeeze;
  std::vector<Alternative> alternatives;
  std::optional<Certified> certified;
  std::optional<Robust> robust;  ///< where it was asked for
  std::optional<Exact> exact;    ///< where it was asked for
};

}  // namespace pinjaw::model
