#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "host/base/expected.hpp"
#include "host/geometry/surface.hpp"
#include "host/model/profile.hpp"
#include "host/model/task.hpp"
#include "host/part/curves.hpp"

/// Parts as the planner sees them: a surface, exact edges and a mass, whatever file they came from.
namespace pinjaw::part {

/// One solid of the file.
struct Solid {
  std::string name;  ///< product name; empty where the file gives none
  double volume_mm3 = 0;
};

/// Where the edges of the file went; total = kept + seams + degenerate.
struct EdgeCounts {
  int total = 0;
  int kept = 0;
  int seams = 0;       ///< seen twice by one closed face: no border at all
  int degenerate = 0;  ///< poles and cone tips: no curve in space
  int freeform = 0;    ///< of those kept: neither line nor circle nor ellipse, held as a polyline
  friend bool operator==(const EdgeCounts&, const EdgeCounts&) = default;
};

/// What became of the facets of an STL file. Its shells are the connected pieces of its surface.
struct MeshCounts {
  int facets = 0;         ///< in the file
  int degenerate = 0;     ///< dropped: two corners are one point
  int repeated = 0;       ///< dropped: the same facet stands before
  int turned = 0;         ///< corners put in the other order, so that the outside is outside
  int shells = 0;         ///< connected pieces
  int open_edges = 0;     ///< not as many facets on one side as on the other
  int crowded_edges = 0;  ///< more than two facets: shells that touch along an edge
  [[nodiscard]] bool closed() const { return open_edges == 0; }
  friend bool operator==(const MeshCounts&, const MeshCounts&) = default;
};

/// Where the contour edges of a mesh went; edges = creases + silhouettes + upright + gentle.
struct ContourCounts {
  int edges = 0;        ///< of the mesh: folded, turning over, or without a neighbour
  int creases = 0;      ///< chained and fitted
  int silhouettes = 0;  ///< chained and fitted: a smooth face turns from down to up
  int upright = 0;      ///< left out: a point in plan
  int gentle = 0;       ///< left out: folded between two sides of which none is steep
  int jagged = 0;       ///< of the silhouettes, left out: no line or arc follows them
  friend bool operator==(const ContourCounts&, const ContourCounts&) = default;
};

/// A part in the part frame (DESIGN 2), or turned to its gripper by `turned`. Lengths in mm, mass in kg.
struct Part {
  std::string name;  ///< the profile's, or the selected base's, else the file's stem
  std::filesystem::path file;
  std::string sha256;  ///< of the file's bytes
  geometry::Surface surface;
  std::vector<EdgeCurve> edges;
  std::vector<Wall> walls;
  std::vector<Contour> contours;
  EdgeCounts edge_counts;
  std::optional<MeshCounts> mesh_counts{};  ///< of an STL file, which has contours instead of edges and walls
  ContourCounts contour_counts{};
  double mesh_deflection_mm =
      0;  ///< chord error of `surface`: kMeshDeflectionMm unless the part is too large for it
  std::vector<Solid> solids;  ///< all solids of the file, in the file's order
  double mass_kg = 0;         ///< 0 where the source states neither mass nor density
  double volume_mm3 = 0;
  Vector3d centroid_mm = Vector3d::Zero();
  /// The profile it was made of, while that lies in plan: its edges are the features. A turned profile is
  /// mirrored: each edge keeps its number and its material on the left, so the list runs against the travel.
  std::optional<model::Profile> profile;
};

/// Which solids of a file make the part.
struct Selection {
  std::string base;   ///< product name, case ignored, of the base solid; empty: every solid of the file
  bool rest = false;  ///< take all solids but the base instead: what is attached to it
};

/// Chord error of the mesh, eps/5 of DESIGN 3.1 no. 1.
inline constexpr double kMeshDeflectionMm = 0.004;

/// A mesh that would need more triangles is made coarser; some 100 MB and two seconds.
inline constexpr int kMostTriangles = 600'000;

/// The part of a source: its STEP file by OpenCASCADE, or its profile extruded, turned so that `up` is +z.
/// A sentence where the file is missing, is not STEP, is broken or holds no solid.
base::Expected<Part> read_part(const model::PartSource& source, const Selection& selection = {});

/// Whether a source has exact faces: a STEP file or a profile, but not an STL mesh.
bool has_brep(const model::PartSource& source);

/// The part as its gripper sees it: itself from below; from above turned by pi about y (DESIGN 2, BB 3.6).
Part turned(const Part& part, model::Side side);

/// The rotation from the part frame to that of a gripper on this side.
Eigen::Matrix3d rotation_to(model::Side side);

/// A curve of the plan view seen from behind: mirrored across the y axis (`axis` 0: x changes sign) or the x
/// axis (1: y changes sign). Segments swap their ends, so material on the left stays on the left.
geometry::Curve mirrored(const geometry::Curve& curve, int axis);

/// The rotation that takes the direction `up` to +z by the shortest way; up = -z turns by pi about x (DESIGN
/// 2).
Eigen::Matrix3d upright_rotation(const Vector3d& up);

}  // namespace pinjaw::part
