#pragma once

#include <span>
#include <string>
#include <vector>

#include "host/base/expected.hpp"
#include "host/planner/plan/check.hpp"

namespace pinjaw::planner {

/// One figure of a design: what the triangles give, and what the exact faces give.
struct ExactFigure {
  std::string subject;  ///< id of the design
  std::string what;
  double mesh_mm = 0;
  double brep_mm = 0;
  [[nodiscard]] double difference_mm() const;
};

/// A design asked again on exact faces.
struct ExactDesign {
  model::Exact summary;
  std::vector<ExactFigure> figures;
  std::vector<Claim> claims;  ///< what phases 3 and 4 promise, and whether it is so
};

struct ExactReport {
  std::vector<ExactDesign> designs;  ///< in the order asked; none where the part itself has no exact faces
  std::vector<std::string> without_faces;  ///< files that are meshes: nothing exact is known of them
  double tolerance_mm = 0;  ///< by how much a promise may be missed: chord and fit error, and the file's own
};

/// Asks the exact faces of the part, of what is attached to it and of the obstacles what phases 3 and 4 asked
/// their triangles, for each of `designs` from its stated numbers.
///
/// Of each pin in its hole: that it touches the part at its stated contact and cuts it nowhere, closed or on
/// its way from open; that it keeps its clearance under what is above it, engages, and protrudes no further
/// than the kit allows. Of each jaw: that plate and bodies keep clear while the open gripper comes along z
/// and closes. The figures are the heights that bound the top of each pin, the edge it engages, and its gap
/// to the part. A claim fails where no surface within the tolerance of the triangles could make it true. A
/// Failure where OpenCASCADE cannot tell.
base::Expected<ExactReport> recheck_exactly(const Plan& plan, const Scene& scene,
                                            std::span<const model::Design* const> designs);

/// Tells the plan's best `count` designs what they come to on exact faces. A Failure, too, where the part has
/// none.
base::Expected<void> tell_exactly(Plan& plan, const Scene& scene, std::size_t count);

}  // namespace pinjaw::planner
