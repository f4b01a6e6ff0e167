#include "host/part/mesh_weld.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <unordered_map>

namespace pinjaw::part {
namespace {

using Cell = std::array<std::int64_t, 3>;

struct CellHash {
  std::size_t operator()(const Cell& cell) const {
    std::uint64_t h = 0;
    for (const std::int64_t part : cell) {
      h = (h ^ static_cast<std::uint64_t>(part)) * 0x9e3779b97f4a7c15U;
      h ^= h >> 32U;
    }
    return static_cast<std::size_t>(h);
  }
};

/// Vertices by the cell they lie in. Cells are twice as wide as the tolerance, so a cell holds eight vertices
/// at most and a point has its neighbours in the eight cells of its box's corners.
class Vertices {
 public:
  explicit Vertices(double tolerance_mm) : tolerance_mm_(tolerance_mm) {}

  int at(const Vector3d& p_mm) {
    for (const Cell& cell : cells_about(p_mm)) {
      const auto found = in_cell_.find(cell);
      if (found == in_cell_.end()) continue;
      for (const int vertex : found->second) {
        const Vector3d apart = (vertices_mm_[static_cast<std::size_t>(vertex)] - p_mm).cwiseAbs();
        if (apart.maxCoeff() <= tolerance_mm_) return vertex;
      }
    }
    const int vertex = static_cast<int>(vertices_mm_.size());
    vertices_mm_.push_back(p_mm);
    in_cell_[cell_of(p_mm)].push_back(vertex);
    return vertex;
  }

  [[nodiscard]] std::vector<Vector3d> take() { return std::move(vertices_mm_); }

 private:
  [[nodiscard]] Cell cell_of(const Vector3d& p_mm) const {
    Cell cell{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      cell[axis] = static_cast<std::int64_t>(std::floor(p_mm[static_cast<int>(axis)] / (2 * tolerance_mm_)));
    }
    return cell;
  }

  [[nodiscard]] std::vector<Cell> cells_about(const Vector3d& p_mm) const {
    const Cell lo = cell_of(p_mm - Vector3d::Constant(tolerance_mm_));
    const Cell hi = cell_of(p_mm + Vector3d::Constant(tolerance_mm_));
    std::vector<Cell> cells;
    for (std::int64_t x = lo[0]; x <= hi[0]; ++x) {
      for (std::int64_t y = lo[1]; y <= hi[1]; ++y) {
        for (std::int64_t z = lo[2]; z <= hi[2]; ++z) cells.push_back({x, y, z});
      }
    }
    return cells;
  }

  double tolerance_mm_;
  std::vector<Vector3d> vertices_mm_;
  std::unordered_map<Cell, std::vector<int>, CellHash> in_cell_;
};

}  // namespace

Welded weld(std::span<const Vector3d> points_mm) {
  double farthest_mm = 0;
  for (const Vector3d& p : points_mm) farthest_mm = std::max(farthest_mm, p.cwiseAbs().maxCoeff());
  constexpr double kStep = std::numeric_limits<float>::epsilon();
  constexpr double kLeastMm = 1e-9;
  Vertices vertices(std::max(kLeastMm, kWeldSteps * kStep * farthest_mm));
  Welded welded;
  welded.vertex_of.reserve(points_mm.size());
  for (const Vector3d& p : points_mm) welded.vertex_of.push_back(vertices.at(p));
  welded.vertices_mm = vertices.take();
  return welded;
}

}  // namespace pinjaw::part
