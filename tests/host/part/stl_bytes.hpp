#pragma once

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <bit>
#include <cstdint>
#include <string>

#include "host/geometry/mesh.hpp"

/// STL files made in memory.
namespace pinjaw::part {

/// Four bytes, the least first.
inline std::string little_endian(std::uint32_t word) {
  std::string bytes;
  for (int i = 0; i < 4; ++i) bytes += static_cast<char>(word >> (8 * i));
  return bytes;
}

inline std::string little_endian(double value) {
  return little_endian(std::bit_cast<std::uint32_t>(static_cast<float>(value)));
}

inline std::string binary_stl(const geometry::TriangleMesh& mesh,
                              const std::string& header = "made for a test") {
  std::string bytes = header;
  bytes.resize(80, ' ');
  bytes += little_endian(static_cast<std::uint32_t>(mesh.triangles.size()));
  for (const auto& triangle : mesh.triangles) {
    bytes.append(12, '\0');  // normals are passed over
    for (const int corner : triangle) {
      for (int axis = 0; axis < 3; ++axis) {
        bytes += little_endian(mesh.vertices_mm[static_cast<std::size_t>(corner)][axis]);
      }
    }
    bytes.append(2, '\0');
  }
  return bytes;
}

inline std::string ascii_stl(const geometry::TriangleMesh& mesh, const std::string& name = "made") {
  std::string text = "solid " + name + "\n";
  for (const auto& triangle : mesh.triangles) {
    text += "  facet normal 0 0 0\n    outer loop\n";
    for (const int corner : triangle) {
      const auto p = mesh.vertices_mm[static_cast<std::size_t>(corner)];
      text += fmt::format("      vertex {:.9e} {:.9e} {:.9e}\n", p.x(), p.y(), p.z());
    }
    text += "    endloop\n  endfacet\n";
  }
  return text + "endsolid " + name + "\n";
}

}  // namespace pinjaw::part
