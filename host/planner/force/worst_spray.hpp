#pragma once

#include <optional>
#include <span>

#include "host/geometry/surface.hpp"
#include "host/model/design.hpp"
#include "host/planner/force/disturbances.hpp"
#include "host/planner/force/grasp.hpp"
#include "host/planner/force/jet_reach.hpp"
#include "host/planner/force/squeeze.hpp"

/// The spray that needs the most squeeze, anywhere on the surface that jets reach: the samples of phase 5
/// draw some hundred points of that surface, this search leaves none out.
namespace pinjaw::planner {

/// A part's surface as jets see it, shared by all its designs.
struct SprayedPart {
  const geometry::Surface* surface = nullptr;  ///< part frame
  double chord_error_mm = 0;                   ///< of its triangles on curved faces
};

/// How near the two ends of the bracket shall come, and when to give up.
struct WorstOptions {
  double tolerance_n = 0.05;
  double tolerance_share = 0.002;  ///< of the force; the larger tolerance counts
  int most_splits = 1000;          ///< chosen: some seconds where a pocket hides behind others
  int most_looks = 1000;           ///< pieces that are still looked at when no more are split
};

/// Finds it by branch and bound over the surface's triangles: F_sq is convex, and a jet's wrench affine in
/// the place and in the normal, so a triangle needs no more than its corners do, with each of the corners'
/// normals (of the smooth face, scaled so that their hull holds every normal between them). The low end is a
/// spray traced to its point, a sample of the jets to begin with, so that none needs more than it does;
/// triangles that no jet can reach are left out, others are split until both ends meet. Where they do not
/// before `most_splits`, `closed` is false.
///
/// On flat faces the high end is exact up to rounding. On curved ones it takes in the chord error, and that
/// normals between the mesh's nodes are means of theirs. `sampled_n` is over the samples of the jets' counts
/// and seeds that hit the part's outside. Nothing where there is no jet, or none reaches anything.
class WorstSpray {
 public:
  WorstSpray(const SprayedPart& part, std::vector<Jet> jets, const WorstOptions& options = {});

  /// For one grasp (turned part frame, by `side`).
  std::optional<model::Certified> of(const Grasp& grasp, model::Side side, model::FrictionModel friction);

 private:
  SprayedPart part_;
  WorstOptions options_;
  std::vector<Jet> jets_;
  std::vector<JetReach> reach_;                 ///< one a jet
  std::vector<std::vector<SprayHit>> samples_;  ///< of each jet: those that hit the outside
};

/// The squeeze that a jet on `p_mm` with the outward unit `normal` needs, with the worst of what acts with
/// it; +inf where none resists it.
struct JetNeed {
  double force_n = 0;
  std::size_t with = 0;
};
JetNeed jet_need(SqueezeSolver& solver, const Jet& jet, const Vector3d& p_mm, const Vector3d& normal,
                 model::Side side, model::FrictionModel friction);

}  // namespace pinjaw::planner
