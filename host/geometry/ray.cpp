#include "host/geometry/ray.hpp"

#include <algorithm>
#include <utility>

namespace pinjaw::geometry {
namespace {

constexpr double kMissed_mm = std::numeric_limits<double>::infinity();

}  // namespace

RayTest::RayTest(const Ray& ray) : origin_mm_(ray.origin_mm), direction_(ray.direction) {
  int z = 0;
  direction_.cwiseAbs().maxCoeff(&z);
  int x = (z + 1) % 3;
  int y = (x + 1) % 3;
  if (direction_[z] < 0) std::swap(x, y);
  axes_ = {x, y, z};
  shear_ = {direction_[x] / direction_[z], direction_[y] / direction_[z], 1 / direction_[z]};
}

double RayTest::entry_mm(const Box& box) const {
  double near_mm = 0;
  double far_mm = kMissed_mm;
  for (int axis = 0; axis < 3; ++axis) {
    const double lo_mm = box.lo[axis] - kTouch_mm - origin_mm_[axis];
    const double hi_mm = box.hi[axis] + kTouch_mm - origin_mm_[axis];
    if (direction_[axis] == 0) {
      if (lo_mm > 0 || hi_mm < 0) return kMissed_mm;
      continue;
    }
    const double at_lo_mm = lo_mm / direction_[axis];
    const double at_hi_mm = hi_mm / direction_[axis];
    near_mm = std::max(near_mm, std::min(at_lo_mm, at_hi_mm));
    far_mm = std::min(far_mm, std::max(at_lo_mm, at_hi_mm));
  }
  if (near_mm > far_mm) return kMissed_mm;
  return near_mm;
}

std::optional<double> RayTest::distance_mm(const Facet& facet) const {
  const auto [x, y, z] = axes_;
  std::array<Vector3d, 3> sheared;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vector3d p = facet.p_mm[i] - origin_mm_;
    sheared[i] = {p[x] - shear_[0] * p[z], p[y] - shear_[1] * p[z], shear_[2] * p[z]};
  }
  const auto& [a, b, c] = sheared;
  const double u = c.x() * b.y() - c.y() * b.x();
  const double v = a.x() * c.y() - a.y() * c.x();
  const double w = b.x() * a.y() - b.y() * a.x();
  if ((u < 0 || v < 0 || w < 0) && (u > 0 || v > 0 || w > 0)) return std::nullopt;
  const double sum = u + v + w;
  if (sum == 0) return std::nullopt;
  const double distance_mm = (u * a.z() + v * b.z() + w * c.z()) / sum;
  if (!(distance_mm > 0)) return std::nullopt;
  return distance_mm;
}

}  // namespace pinjaw::geometry
