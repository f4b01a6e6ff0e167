#include <BRepAdaptor_Surface.hxx>
#include <BRep_Tool.hxx>
#include <Poly_PolygonOnTriangulation.hxx>
#include <Poly_Triangulation.hxx>
#include <Standard_Failure.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "host/part/brep.hpp"
#include "host/part/turning.hpp"

namespace pinjaw::part {
namespace {

/// Lean up to which a node may be upright: then its neighbours tell which way the face looks beside it.
/// Chosen: at a tangent border files are right to some 1e-5.
constexpr double kUpright = 1e-4;
constexpr double kLevelLean = 1e-9;    // rounding of a lean: upright stretches of a face look nowhere
constexpr double kSagittaMm = 5e-4;    // points are set closer until the line bulges no more between two
constexpr int kMostHalvings = 6;       // of one mesh edge
constexpr double kSamePointMm = 1e-6;  // where a line meets itself across a seam

using geometry::Silhouette;
using Segment = std::array<std::size_t, 2>;  // two turning points of one triangle

/// One face's mesh and how it leans at its nodes; nodes count from 0.
struct LeaningMesh {
  std::vector<gp_Pnt2d> nodes;
  std::vector<std::array<std::size_t, 3>> triangles;
  std::vector<double> lean;  ///< 0 where there is no normal
  std::vector<int>
      beside;  ///< where upright: the one way all its leaning neighbours look, 0 where they differ
  std::vector<bool> looks_up;
};

LeaningMesh leaning_mesh(const LeaningSurface& surface, const Poly_Triangulation& mesh) {
  LeaningMesh result;
  for (Standard_Integer i = 1; i <= mesh.NbNodes(); ++i) {
    result.nodes.push_back(mesh.UVNode(i));
    result.lean.push_back(surface.lean(mesh.UVNode(i)).value_or(0));
  }
  for (Standard_Integer i = 1; i <= mesh.NbTriangles(); ++i) {
    std::array<Standard_Integer, 3> c{};
    mesh.Triangle(i).Get(c[0], c[1], c[2]);
    result.triangles.push_back({static_cast<std::size_t>(c[0] - 1), static_cast<std::size_t>(c[1] - 1),
                                static_cast<std::size_t>(c[2] - 1)});
  }
  std::vector<bool> near_up(result.nodes.size());
  std::vector<bool> near_down(result.nodes.size());
  for (const auto& corners : result.triangles) {
    for (const std::size_t from : corners) {
      for (const std::size_t to : corners) {
        if (result.lean[to] > kUpright) near_up[from] = true;
        if (result.lean[to] < -kUpright) near_down[from] = true;
      }
    }
  }
  for (std::size_t i = 0; i < result.nodes.size(); ++i) {
    const bool upright = std::abs(result.lean[i]) <= kUpright;
    result.beside.push_back(upright ? near_up[i] - near_down[i] : 0);
    result.looks_up.push_back(result.beside[i] != 0 ? result.beside[i] > 0 : result.lean[i] >= -kLevelLean);
  }
  return result;
}

/// Appends what of the line lies between two neighbouring points, without them.
void refine(const LeaningSurface& surface, const TurningPoint& a, const TurningPoint& b, int halvings,
            std::vector<TurningPoint>& line) {
  if (halvings == 0 || (b.p_mm - a.p_mm).norm() <= kSagittaMm) return;
  const auto middle = surface.turning_near({(a.uv.X() + b.uv.X()) / 2, (a.uv.Y() + b.uv.Y()) / 2});
  if (!middle) return;
  const Vector3d chord = b.p_mm - a.p_mm;
  const Vector3d aside = middle->p_mm - (a.p_mm + b.p_mm) / 2;
  if (aside.norm() > chord.norm() / 2) return;  // led astray, to another line
  const bool bulges = aside.norm() > kSagittaMm;
  if (bulges) refine(surface, a, *middle, halvings - 1, line);
  line.push_back(*middle);
  if (bulges) refine(surface, *middle, b, halvings - 1, line);
}

/// The lines that the segments form, as sequences of points.
std::vector<std::vector<std::size_t>> chained(const std::vector<Segment>& segments, std::size_t points) {
  std::vector<std::vector<std::size_t>> next(points);
  for (const auto& [a, b] : segments) {
    next[a].push_back(b);
    next[b].push_back(a);
  }
  std::vector<bool> used(points);
  std::vector<std::vector<std::size_t>> chains;
  const auto walk = [&](std::size_t start) {
    std::vector<std::size_t> chain{start};
    used[start] = true;
    for (bool more = true; more;) {
      more = false;
      for (const std::size_t to : next[chain.back()]) {
        if (used[to]) continue;
        used[to] = true;
        chain.push_back(to);
        more = true;
        break;
      }
    }
    const auto& ends = next[chain.back()];
    if (chain.size() > 2 && std::ranges::find(ends, start) != ends.end()) chain.push_back(start);
    if (chain.size() > 1) chains.push_back(std::move(chain));
  };
  for (std::size_t i = 0; i < points; ++i) {
    if (!used[i] && next[i].size() == 1) walk(i);
  }
  for (std::size_t i = 0; i < points; ++i) {
    if (!used[i]) walk(i);
  }
  return chains;
}

void append(Silhouette& line, const Vector3d& p_mm, double radius_mm) {
  if (!line.points_mm.empty() && (line.points_mm.back() - p_mm).norm() < kSamePointMm) return;
  line.points_mm.push_back(p_mm);
  line.radius_mm.push_back(radius_mm);
}

/// The lines inside one face where it turns over.
std::vector<Silhouette> inside_of(const LeaningSurface& surface, const LeaningMesh& mesh, int face) {
  std::vector<TurningPoint> points;
  std::map<std::pair<std::size_t, std::size_t>, std::size_t> point_of;
  std::vector<Segment> segments;
  for (const auto& corners : mesh.triangles) {
    std::vector<std::size_t> crossed;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto [a, b] = std::minmax(corners[i], corners[(i + 1) % 3]);
      if (mesh.looks_up[a] == mesh.looks_up[b]) continue;
      const auto [found, is_new] = point_of.try_emplace({a, b}, points.size());
      if (is_new) points.push_back(surface.turning_between(mesh.nodes[a], mesh.nodes[b]));
      crossed.push_back(found->second);
    }
    if (crossed.size() == 2) segments.push_back({crossed[0], crossed[1]});
  }
  std::vector<Silhouette> lines;
  for (const auto& chain : chained(segments, points.size())) {
    std::vector<TurningPoint> dense{points[chain.front()]};
    for (std::size_t i = 1; i < chain.size(); ++i) {
      refine(surface, points[chain[i - 1]], points[chain[i]], kMostHalvings, dense);
      dense.push_back(points[chain[i]]);
    }
    Silhouette line{.face = face, .points_mm = {}, .radius_mm = {}};
    for (const TurningPoint& point : dense) append(line, point.p_mm, surface.upright_radius_mm(point.uv));
    if (line.points_mm.size() > 1) lines.push_back(std::move(line));
  }
  return lines;
}

/// A node of an edge as one of its faces sees it.
struct BorderNode {
  Vector3d p_mm;
  int beside;        ///< as LeaningMesh has it
  double radius_mm;  ///< of the face's upright section; 0 where `beside` is 0
};
using Border = std::vector<BorderNode>;

/// The borders of curved faces, by edge; a seam has two of one face.
using Borders = std::map<int, std::vector<std::pair<int, Border>>>;

void add_borders(const TopoDS_Face& face, int number, const LeaningSurface& surface, const LeaningMesh& mesh,
                 const TopTools_IndexedMapOfShape& edges, Borders& borders) {
  TopLoc_Location location;
  const Handle(Poly_Triangulation) triangles = BRep_Tool::Triangulation(face, location);
  for (TopExp_Explorer it(face, TopAbs_EDGE); it.More(); it.Next()) {
    const TopoDS_Edge& edge = TopoDS::Edge(it.Current());
    if (BRep_Tool::Degenerated(edge)) continue;
    const auto polygon = BRep_Tool::PolygonOnTriangulation(edge, triangles, location);
    if (polygon.IsNull()) continue;
    Border border;
    for (Standard_Integer i = 1; i <= polygon->NbNodes(); ++i) {
      const auto node = static_cast<std::size_t>(polygon->Nodes().Value(i) - 1);
      const int beside = mesh.beside[node];
      border.push_back({surface.point_mm(mesh.nodes[node]), beside,
                        beside == 0 ? 0 : surface.upright_radius_mm(mesh.nodes[node])});
    }
    borders[edges.FindIndex(edge)].emplace_back(number, std::move(border));
  }
}

/// Stretches of edges, seams among them, along which the face on one side looks down and that on the other
/// up.
void add_edges_that_turn(const Borders& borders, std::vector<Silhouette>& lines) {
  for (const auto& [edge, uses] : borders) {
    if (uses.size() != 2 || uses[0].second.size() != uses[1].second.size()) continue;
    const auto& [face, one] = uses[0];
    const Border& other = uses[1].second;
    Silhouette line{.face = face, .points_mm = {}, .radius_mm = {}};
    const auto close = [&] {
      if (line.points_mm.size() > 1) lines.push_back(line);
      line.points_mm.clear();
      line.radius_mm.clear();
    };
    for (std::size_t i = 0; i < one.size(); ++i) {
      if (one[i].beside * other[i].beside < 0) {
        append(line, one[i].p_mm, std::max(one[i].radius_mm, other[i].radius_mm));
      } else {
        close();
      }
    }
    close();
  }
}

/// Joins lines of one face whose ends meet, as across a seam.
void join_ends(std::vector<Silhouette>& lines) {
  const auto reverse = [](Silhouette& line) {
    std::ranges::reverse(line.points_mm);
    std::ranges::reverse(line.radius_mm);
  };
  const auto meet = [](const Vector3d& a, const Vector3d& b) { return (a - b).norm() < kSamePointMm; };
  for (std::size_t i = 0; i < lines.size(); ++i) {
    for (std::size_t j = i + 1; j < lines.size();) {
      Silhouette& a = lines[i];
      Silhouette& b = lines[j];
      if (meet(a.points_mm.front(), a.points_mm.back()) || meet(b.points_mm.front(), b.points_mm.back())) {
        ++j;
        continue;
      }
      if (meet(a.points_mm.front(), b.points_mm.front()) || meet(a.points_mm.front(), b.points_mm.back()))
        reverse(a);
      if (meet(a.points_mm.back(), b.points_mm.back())) reverse(b);
      if (!meet(a.points_mm.back(), b.points_mm.front())) {
        ++j;
        continue;
      }
      for (std::size_t k = 0; k < b.points_mm.size(); ++k) append(a, b.points_mm[k], b.radius_mm[k]);
      lines.erase(lines.begin() + static_cast<std::ptrdiff_t>(j));
      j = i + 1;
    }
  }
}

std::vector<Silhouette> all_of(const TopoDS_Shape& shape, const Vector3d& up) {
  TopTools_IndexedMapOfShape faces;
  TopTools_IndexedMapOfShape edges;
  TopExp::MapShapes(shape, TopAbs_FACE, faces);
  TopExp::MapShapes(shape, TopAbs_EDGE, edges);
  std::vector<Silhouette> lines;
  Borders borders;
  for (Standard_Integer i = 1; i <= faces.Extent(); ++i) {
    const TopoDS_Face& face = TopoDS::Face(faces(i));
    TopLoc_Location location;
    const Handle(Poly_Triangulation) triangles = BRep_Tool::Triangulation(face, location);
    if (triangles.IsNull() || !triangles->HasUVNodes()) continue;
    if (BRepAdaptor_Surface(face).GetType() == GeomAbs_Plane) continue;
    const LeaningSurface surface(face, up);
    const LeaningMesh mesh = leaning_mesh(surface, *triangles);
    std::vector<Silhouette> inside = inside_of(surface, mesh, i);
    join_ends(inside);
    std::ranges::move(inside, std::back_inserter(lines));
    add_borders(face, i, surface, mesh, edges, borders);
  }
  add_edges_that_turn(borders, lines);
  return lines;
}

}  // namespace

base::Expected<std::vector<Silhouette>> silhouettes_of(const Shape& shape, const Vector3d& up) {
  try {
    return all_of(*shape, up);
  } catch (const Standard_Failure& reason) {
    return base::failure(std::string("its silhouettes cannot be found: ") + reason.GetMessageString());
  }
}

}  // namespace pinjaw::part
