#pragma once

#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "host/base/expected.hpp"
#include "host/base/isolated.hpp"
#include "host/geometry/mesh.hpp"
#include "host/model/profile.hpp"
#include "host/part/part.hpp"

class TopoDS_Shape;  // OpenCASCADE's, complete only in this folder's sources

/// Boundary representations, and what the planner needs out of them. Private to host/part.
namespace pinjaw::part {

using Shape = std::shared_ptr<const TopoDS_Shape>;

struct NamedShape {
  std::string name;
  Shape shape;
};

/// The solids of a STEP file's text, in mm, in the file's order; at least one.
/// `file` only names it in the sentence of a failure.
base::Expected<std::vector<NamedShape>> read_step(const std::string& text, const std::string& file);

/// The profile's loops extruded from z = 0 to its thickness; a failure where they bound no area.
base::Expected<Shape> prism_of(const model::Profile& profile);

/// Several solids as one shape.
Shape compound_of(const std::vector<NamedShape>& solids);

struct ChosenSolids {
  std::vector<NamedShape> all;     ///< of the file, in its order
  std::vector<NamedShape> chosen;  ///< that make the part
};

/// The solids of a STEP file's text or of the profile, and those of the selection among them.
base::Expected<ChosenSolids> chosen_solids(const model::PartSource& source, const std::string& bytes,
                                           const Selection& selection);

struct BrepMesh {
  geometry::TriangleMesh mesh;
  double deflection_mm = 0;  ///< chord error asked of the mesher
};

/// Triangles of the shape's surface, faces numbered from 1. Starts at kMeshDeflectionMm and doubles it, up to
/// 0.8 eps, while there are more than `most_triangles`.
base::Expected<BrepMesh> mesh_of(const Shape& shape, int most_triangles);

struct BrepMass {
  double volume_mm3 = 0;
  Vector3d centroid_mm = Vector3d::Zero();
};
base::Expected<BrepMass> mass_of(const Shape& shape);

struct BrepEdges {
  std::vector<EdgeCurve> edges;
  EdgeCounts counts;
};
base::Expected<BrepEdges> edges_of(const Shape& shape);

/// A face that can be a wall when it stands upright.
struct PlaneFace {
  Vector3d normal = Vector3d::UnitX();
};
struct CylinderFace {
  Vector3d point_mm = Vector3d::Zero();
  Vector3d axis = Vector3d::UnitZ();
  double radius_mm = 0;
};
struct WallFace {
  int face = 0;
  std::variant<PlaneFace, CylinderFace> surface;
};
base::Expected<std::vector<WallFace>> wall_faces_of(const Shape& shape);

/// The silhouettes of a shape that mesh_of() has meshed, for an observer along `up`: found where the true
/// normal changes its side between mesh nodes, then on the exact faces to rounding. Lines that are edges
/// between two curved faces or seams are among them.
base::Expected<std::vector<geometry::Silhouette>> silhouettes_of(const Shape& shape, const Vector3d& up);

/// All that OpenCASCADE tells of a part: plain values, in the file's frame. Nothing else leaves it.
struct BrepValues {
  std::vector<Solid> solids;  ///< all of the file, in its order
  BrepMass mass;              ///< from here on of the chosen solids
  BrepEdges edges;
  std::vector<WallFace> wall_faces;
  BrepMesh mesh;  ///< with its silhouettes
};

/// The values of the `chosen` ones among `solids`, silhouettes as they are when the direction `up` stands
/// upright; `stage` is told what is being done.
base::Expected<BrepValues> values_of(const std::vector<NamedShape>& solids,
                                     const std::vector<NamedShape>& chosen, const Vector3d& up,
                                     const base::IsolatedStage& stage);

}  // namespace pinjaw::part
