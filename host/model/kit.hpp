#pragma once

#include <optional>
#include <string>
#include <vector>

#include "host/geometry/plane.hpp"

namespace pinjaw::model {

using geometry::Interval;
using geometry::Vector2d;

enum class JawSide { Left, Right };

/// A hole of a grid plate: column 0 is nearest the other jaw, row 0 has the least y (DESIGN 2).
struct Hole {
  JawSide jaw = JawSide::Left;
  int column = 0;
  int row = 0;
  friend auto operator<=>(const Hole&, const Hole&) = default;
};

struct Grid {
  double spacing_mm = 0;
  int columns = 0;
  int rows = 0;
  double edge_offset_mm = 0;
};

struct PinStock {
  double radius_mm = 0;
  std::vector<double> lengths_mm;  ///< ascending stock lengths; empty where any length can be cut
  double min_engagement_mm = 0;
  double protrusion_mm = 0;
  double clearance_mm = 0.2;
  double min_foot_margin_mm = 0;
};

/// A box that moves with each jaw beside its plate, such as the finger that carries it. In the jaw's frame: x
/// outwards from the plate's inner edge, y from the middle row, z from the plate's top; the right jaw's
/// mirrors the left's.
struct JawBody {
  Interval x_mm;
  Interval y_mm;
  Interval z_mm;
};

struct Jaws {
  static constexpr int kMaxBodies = 4;

  Interval separation_mm;
  double plate_gap_mm = 0;           ///< plate top to the part's lowest point
  std::optional<double> opening_mm;  ///< travel of each jaw when it opens; nothing: full travel
  double plate_thickness_mm = 10;
  std::vector<JawBody> bodies;  ///< at most kMaxBodies
};

struct Actuator {
  double max_squeeze_n = 0;
  double force_uncertainty_n = 0;
  /// What a design may require: 2u is lost where force is inferred from pressure (DESIGN 3, phase 5).
  [[nodiscard]] double usable_squeeze_n() const { return max_squeeze_n - 2 * force_uncertainty_n; }
};

struct Grip {
  double light_n = 12;
  double separation_tol_mm = 0.5;
  double slip_tol_mm = 0.2;
  double stable_ms = 150;
};

/// Grid plates, pins and actuator of one gripper.
struct Kit {
  std::string name;
  std::string sha256;  ///< of the file it was read from
  Grid grid;
  PinStock pins;
  Jaws jaws;
  Actuator actuator;
  Grip grip;
};

/// The plate and the bodies of one jaw, plate first, in the jaw's frame (see JawBody). The plate is its
/// holes' rectangle grown by the edge offset (DESIGN 3.1 no. 8).
std::vector<JawBody> jaw_solids(const Kit& kit);

/// Settings that are each allowed and cannot stand together in one kit.
enum class KitConflict {
  PinsOverlap,          ///< pins in neighbouring holes
  PinMeetsOtherPlate,   ///< protrusion reaches the plate of a gripper from the other side
  NoPinReachesThePart,  ///< no stock length passes the plate gap
};
std::vector<KitConflict> conflicts_of(const Kit& kit);

/// Centre of `hole` in the gripper frame at jaw separation `separation_mm` (DESIGN 2).
Vector2d p_GHole_mm(const Grid& grid, const Hole& hole, double separation_mm);

/// Jaw separation when opened from `separation_mm`: min(s_max, s + 2 opening) (DESIGN 3, phase 4).
double open_separation_mm(const Jaws& jaws, double separation_mm);

}  // namespace pinjaw::model
