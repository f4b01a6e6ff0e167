#pragma once

#include <optional>
#include <vector>

#include "host/planner/features/features.hpp"

/// The part's edges, walls and silhouettes in plan. Private to phase 1.
namespace pinjaw::planner {

/// Something of the part that may become features.
struct Source {
  enum class Kind { Edge, Silhouette, Wall, Contour };
  Kind kind = Kind::Edge;
  int number = 0;            ///< of the edge or contour; of the silhouette's or wall's face
  std::optional<Fate> fate;  ///< the best that befell its pieces so far

  void met(Fate with) { fate = fate ? std::max(*fate, with) : with; }
};

/// A candidate for a feature: a source's curve in plan, or a piece of one. Its direction has no meaning.
struct PlanCurve {
  geometry::Curve curve;
  std::size_t source = 0;  ///< position in Projection::sources
  double error_mm = 0;     ///< how far the source may lie from the curve
  std::vector<geometry::Vector3d>
      trace_mm;  ///< the source in space along the curve; of a wall its lowest z, anywhere
};

/// Lowest z of the curve's source where it passes nearest to `p_mm` in plan.
double z_near_mm(const PlanCurve& curve, const geometry::Vector2d& p_mm);

struct Projection {
  std::vector<Source> sources;
  std::vector<PlanCurve> curves;
};

/// All edges, walls and silhouettes of `part` in plan. Lines stay lines and circles that are seen round stay
/// arcs; all other curves are fitted by segments and arcs within kFitMm. Of fitted curves that run above each
/// other the lowest stands for all.
Projection projected(const part::Part& part);

/// How far a fitted curve may lie from its source. Chosen: a quarter of eps, so that both sides of it are
/// looked at safely, and more pieces would serve no pin.
inline constexpr double kFitMm = model::kEps_mm / 4;

}  // namespace pinjaw::planner
