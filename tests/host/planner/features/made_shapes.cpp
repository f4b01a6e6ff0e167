#include "tests/host/planner/features/made_shapes.hpp"

#include <BRepAlgoAPI_Cut.hxx>
#include <BRepAlgoAPI_Fuse.hxx>
#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakeWire.hxx>
#include <BRepBuilderAPI_Transform.hxx>
#include <BRepFilletAPI_MakeFillet.hxx>
#include <BRepLib.hxx>
#include <BRepOffsetAPI_MakePipe.hxx>
#include <BRepOffsetAPI_ThruSections.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCone.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakePrism.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>
#include <BRepPrimAPI_MakeTorus.hxx>
#include <GC_MakeArcOfCircle.hxx>
#include <Geom2d_Line.hxx>
#include <GeomAPI_Interpolate.hxx>
#include <Geom_CylindricalSurface.hxx>
#include <ShapeUpgrade_UnifySameDomain.hxx>
#include <TColgp_HArray1OfPnt.hxx>
#include <TopExp.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS.hxx>
#include <cmath>
#include <gp_Circ.hxx>
#include <gp_Elips.hxx>
#include <gp_Lin2d.hxx>
#include <numbers>

#include "tests/host/planner/features/occt_values.hpp"

namespace pinjaw::planner {
namespace {

gp_Dir direction(const Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}

}  // namespace

part::Shape ball(const Vector3d& center_mm, double radius_mm) {
  return held(BRepPrimAPI_MakeSphere(point(center_mm), radius_mm).Shape());
}

part::Shape rod(const Vector3d& from_mm, const Vector3d& axis, double radius_mm, double length_mm,
                double seam_rad) {
  gp_Ax2 axes(point(from_mm), direction(axis));
  axes.Rotate(axes.Axis(), seam_rad);
  return held(BRepPrimAPI_MakeCylinder(axes, radius_mm, length_mm).Shape());
}

part::Shape cone(const Vector3d& from_mm, const Vector3d& axis, double radius_mm, double top_radius_mm,
                 double length_mm) {
  return held(
      BRepPrimAPI_MakeCone(gp_Ax2(point(from_mm), direction(axis)), radius_mm, top_radius_mm, length_mm)
          .Shape());
}

part::Shape ring(const Vector3d& center_mm, const Vector3d& axis, double radius_mm, double tube_mm) {
  return held(BRepPrimAPI_MakeTorus(gp_Ax2(point(center_mm), direction(axis)), radius_mm, tube_mm).Shape());
}

part::Shape lofted() {
  BRepOffsetAPI_ThruSections maker(true, false);
  const double sizes[][3] = {{0, 8, 6}, {15, 12, 7}, {30, 9, 9}, {45, 14, 6}, {60, 7, 7}};
  for (const auto& [x_mm, wide_mm, high_mm] : sizes) {
    const bool wide = wide_mm >= high_mm;
    const gp_Ax2 axes(gp_Pnt(x_mm, 0, 0), gp::DX(), wide ? gp::DY() : gp::DZ());
    const gp_Elips ellipse(axes, std::max(wide_mm, high_mm), std::min(wide_mm, high_mm));
    maker.AddWire(BRepBuilderAPI_MakeWire(BRepBuilderAPI_MakeEdge(ellipse).Edge()).Wire());
  }
  maker.Build();
  return held(maker.Shape());
}

part::Shape spline_prism(const std::vector<Vector2d>& through_mm, double height_mm) {
  const Handle(TColgp_HArray1OfPnt) points = new TColgp_HArray1OfPnt(1, static_cast<int>(through_mm.size()));
  for (std::size_t i = 0; i < through_mm.size(); ++i)
    points->SetValue(static_cast<int>(i) + 1, gp_Pnt(through_mm[i].x(), through_mm[i].y(), 0));
  GeomAPI_Interpolate curve(points, true, 1e-6);
  curve.Perform();
  const TopoDS_Wire wire = BRepBuilderAPI_MakeWire(BRepBuilderAPI_MakeEdge(curve.Curve()).Edge()).Wire();
  return held(BRepPrimAPI_MakePrism(BRepBuilderAPI_MakeFace(wire).Face(), gp_Vec(0, 0, height_mm)).Shape());
}

part::Shape bent_sheet(double width_mm, double height_mm, double length_mm, double sheet_mm,
                       double radius_mm) {
  const auto rounded_box = [&](double inset_mm, double round_mm) {
    const double half_mm = width_mm / 2 - inset_mm;
    const TopoDS_Shape box = BRepPrimAPI_MakeBox(gp_Pnt(-half_mm, 0, inset_mm > 0 ? -1 : 0),
                                                 gp_Pnt(half_mm, length_mm, height_mm - inset_mm))
                                 .Shape();
    BRepFilletAPI_MakeFillet maker(box);
    TopTools_IndexedMapOfShape edges;
    TopExp::MapShapes(box, TopAbs_EDGE, edges);
    for (int i = 1; i <= edges.Extent(); ++i) {
      const TopoDS_Edge& edge = TopoDS::Edge(edges(i));
      const gp_Pnt a = BRep_Tool::Pnt(TopExp::FirstVertex(edge));
      const gp_Pnt b = BRep_Tool::Pnt(TopExp::LastVertex(edge));
      const bool on_top = std::abs(a.Z() - height_mm + inset_mm) < 1e-9 && std::abs(b.Z() - a.Z()) < 1e-9;
      if (on_top && std::abs(a.X() - b.X()) < 1e-9) maker.Add(round_mm, edge);
    }
    return TopoDS_Shape(maker.Shape());
  };
  return held(
      BRepAlgoAPI_Cut(rounded_box(0, radius_mm + sheet_mm), rounded_box(sheet_mm, radius_mm)).Shape());
}

part::Shape drafted_box(const Vector3d& size_mm, double draft_rad, double radius_mm) {
  BRepOffsetAPI_ThruSections maker(true, true);
  for (const double z_mm : {0.0, size_mm.z()}) {
    const double grown_mm = z_mm * std::tan(draft_rad);
    const double x_mm = size_mm.x() / 2 + grown_mm;
    const double y_mm = size_mm.y() / 2 + grown_mm;
    const double r_mm = radius_mm + grown_mm;
    BRepBuilderAPI_MakeWire wire;
    const double c_mm = r_mm * (1 - std::numbers::sqrt2 / 2);
    const auto line = [&](double x1, double y1, double x2, double y2) {
      wire.Add(BRepBuilderAPI_MakeEdge(gp_Pnt(x1, y1, z_mm), gp_Pnt(x2, y2, z_mm)).Edge());
    };
    const auto arc = [&](double x1, double y1, double xm, double ym, double x2, double y2) {
      wire.Add(
          BRepBuilderAPI_MakeEdge(
              GC_MakeArcOfCircle(gp_Pnt(x1, y1, z_mm), gp_Pnt(xm, ym, z_mm), gp_Pnt(x2, y2, z_mm)).Value())
              .Edge());
    };
    line(-x_mm + r_mm, -y_mm, x_mm - r_mm, -y_mm);
    arc(x_mm - r_mm, -y_mm, x_mm - c_mm, -y_mm + c_mm, x_mm, -y_mm + r_mm);
    line(x_mm, -y_mm + r_mm, x_mm, y_mm - r_mm);
    arc(x_mm, y_mm - r_mm, x_mm - c_mm, y_mm - c_mm, x_mm - r_mm, y_mm);
    line(x_mm - r_mm, y_mm, -x_mm + r_mm, y_mm);
    arc(-x_mm + r_mm, y_mm, -x_mm + c_mm, y_mm - c_mm, -x_mm, y_mm - r_mm);
    line(-x_mm, y_mm - r_mm, -x_mm, -y_mm + r_mm);
    arc(-x_mm, -y_mm + r_mm, -x_mm + c_mm, -y_mm + c_mm, -x_mm + r_mm, -y_mm);
    maker.AddWire(wire.Wire());
  }
  maker.Build();
  return held(maker.Shape());
}

part::Shape coil(double radius_mm, double pitch_mm, double turns, double wire_mm) {
  const Handle(Geom_CylindricalSurface) drum = new Geom_CylindricalSurface(gp_Ax3(), radius_mm);
  const double turn_rad = 2 * std::numbers::pi;
  const Handle(Geom2d_Line) line = new Geom2d_Line(gp_Pnt2d(0, 0), gp_Dir2d(turn_rad, pitch_mm));
  const double length = turns * std::hypot(turn_rad, pitch_mm);
  TopoDS_Edge helix = BRepBuilderAPI_MakeEdge(line, drum, 0, length).Edge();
  BRepLib::BuildCurve3d(helix);
  const gp_Ax2 start(gp_Pnt(radius_mm, 0, 0), gp_Dir(0, turn_rad * radius_mm, pitch_mm));
  const TopoDS_Wire section =
      BRepBuilderAPI_MakeWire(BRepBuilderAPI_MakeEdge(gp_Circ(start, wire_mm)).Edge()).Wire();
  return held(
      BRepOffsetAPI_MakePipe(BRepBuilderAPI_MakeWire(helix).Wire(), BRepBuilderAPI_MakeFace(section).Face())
          .Shape());
}

part::Shape fused(const part::Shape& a, const part::Shape& b) {
  ShapeUpgrade_UnifySameDomain unify(BRepAlgoAPI_Fuse(*a, *b).Shape());
  unify.Build();
  return held(unify.Shape());
}

part::Shape cut(const part::Shape& a, const part::Shape& b) {
  return held(BRepAlgoAPI_Cut(*a, *b).Shape());
}

}  // namespace pinjaw::planner
