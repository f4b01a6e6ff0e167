#include "host/planner/heights/heights.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <mutex>
#include <optional>
#include <vector>

namespace pinjaw::planner {
namespace {

/// Steps of a foot's place and normal, so that one foot met twice with different rounding is one. Chosen: far
/// under eps.
constexpr double kFootStep_mm = 1e-7;
constexpr double kNormalStep = 1e-9;
/// Places for feet that were met, each with room for one: some 12 MB. Chosen: of many more, few are met
/// again.
constexpr std::size_t kPlaces = 1U << 16U;
constexpr std::size_t kLocks = 64;  ///< chosen: many more than threads

using Key = std::array<std::int64_t, 4>;

std::int64_t steps(double value, double step) {
  return std::llround(value / step);
}

Key key_of(const Foot& foot) {
  return {steps(foot.p_PFoot_mm.x(), kFootStep_mm), steps(foot.p_PFoot_mm.y(), kFootStep_mm),
          steps(foot.n_P.x(), kNormalStep), steps(foot.n_P.y(), kNormalStep)};
}

Foot foot_of(const Key& key) {
  return {{static_cast<double>(key[0]) * kFootStep_mm, static_cast<double>(key[1]) * kFootStep_mm},
          {static_cast<double>(key[2]) * kNormalStep, static_cast<double>(key[3]) * kNormalStep}};
}

std::size_t hash_of(const Key& key) {
  std::uint64_t h = 0;
  for (const std::int64_t part : key) {
    h = (h ^ static_cast<std::uint64_t>(part)) * 0x9e3779b97f4a7c15U;
    h ^= h >> 32U;
  }
  return static_cast<std::size_t>(h);
}

struct Known {
  Key key{};
  std::optional<PinHeightOutcome> outcome;  ///< nothing where no foot was met yet
};

}  // namespace

std::string_view to_string(HeightLoss loss) {
  switch (loss) {
    case HeightLoss::NoSurfaceAtFoot:
      return "no_surface_at_foot";
    case HeightLoss::NoStockLength:
      return "no_stock_length";
    case HeightLoss::StockTooShort:
      return "stock_too_short";
    case HeightLoss::NoEngagement:
      return "no_engagement";
  }
  return "?";
}

double plate_top_mm(const model::Kit& kit, const geometry::Surface& part,
                    std::span<const geometry::Surface> attached) {
  double lowest_mm = part.z_range_mm().lo;
  for (const geometry::Surface& other : attached) lowest_mm = std::min(lowest_mm, other.z_range_mm().lo);
  return lowest_mm - kit.jaws.plate_gap_mm;
}

struct Heights::Impl {
  Impl(const geometry::Surface& on, const model::PinStock& stock, double plate_mm)
      : part(on), pins(stock), plate_top_mm(plate_mm) {}

  geometry::Surface part;
  model::PinStock pins;
  double plate_top_mm;
  std::array<std::mutex, kLocks> locks;
  std::vector<Known> known = std::vector<Known>(kPlaces);
};

Heights::Heights(const geometry::Surface& part, const model::PinStock& pins, double plate_top_mm)
    : impl_(std::make_unique<Impl>(part, pins, plate_top_mm)) {}

Heights::~Heights() = default;

PinHeightOutcome Heights::at(const Foot& foot) const {
  const Key key = key_of(foot);
  const std::size_t place = hash_of(key) % kPlaces;
  Known& known = impl_->known[place];
  std::mutex& mutex = impl_->locks[place % kLocks];
  {
    const std::lock_guard lock(mutex);
    if (known.outcome && known.key == key) return *known.outcome;
  }
  const PinHeightOutcome outcome = pin_height(impl_->part, impl_->pins, impl_->plate_top_mm, foot_of(key));
  const std::lock_guard lock(mutex);
  known = {key, outcome};
  return outcome;
}

base::Expected<FixtureHeights, FixtureHeightLoss> Heights::of(const PlanarFixture& fixture) const {
  FixtureHeights heights;
  for (std::size_t i = 0; i < fixture.pins.size(); ++i) {
    const PlanarPin& pin = fixture.pins[i];
    const PinHeightOutcome outcome = at({pin.p_PFoot_mm, pin.n_P});
    if (!outcome) return tl::unexpected(FixtureHeightLoss{i, outcome.error()});
    heights[i] = *outcome;
  }
  return heights;
}

}  // namespace pinjaw::planner
