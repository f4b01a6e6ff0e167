#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakeWire.hxx>
#include <BRepCheck_Analyzer.hxx>
#include <BRepPrimAPI_MakePrism.hxx>
#include <BRep_Builder.hxx>
#include <Standard_Failure.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Compound.hxx>
#include <TopoDS_Vertex.hxx>
#include <TopoDS_Wire.hxx>
#include <gp_Circ.hxx>
#include <gp_Pln.hxx>

#include "host/part/brep.hpp"

namespace pinjaw::part {
namespace {

/// How far the ends of neighbouring edges of a loop may lie apart; files state six decimals or fewer.
constexpr double kJointMm = 1e-4;

Vector2d start_of(const model::ProfileEdge& edge) {
  return geometry::point_at(edge.curve, edge.reversed ? geometry::length_mm(edge.curve) : 0);
}

bool is_full_turn(const geometry::Curve& curve) {
  const auto* arc = std::get_if<geometry::Arc>(&curve);
  return arc != nullptr &&
         (geometry::point_at(curve, 0) - geometry::point_at(curve, geometry::length_mm(curve))).norm() <
             kJointMm;
}

TopoDS_Vertex vertex_at(const Vector2d& p_mm) {
  TopoDS_Vertex vertex;
  BRep_Builder().MakeVertex(vertex, gp_Pnt(p_mm.x(), p_mm.y(), 0), kJointMm);
  return vertex;
}

gp_Circ circle_of(const geometry::Arc& arc) {
  return {gp_Ax2(gp_Pnt(arc.center_mm.x(), arc.center_mm.y(), 0), gp::DZ(), gp::DX()), arc.radius_mm};
}

/// The edge from `from` to `to` along the loop.
TopoDS_Edge edge_of(const model::ProfileEdge& edge, const TopoDS_Vertex& from, const TopoDS_Vertex& to) {
  if (const auto* arc = std::get_if<geometry::Arc>(&edge.curve)) {
    TopoDS_Edge made;
    if (is_full_turn(edge.curve)) {
      made = BRepBuilderAPI_MakeEdge(circle_of(*arc)).Edge();
    } else {
      made = BRepBuilderAPI_MakeEdge(circle_of(*arc), edge.reversed ? to : from, edge.reversed ? from : to)
                 .Edge();
    }
    return edge.reversed ? TopoDS::Edge(made.Reversed()) : made;
  }
  return BRepBuilderAPI_MakeEdge(from, to).Edge();
}

TopoDS_Wire wire_of(const std::vector<model::ProfileEdge>& loop) {
  std::vector<TopoDS_Vertex> corners;
  corners.reserve(loop.size());
  for (const auto& edge : loop) corners.push_back(vertex_at(start_of(edge)));
  BRepBuilderAPI_MakeWire wire;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    wire.Add(edge_of(loop[i], corners[i], corners[(i + 1) % loop.size()]));
  }
  return wire.Wire();
}

}  // namespace

base::Expected<Shape> prism_of(const model::Profile& profile) {
  const std::string what = "profile " + profile.name + ": ";
  if (profile.loops.empty() || profile.loops.front().empty()) return base::failure(what + "no outer loop");
  try {
    BRepBuilderAPI_MakeFace face(gp_Pln(gp::Origin(), gp::DZ()), wire_of(profile.loops.front()), true);
    for (std::size_t i = 1; i < profile.loops.size(); ++i) face.Add(wire_of(profile.loops[i]));
    BRepPrimAPI_MakePrism prism(face.Face(), gp_Vec(0, 0, profile.thickness_mm));
    if (!BRepCheck_Analyzer(prism.Shape()).IsValid()) {
      return base::failure(what + "its loops cross, or a hole lies outside the outer loop");
    }
    return std::make_shared<const TopoDS_Shape>(prism.Shape());
  } catch (const Standard_Failure& reason) {
    return base::failure(what + "its loops bound no solid: " + reason.GetMessageString());
  }
}

Shape compound_of(const std::vector<NamedShape>& solids) {
  if (solids.size() == 1) return solids.front().shape;
  const BRep_Builder builder;
  TopoDS_Compound compound;
  builder.MakeCompound(compound);
  for (const auto& solid : solids) builder.Add(compound, *solid.shape);
  return std::make_shared<const TopoDS_Shape>(compound);
}

}  // namespace pinjaw::part
