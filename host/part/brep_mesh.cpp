#include <BRepAdaptor_Surface.hxx>
#include <BRepGProp.hxx>
#include <BRepMesh_IncrementalMesh.hxx>
#include <BRepTools.hxx>
#include <BRep_Tool.hxx>
#include <GProp_GProps.hxx>
#include <Poly_Triangulation.hxx>
#include <Standard_Failure.hxx>
#include <TopExp.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Face.hxx>
#include <cmath>

#include "host/part/brep.hpp"

namespace pinjaw::part {
namespace {

constexpr double kAngularRad = 0.25;   // measured: between 0.2 and 0.3 rules the count on small parts
constexpr double kCoarsestMm = 0.016;  // below eps = 0.02, so that a chord never hides an edge
constexpr double kLeastVolumeMm3 = 1e-6;

/// The face's outward normal at a point of its parameters; zero where the surface has none.
Vector3d normal_at(const BRepAdaptor_Surface& surface, const gp_Pnt2d& uv, bool reversed) {
  gp_Pnt p;
  gp_Vec along_u;
  gp_Vec along_v;
  surface.D1(uv.X(), uv.Y(), p, along_u, along_v);
  const gp_Vec normal = along_u.Crossed(along_v);
  constexpr double kNoDirection = 1e-12;  // relative: at poles and tips one of the two vanishes
  const double length = normal.Magnitude();
  if (!(length > kNoDirection * (along_u.SquareMagnitude() + along_v.SquareMagnitude()))) {
    return Vector3d::Zero();
  }
  return (reversed ? -1 : 1) / length * Vector3d(normal.X(), normal.Y(), normal.Z());
}

void add_face(geometry::TriangleMesh& mesh, const TopoDS_Face& face, int number) {
  TopLoc_Location location;
  const Handle(Poly_Triangulation) triangles = BRep_Tool::Triangulation(face, location);
  if (triangles.IsNull()) return;
  const BRepAdaptor_Surface surface(face, false);
  const bool reversed = face.Orientation() == TopAbs_REVERSED;
  const int first = static_cast<int>(mesh.vertices_mm.size()) - 1;
  for (Standard_Integer i = 1; i <= triangles->NbNodes(); ++i) {
    const gp_Pnt p = triangles->Node(i).Transformed(location.Transformation());
    mesh.vertices_mm.emplace_back(p.X(), p.Y(), p.Z());
    const bool known = triangles->HasUVNodes();
    mesh.normals.push_back(known ? normal_at(surface, triangles->UVNode(i), reversed)
                                 : Vector3d(Vector3d::Zero()));
  }
  for (Standard_Integer i = 1; i <= triangles->NbTriangles(); ++i) {
    Standard_Integer a = 0;
    Standard_Integer b = 0;
    Standard_Integer c = 0;
    triangles->Triangle(i).Get(a, b, c);
    if (reversed) std::swap(b, c);
    mesh.triangles.push_back({first + a, first + b, first + c});
    mesh.face_of.push_back(number);
  }
}

geometry::TriangleMesh triangles_of(const TopoDS_Shape& shape, double deflection_mm) {
  BRepTools::Clean(shape);  // else a mesh that came with the shape would be kept
  const BRepMesh_IncrementalMesh mesher(shape, deflection_mm, false, kAngularRad, false);
  TopTools_IndexedMapOfShape faces;
  TopExp::MapShapes(shape, TopAbs_FACE, faces);
  geometry::TriangleMesh mesh;
  for (Standard_Integer i = 1; i <= faces.Extent(); ++i) add_face(mesh, TopoDS::Face(faces(i)), i);
  return mesh;
}

}  // namespace

base::Expected<BrepMesh> mesh_of(const Shape& shape, int most_triangles) {
  try {
    for (double deflection_mm = kMeshDeflectionMm; deflection_mm <= kCoarsestMm; deflection_mm *= 2) {
      BrepMesh made{triangles_of(*shape, deflection_mm), deflection_mm};
      if (made.mesh.triangles.empty()) return base::failure("none of its faces can be meshed");
      if (static_cast<int>(made.mesh.triangles.size()) <= most_triangles) return made;
    }
    return base::failure("its surface needs more than " + std::to_string(most_triangles) + " triangles");
  } catch (const Standard_Failure& reason) {
    return base::failure(std::string("its faces cannot be meshed: ") + reason.GetMessageString());
  }
}

base::Expected<BrepMass> mass_of(const Shape& shape) {
  try {
    GProp_GProps properties;
    BRepGProp::VolumeProperties(*shape, properties);
    const double volume_mm3 = properties.Mass();
    if (!std::isfinite(volume_mm3) || volume_mm3 < kLeastVolumeMm3) {
      return base::failure("its solids enclose no volume");
    }
    const gp_Pnt centroid = properties.CentreOfMass();
    return BrepMass{volume_mm3, {centroid.X(), centroid.Y(), centroid.Z()}};
  } catch (const Standard_Failure& reason) {
    return base::failure(std::string("its volume cannot be computed: ") + reason.GetMessageString());
  }
}

}  // namespace pinjaw::part
