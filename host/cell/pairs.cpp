#include "host/cell/pairs.hpp"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "host/planner/interference/interference.hpp"

namespace pinjaw::cell {
namespace {

using geometry::Interval;

constexpr double kSure = 1 - 1e-9;  // chosen: what is nearer clashes in the full check too, rounding or not

bool overlap(const Interval& a, const Interval& b) {
  return a.lo < b.hi && b.lo < a.hi;
}

double distance2_mm2(const Vector2d& p_mm, const planner::Finger& moving) {
  const Vector2d travel_mm = moving.open_mm - moving.closed_mm;
  const double travel2_mm2 = travel_mm.squaredNorm();
  const Vector2d from_mm = p_mm - moving.closed_mm;
  const double t = travel2_mm2 > 0 ? std::clamp(travel_mm.dot(from_mm) / travel2_mm2, 0.0, 1.0) : 0.0;
  return (from_mm - t * travel_mm).squaredNorm();
}

/// Whether pins of two designs clash in every stance of `other`, closed or when one opens: pins stand closed
/// in one place of the part and open along one line, in `other` as little as in any stance.
bool always_clash(const planner::FingerSet& one, const planner::FingerSet& other) {
  if (!overlap(one.pins_z_mm, other.pins_z_mm)) return false;
  const double apart_mm = one.radius_mm + other.radius_mm + std::max(one.clearance_mm, other.clearance_mm);
  const double apart2_mm2 = kSure * apart_mm * apart_mm;
  for (int i = 0; i < one.pin_count; ++i) {
    const planner::Finger& a = one.pins[static_cast<std::size_t>(i)];
    for (int k = 0; k < other.pin_count; ++k) {
      const planner::Finger& b = other.pins[static_cast<std::size_t>(k)];
      if (!overlap(a.z_mm, b.z_mm)) continue;
      if (distance2_mm2(a.closed_mm, b) < apart2_mm2 || distance2_mm2(b.closed_mm, a) < apart2_mm2)
        return true;
    }
  }
  return false;
}

/// Furthest that the two gripper origins may lie apart in any adjustment.
double farthest_mm(const PlanBounds& one, const PlanBounds& other) {
  const auto most = [](const Interval& a, const Interval& b) {
    return std::max(std::abs(a.hi - b.lo), std::abs(b.hi - a.lo));
  };
  constexpr double kRoom_mm = 1e-3;
  return std::hypot(most(one.adjust.x_mm, other.adjust.x_mm), most(one.adjust.y_mm, other.adjust.y_mm)) +
         kRoom_mm;
}

class PartnerSearch {
 public:
  PartnerSearch(const StationSetups& near, const StationSetups& far)
      : near_(near), far_(far), farthest_mm_(farthest_mm(near.bounds, far.bounds)) {}

  [[nodiscard]] std::vector<Partner> of(std::size_t index) const {
    const Setup& own = near_.setup(index, 0);
    std::vector<Partner> partners;
    std::vector<Stand> stands;
    for (std::size_t k = 0; k < far_.size(); ++k) {
      const planner::FingerSet& fingers = far_.setup(k, far_.opens_least[k]).fingers;
      if (planner::reaches_floor(own.fingers, fingers) || always_clash(own.fingers, fingers)) continue;
      list_stands(own, k, stands);
      for (const Stand& stand : stands) {
        if (!fits(own, far_.setup(k, stand.stance))) continue;
        partners.push_back({static_cast<std::uint32_t>(k), stand.stance});
        break;
      }
    }
    return partners;
  }

 private:
  /// A stance and how far the two grippers' origins then are apart.
  struct Stand {
    double apart2_mm2 = 0;
    std::uint32_t stance = 0;
    friend auto operator<=>(const Stand&, const Stand&) = default;
  };

  /// Stances of design `k` that are not too far off, nearest first.
  void list_stands(const Setup& own, std::size_t k, std::vector<Stand>& stands) const {
    stands.clear();
    for (std::uint32_t stance = 0; stance < far_.stances(k); ++stance) {
      const double apart2_mm2 = (own.hold.origin_P_mm - far_.setup(k, stance).hold.origin_P_mm).squaredNorm();
      if (apart2_mm2 <= farthest_mm_ * farthest_mm_) stands.push_back({apart2_mm2, stance});
    }
    std::ranges::sort(stands);
  }

  [[nodiscard]] bool fits(const Setup& own, const Setup& other) const {
    return adjustable(own.hold, near_.bounds, other.hold, far_.bounds) &&
           planner::compatible(own.fingers, other.fingers);
  }

  const StationSetups& near_;
  const StationSetups& far_;
  double farthest_mm_;
};

}  // namespace

Partners partners_of(const StationSetups& near, const StationSetups& far) {
  const PartnerSearch search(near, far);
  Partners partners(near.size());
  tbb::parallel_for(std::size_t{0}, near.size(), [&](std::size_t i) { partners[i] = search.of(i); });
  return partners;
}

std::int64_t count(const Partners& partners) {
  std::int64_t total = 0;
  for (const auto& of_one : partners) total += static_cast<std::int64_t>(of_one.size());
  return total;
}

}  // namespace pinjaw::cell
