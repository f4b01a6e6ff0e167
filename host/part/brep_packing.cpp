#include "host/part/brep_packing.hpp"

#include <algorithm>
#include <cereal/archives/binary.hpp>
#include <cereal/types/array.hpp>
#include <cereal/types/string.hpp>
#include <cereal/types/variant.hpp>
#include <cereal/types/vector.hpp>
#include <cmath>
#include <cstring>
#include <exception>
#include <memory>
#include <sstream>
#include <type_traits>

namespace pinjaw::part {
namespace {

/// Cereal's binary form, read from memory; a list longer than the bytes that are left is refused before
/// anything is made for it.
class Input : public cereal::InputArchive<Input, cereal::AllowEmptyClassElision> {
 public:
  explicit Input(std::string_view bytes) : InputArchive(this), left_(bytes) {}

  void take(void* into, std::size_t count) {
    if (count > left_.size()) throw cereal::Exception("the bytes end too early");
    std::memcpy(into, left_.data(), count);
    left_.remove_prefix(count);
  }
  [[nodiscard]] std::size_t left() const { return left_.size(); }

 private:
  std::string_view left_;
};

template <class T>
std::enable_if_t<std::is_arithmetic_v<T>> load(Input& archive, T& number) {
  archive.take(std::addressof(number), sizeof number);
}

template <class T>
void load(Input& archive, cereal::SizeTag<T>& tag) {
  archive(tag.size);
  if (tag.size > archive.left()) throw cereal::Exception("a list of more values than there are bytes");
}

template <class T>
void load(Input& archive, cereal::NameValuePair<T>& pair) {  // binary archives keep no names
  archive(pair.value);
}

template <class T>
void load(Input& archive, cereal::BinaryData<T>& data) {
  archive.take(data.data, static_cast<std::size_t>(data.size));
}

}  // namespace
}  // namespace pinjaw::part

// Each takes its value apart by a structured binding, so that a member that is added does not compile until
// it is packed, too.

namespace cereal {

template <class Archive>
void serialize(Archive& archive, Eigen::Vector3d& v) {
  archive(v.x(), v.y(), v.z());
}

}  // namespace cereal

namespace pinjaw::geometry {

template <class Archive>
void serialize(Archive& archive, Silhouette& silhouette) {
  auto& [face, points_mm, radius_mm] = silhouette;
  archive(face, points_mm, radius_mm);
}

template <class Archive>
void serialize(Archive& archive, TriangleMesh& mesh) {
  auto& [vertices_mm, triangles, face_of, silhouettes, normals] = mesh;
  archive(vertices_mm, triangles, face_of, silhouettes, normals);
}

}  // namespace pinjaw::geometry

namespace pinjaw::part {

template <class Archive>
void serialize(Archive& archive, Line3& line) {
  auto& [a_mm, b_mm] = line;
  archive(a_mm, b_mm);
}

template <class Archive>
void serialize(Archive& archive, Ellipse3& ellipse) {
  auto& [center_mm, u_mm, v_mm, from_rad, sweep_rad] = ellipse;
  archive(center_mm, u_mm, v_mm, from_rad, sweep_rad);
}

template <class Archive>
void serialize(Archive& archive, Polyline3& line) {
  auto& [points_mm] = line;
  archive(points_mm);
}

template <class Archive>
void serialize(Archive& archive, EdgeCurve& edge) {
  auto& [number, curve, error_mm, faces] = edge;
  archive(number, curve, error_mm, faces);
}

template <class Archive>
void serialize(Archive& archive, EdgeCounts& counts) {
  auto& [total, kept, seams, degenerate, freeform] = counts;
  archive(total, kept, seams, degenerate, freeform);
}

template <class Archive>
void serialize(Archive& archive, Solid& solid) {
  auto& [name, volume_mm3] = solid;
  archive(name, volume_mm3);
}

template <class Archive>
void serialize(Archive& archive, BrepMesh& mesh) {
  auto& [triangles, deflection_mm] = mesh;
  archive(triangles, deflection_mm);
}

template <class Archive>
void serialize(Archive& archive, BrepMass& mass) {
  auto& [volume_mm3, centroid_mm] = mass;
  archive(volume_mm3, centroid_mm);
}

template <class Archive>
void serialize(Archive& archive, BrepEdges& edges) {
  auto& [list, counts] = edges;
  archive(list, counts);
}

template <class Archive>
void serialize(Archive& archive, PlaneFace& plane) {
  auto& [normal] = plane;
  archive(normal);
}

template <class Archive>
void serialize(Archive& archive, CylinderFace& cylinder) {
  auto& [point_mm, axis, radius_mm] = cylinder;
  archive(point_mm, axis, radius_mm);
}

template <class Archive>
void serialize(Archive& archive, WallFace& wall) {
  auto& [face, surface] = wall;
  archive(face, surface);
}

template <class Archive>
void serialize(Archive& archive, BrepValues& values) {
  auto& [solids, mass, edges, wall_faces, mesh] = values;
  archive(solids, mass, edges, wall_faces, mesh);
}

namespace {

bool is_whole(const geometry::TriangleMesh& mesh) {
  const auto vertices = static_cast<int>(mesh.vertices_mm.size());
  const auto is_vertex = [&](int index) { return index >= 0 && index < vertices; };
  return mesh.face_of.size() == mesh.triangles.size() &&
         (mesh.normals.empty() || mesh.normals.size() == mesh.vertices_mm.size()) &&
         std::ranges::all_of(mesh.vertices_mm, [](const Vector3d& p) { return p.allFinite(); }) &&
         std::ranges::all_of(mesh.triangles,
                             [&](const auto& t) { return std::ranges::all_of(t, is_vertex); }) &&
         std::ranges::all_of(mesh.silhouettes, [](const geometry::Silhouette& line) {
           return line.points_mm.size() == line.radius_mm.size();
         });
}

/// No number that is none, and no index without its value.
bool is_whole(const BrepValues& values) {
  return is_whole(values.mesh.mesh) && std::isfinite(values.mass.volume_mm3) &&
         values.mass.centroid_mm.allFinite();
}

}  // namespace

std::string packed(const BrepValues& values) {
  std::ostringstream stream;
  cereal::BinaryOutputArchive output(stream);
  output(values);
  return std::move(stream).str();
}

base::Expected<BrepValues> unpacked(std::string_view bytes) {
  try {
    BrepValues values;
    Input input(bytes);
    input(values);
    if (input.left() == 0 && is_whole(values)) return values;
  } catch (const std::exception&) {  // of cereal, or of a container that would have to be endless
  }
  return base::failure("OpenCASCADE gave a garbled answer; the file may be damaged");
}

}  // namespace pinjaw::part
