#include "tests/host/planner/features/brep_part.hpp"

#include <gtest/gtest.h>

#include <BRepAlgoAPI_Cut.hxx>
#include <BRepAlgoAPI_Fuse.hxx>
#include <BRepFilletAPI_MakeChamfer.hxx>
#include <BRepFilletAPI_MakeFillet.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRep_Tool.hxx>
#include <ShapeUpgrade_UnifySameDomain.hxx>
#include <TopExp.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS.hxx>
#include <cmath>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "host/part/placing.hpp"
#include "tests/host/planner/features/occt_values.hpp"
#include "tests/support/places.hpp"

namespace pinjaw::planner {
namespace {

TopoDS_Shape box_shape(const Box3& box) {
  return BRepPrimAPI_MakeBox(point(box.lo_mm), point(box.hi_mm)).Shape();
}

template <class Maker>
void add_bottom_edges(Maker& maker, const TopoDS_Shape& shape, double z_mm, double size_mm) {
  TopTools_IndexedMapOfShape edges;
  TopExp::MapShapes(shape, TopAbs_EDGE, edges);
  for (int i = 1; i <= edges.Extent(); ++i) {
    const TopoDS_Edge& edge = TopoDS::Edge(edges(i));
    const gp_Pnt a = BRep_Tool::Pnt(TopExp::FirstVertex(edge));
    const gp_Pnt b = BRep_Tool::Pnt(TopExp::LastVertex(edge));
    if (std::abs(a.Z() - z_mm) < 1e-9 && std::abs(b.Z() - z_mm) < 1e-9) maker.Add(size_mm, edge);
  }
}

template <class T>
T must(base::Expected<T> value) {
  if (!value) throw std::runtime_error(value.error().message);
  return std::move(*value);
}

}  // namespace

part::Part part_of(const part::Shape& shape, const Eigen::Matrix3d& rotation) {
  part::Part part = part::placed(
      must(part::values_of({{"made", shape}}, {{"made", shape}}, rotation.transpose() * Vector3d::UnitZ(),
                           [](std::string_view /*doing*/) {})),
      rotation);
  part.name = "made";
  return part;
}

part::Shape boxes(const std::vector<Box3>& parts) {
  TopoDS_Shape whole = box_shape(parts.front());
  for (std::size_t i = 1; i < parts.size(); ++i) whole = BRepAlgoAPI_Fuse(whole, box_shape(parts[i])).Shape();
  ShapeUpgrade_UnifySameDomain unify(whole);
  unify.Build();
  return held(unify.Shape());
}

part::Shape drilled(const part::Shape& shape, const Vector2d& center_mm, double radius_mm,
                    const geometry::Interval& z_mm) {
  const gp_Ax2 axis(gp_Pnt(center_mm.x(), center_mm.y(), z_mm.lo), gp::DZ());
  const TopoDS_Shape drill = BRepPrimAPI_MakeCylinder(axis, radius_mm, z_mm.length()).Shape();
  return held(BRepAlgoAPI_Cut(*shape, drill).Shape());
}

part::Shape chamfered_box(const Box3& box, double size_mm) {
  const TopoDS_Shape plain = box_shape(box);
  BRepFilletAPI_MakeChamfer maker(plain);
  add_bottom_edges(maker, plain, box.lo_mm.z(), size_mm);
  return held(maker.Shape());
}

part::Shape filleted_box(const Box3& box, double radius_mm) {
  const TopoDS_Shape plain = box_shape(box);
  BRepFilletAPI_MakeFillet maker(plain);
  add_bottom_edges(maker, plain, box.lo_mm.z(), radius_mm);
  return held(maker.Shape());
}

part::Shape shipped_shape(const std::string& name) {
  const std::string file = test::source_dir("configs/parts/" + name + ".step");
  std::ifstream in(file);
  std::stringstream text;
  text << in.rdbuf();
  return must(part::read_step(text.str(), file)).front().shape;
}

}  // namespace pinjaw::planner
