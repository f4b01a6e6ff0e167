#include <BRepAdaptor_Curve.hxx>
#include <BRepAdaptor_Surface.hxx>
#include <BRep_Tool.hxx>
#include <GCPnts_TangentialDeflection.hxx>
#include <Precision.hxx>
#include <Standard_Failure.hxx>
#include <TopExp.hxx>
#include <TopTools_IndexedDataMapOfShapeListOfShape.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS.hxx>
#include <algorithm>
#include <array>
#include <gp_Cylinder.hxx>
#include <gp_Elips.hxx>
#include <gp_Pln.hxx>

#include "host/part/brep.hpp"
#include "host/part/curve_fit.hpp"
#include "host/part/occt_values.hpp"

namespace pinjaw::part {
namespace {

constexpr double kFitMm = 1e-3;  // a B-spline this near a line or circle is one
constexpr int kFitSamples = 17;
constexpr double kChordAngleRad = 0.1;

Ellipse3 ellipse_of(const gp_Ax2& axes, double major_mm, double minor_mm, const BRepAdaptor_Curve& curve) {
  return {.center_mm = vector_of(axes.Location().XYZ()),
          .u_mm = major_mm * vector_of(axes.XDirection().XYZ()),
          .v_mm = minor_mm * vector_of(axes.YDirection().XYZ()),
          .from_rad = curve.FirstParameter(),
          .sweep_rad = curve.LastParameter() - curve.FirstParameter()};
}

Polyline3 chorded(const BRepAdaptor_Curve& curve) {
  const GCPnts_TangentialDeflection points(curve, kChordAngleRad, kMeshDeflectionMm);
  Polyline3 line;
  for (Standard_Integer i = 1; i <= points.NbPoints(); ++i) {
    line.points_mm.push_back(vector_of(points.Value(i).XYZ()));
  }
  return line;
}

std::array<Vector3d, kFitSamples> sampled(const BRepAdaptor_Curve& curve) {
  std::array<Vector3d, kFitSamples> samples;
  const double first = curve.FirstParameter();
  const double step = (curve.LastParameter() - first) / (kFitSamples - 1);
  for (int i = 0; i < kFitSamples; ++i) {
    samples[static_cast<std::size_t>(i)] = vector_of(curve.Value(first + i * step).XYZ());
  }
  return samples;
}

/// The edge's curve in space; EdgeCurve::edge and faces are left to the caller.
EdgeCurve curve_of(const TopoDS_Edge& edge) {
  const BRepAdaptor_Curve curve(edge);
  const double first = curve.FirstParameter();
  const double last = curve.LastParameter();
  if (Precision::IsInfinite(first) || Precision::IsInfinite(last))
    throw Standard_Failure("an edge has no end");
  switch (curve.GetType()) {
    case GeomAbs_Line:
      return {.curve = Line3{vector_of(curve.Value(first).XYZ()), vector_of(curve.Value(last).XYZ())}};
    case GeomAbs_Circle: {
      const gp_Circ circle = curve.Circle();
      return {.curve = ellipse_of(circle.Position(), circle.Radius(), circle.Radius(), curve)};
    }
    case GeomAbs_Ellipse: {
      const gp_Elips ellipse = curve.Ellipse();
      return {.curve = ellipse_of(ellipse.Position(), ellipse.MajorRadius(), ellipse.MinorRadius(), curve)};
    }
    default:
      break;
  }
  if (auto found = recognised(sampled(curve), kFitMm))
    return {.curve = std::move(found->curve), .error_mm = found->error_mm};
  return {.curve = chorded(curve)};
}

/// True where one of the edge's faces has it on both sides.
bool is_seam(const TopoDS_Edge& edge, const TopTools_ListOfShape& faces) {
  return std::any_of(faces.begin(), faces.end(),
                     [&](const TopoDS_Shape& face) { return BRep_Tool::IsClosed(edge, TopoDS::Face(face)); });
}

}  // namespace

base::Expected<BrepEdges> edges_of(const Shape& shape) {
  try {
    TopTools_IndexedDataMapOfShapeListOfShape edges;
    TopTools_IndexedMapOfShape faces;
    TopExp::MapShapesAndUniqueAncestors(*shape, TopAbs_EDGE, TopAbs_FACE, edges);
    TopExp::MapShapes(*shape, TopAbs_FACE, faces);
    BrepEdges result;
    result.counts.total = edges.Extent();
    for (Standard_Integer i = 1; i <= edges.Extent(); ++i) {
      const TopoDS_Edge& edge = TopoDS::Edge(edges.FindKey(i));
      if (BRep_Tool::Degenerated(edge)) {
        ++result.counts.degenerate;
        continue;
      }
      if (is_seam(edge, edges(i))) {
        ++result.counts.seams;
        continue;
      }
      EdgeCurve kept = curve_of(edge);
      kept.edge = i;
      for (const TopoDS_Shape& face : edges(i)) kept.faces.push_back(faces.FindIndex(face));
      if (std::holds_alternative<Polyline3>(kept.curve)) ++result.counts.freeform;
      ++result.counts.kept;
      result.edges.push_back(std::move(kept));
    }
    return result;
  } catch (const Standard_Failure& reason) {
    return base::failure(std::string("its edges cannot be read: ") + reason.GetMessageString());
  }
}

base::Expected<std::vector<WallFace>> wall_faces_of(const Shape& shape) {
  try {
    TopTools_IndexedMapOfShape faces;
    TopExp::MapShapes(*shape, TopAbs_FACE, faces);
    std::vector<WallFace> walls;
    for (Standard_Integer i = 1; i <= faces.Extent(); ++i) {
      const BRepAdaptor_Surface surface(TopoDS::Face(faces(i)));
      if (surface.GetType() == GeomAbs_Plane) {
        walls.push_back({i, PlaneFace{vector_of(surface.Plane().Axis().Direction().XYZ())}});
      } else if (surface.GetType() == GeomAbs_Cylinder) {
        const gp_Cylinder cylinder = surface.Cylinder();
        walls.push_back({i, CylinderFace{vector_of(cylinder.Location().XYZ()),
                                         vector_of(cylinder.Axis().Direction().XYZ()), cylinder.Radius()}});
      }
    }
    return walls;
  } catch (const Standard_Failure& reason) {
    return base::failure(std::string("its faces cannot be read: ") + reason.GetMessageString());
  }
}

}  // namespace pinjaw::part
