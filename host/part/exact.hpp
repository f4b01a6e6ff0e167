#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <variant>
#include <vector>

#include "host/base/expected.hpp"
#include "host/geometry/surface.hpp"
#include "host/part/part.hpp"

/// What a Surface tells of a body's triangles, told of its exact faces: slow, for a few final answers.
namespace pinjaw::part {

/// A body whose exact faces are asked.
struct ExactBody {
  model::PartSource source;  ///< with its profile, where it is one
  Selection selection{};
  /// Pose in the frame of the questions, of the body as read_part() places it.
  Eigen::Isometry3d X_QB = Eigen::Isometry3d::Identity();
};

/// An upright column over a region in plan, ends at the slab's; a sweep of radius 0 without length is a line
/// or, where the slab has one height, a point.
struct Column {
  std::variant<geometry::Sweep, geometry::Rectangle> region;
  geometry::Slab slab;
};

/// How far the column is from the body. Where it meets the body, minus the depth: by how much the column must
/// shrink on all sides to be clear, at most what it can shrink. 0 where they just touch, and of a line or
/// point that meets the body.
struct ExactDistance {
  std::size_t body = 0;  ///< its place in the list of bodies
  Column column;
};

enum class End { Lowest, Highest };

/// The lowest or highest z of the body's surface in the column, to within kHeightStep_mm; +inf or -inf where
/// there is none. `guess_mm` is where it is thought to be: the nearer, the sooner it is found.
struct ExactHeight {
  std::size_t body = 0;
  Column column;
  End end = End::Lowest;
  double guess_mm = 0;
};
inline constexpr double kHeightStep_mm = 1e-4;  // chosen: a tenth of the least difference worth telling

using ExactQuestion = std::variant<ExactDistance, ExactHeight>;

struct ExactAnswers {
  std::vector<double> mm;  ///< one for each question
  std::vector<double>
      tolerance_mm;  ///< of each body: how well its faces and edges fit, as its file says; 0 of one not asked
};

/// Answers all questions with one visit to OpenCASCADE, in a process of its own (in_cad_process), each body
/// that is asked read once. Distances are minima of BRepExtrema_DistShapeShape over the faces that are near
/// enough, which proved right where Boolean operations silently gave nothing. A sentence where a body cannot
/// be read, has no exact faces, or a distance cannot be computed. Precondition: the questions' bodies exist.
base::Expected<ExactAnswers> ask_exactly(const std::vector<ExactBody>& bodies,
                                         const std::vector<ExactQuestion>& questions);

}  // namespace pinjaw::part
