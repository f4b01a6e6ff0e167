#pragma once

#include <array>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "host/geometry/surface.hpp"
#include "host/model/disturbance.hpp"

namespace pinjaw::planner {

using geometry::Vector3d;

/// Whether a jet from `from` (unit, away from the part) reaches the surface first at `p_mm`: traced as spray
/// samples are, from outside the part.
bool jet_meets_first(const geometry::Surface& surface, const Vector3d& p_mm, const Vector3d& from);

/// Whether a spray may come from the direction `from` (unit).
bool may_come_from(const model::Spray& spray, const Vector3d& from);

/// Where the jets of one spray reach a surface: points that they reach are told with a direction, stretches
/// that none reaches with a proof; between the two nothing is said. Remembers what it has found; not for
/// concurrent use.
class JetReach {
 public:
  /// `surface` outlives it.
  JetReach(const geometry::Surface& surface, const model::Spray& spray);

  /// A direction from which a jet reaches the point of `triangle` first, found among some hundred fixed ones
  /// and by following the deepest view; nothing where none was found, which proves nothing.
  std::optional<Vector3d> direction_to(const Vector3d& p_mm, int triangle);

  /// Whether no direction of the spray lies before the triangle: then no jet can reach any of it.
  [[nodiscard]] bool faces_away(int triangle) const;

 private:
  [[nodiscard]] Vector3d normal_of(int triangle) const;
  [[nodiscard]] std::optional<Vector3d> search(const Vector3d& p_mm, const Vector3d& normal) const;
  [[nodiscard]] bool try_from(const Vector3d& p_mm, const Vector3d& normal, const Vector3d& from) const;
  [[nodiscard]] double view_mm(const Vector3d& p_mm, const Vector3d& from) const;

  const geometry::Surface& surface_;
  model::Spray spray_;
  std::vector<Vector3d> spread_;  ///< over the directions of the spray
  std::vector<Vector3d> axes_;    ///< along which holes and pockets are likely to open
  std::map<std::pair<int, std::array<double, 3>>, std::optional<Vector3d>> known_;
};

}  // namespace pinjaw::planner
