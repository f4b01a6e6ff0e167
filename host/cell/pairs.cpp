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

/// Whether two closed pins clash: the part of the handoff's checks that no stance changes.
bool closed_pins_clash(const planner::FingerSet& one, const planner::FingerSet& other) {
  if (!overlap(one.pins_z_mm, other.pins_z_mm)) return false;
  const double apart_mm = one.radius_mm + other.radius_mm + std::max(one.clearance_mm, other.clearance_mm);
  for (int i = 0; i < one.pin_count; ++i) {
    const planner::Finger& a = one.pins[static_cast<std::size_t>(i)];
    for (int k = 0; k < other.pin_count; ++k) {
      const planner::Finger& b = other.pins[static_cast<std::size_t>(k)];
      if ((a.closed_mm - b.closed_mm).squaredNorm() < kSure * apart_mm * apart_mm &&
          overlap(a.z_mm, b.z_mm)) {
        return true;
      }
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
    for (std::size_t k = 0; k < far_.size(); ++k) {
      if (closed_pins_clash(own.fingers, far_.setup(k, 0).fingers)) continue;
      const std::size_t stances = far_.first[k + 1] - far_.first[k];
      for (std::size_t stance = 0; stance < stances; ++stance) {
        if (!fits(own, far_.setup(k, stance))) continue;
        partners.push_back({static_cast<std::uint32_t>(k), static_cast<std::uint32_t>(stance)});
        break;
      }
    }
    return partners;
  }

 private:
  [[nodiscard]] bool fits(const Setup& own, const Setup& other) const {
    const double apart_mm2 = (own.hold.origin_P_mm - other.hold.origin_P_mm).squaredNorm();
    return apart_mm2 <= farthest_mm_ * farthest_mm_ &&
           adjustable(own.hold, near_.bounds, other.hold, far_.bounds) &&
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
