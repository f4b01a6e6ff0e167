#include "firmware_sim/world/part_truth.hpp"

#include <algorithm>

namespace pinjaw::world {
namespace {

constexpr double kStep_s = 0.001;
constexpr double kGravity_mm_s2 = 9806.65;

/// Share of the needed squeeze that a station gives, up to 1.
double share(const Touch& touch) {
  if (holds(touch)) return 1.0;
  return touch.needed_n > 0.0 ? std::min(1.0, touch.least_n / touch.needed_n) : 0.0;
}

}  // namespace

bool touches(const Touch& touch) {
  return touch.passive ? touch.seated : touch.least_n > 0.0;
}

bool holds(const Touch& touch) {
  if (touch.passive) return touch.seated && touch.needed_n <= 0.0;
  return touch.least_n > 0.0 && touch.least_n >= touch.needed_n;
}

void PartTruth::place() {
  *this = PartTruth();
  placed_ = true;
}

void PartTruth::remove() {
  placed_ = false;
  hand_ = false;
  holders_.clear();
}

void PartTruth::observe(const std::vector<Touch>& touched, double time_s) {
  holders_.clear();
  if (!here()) return;
  for (const Touch& touch : touched) {
    if (holds(touch)) holders_.push_back(touch.node);
  }
  if (hand_) return;
  const int count = static_cast<int>(holders_.size());
  min_holders_ = std::min(min_holders_.value_or(count), count);
  if (count > 0) {
    slip_speed_mm_s_ = 0;
  } else if (std::ranges::any_of(touched, touches)) {
    slide(touched, time_s);
  } else {
    drop(time_s);
  }
}

void PartTruth::slide(const std::vector<Touch>& touched, double time_s) {
  double best = 0;
  for (const Touch& touch : touched) best = std::max(best, share(touch));
  slipped_ = true;
  slip_speed_mm_s_ += kGravity_mm_s2 * (1.0 - best) * kStep_s;
  slip_mm_ += slip_speed_mm_s_ * kStep_s;
  if (slip_mm_ >= kLost_mm) drop(time_s);
}

void PartTruth::drop(double time_s) {
  dropped_ = true;
  dropped_at_s_ = time_s;
}

}  // namespace pinjaw::world
