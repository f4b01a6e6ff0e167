#pragma once

#include <Eigen/Geometry>
#include <map>
#include <stdexcept>
#include <string>

#include "host/part/part.hpp"
#include "tests/support/places.hpp"

namespace pinjaw::part {

inline std::filesystem::path shipped(const std::string& name) {
  return test::source_dir("configs/parts/" + name + ".step");
}

inline model::PartSource source_of(const std::filesystem::path& file) {
  model::PartSource source;
  source.file = file;
  source.density_g_cm3 = 2.81;
  return source;
}

/// A shipped part with the default source, read once in a test run.
inline const Part& shipped_part(const std::string& name) {
  static std::map<std::string, Part> parts;
  const auto found = parts.find(name);
  if (found != parts.end()) return found->second;
  auto part = read_part(source_of(shipped(name)));
  if (!part) throw std::runtime_error(part.error().message);
  return parts.emplace(name, std::move(*part)).first->second;
}

/// Volume enclosed by the surface's triangles.
inline double enclosed_mm3(const geometry::TriangleMesh& mesh) {
  double volume_mm3 = 0;
  for (const auto& [a, b, c] : mesh.triangles) {
    const Eigen::Vector3d& p = mesh.vertices_mm[static_cast<std::size_t>(a)];
    const Eigen::Vector3d& q = mesh.vertices_mm[static_cast<std::size_t>(b)];
    const Eigen::Vector3d& r = mesh.vertices_mm[static_cast<std::size_t>(c)];
    volume_mm3 += p.dot(q.cross(r)) / 6;
  }
  return volume_mm3;
}

}  // namespace pinjaw::part
