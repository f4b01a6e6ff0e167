#include "host/cell/pallet.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "host/model/feature.hpp"
#include "host/planner/planar/planar.hpp"

namespace pinjaw::cell {
namespace {

using geometry::Vector2d;
using planner::PlanarFixture;

constexpr double kRadius_mm = 2.4;

model::Profile pentagon() {
  const std::vector<Vector2d> corners{{0, 0}, {32, -4}, {43, 19}, {21, 38}, {-6, 24}};
  model::Profile profile;
  profile.thickness_mm = 20;
  profile.loops.emplace_back();
  for (std::size_t i = 0; i < corners.size(); ++i) {
    model::ProfileEdge edge;
    edge.curve = geometry::Segment{corners[i], corners[(i + 1) % corners.size()]};
    profile.loops.front().push_back(edge);
  }
  return profile;
}

std::vector<PlanarFixture> fixtures(planner::Twins twins) {
  static const model::Profile profile = pentagon();
  model::Kit kit;
  kit.grid = {11, 3, 4, 5.5};
  kit.pins.radius_mm = kRadius_mm;
  kit.jaws.separation_mm = {0, 60};
  planner::PlanarOptions options;
  options.outline = &profile;
  options.twins = twins;
  return planner::plan_planar_fixtures(model::features_of(profile), kit, options).fixtures;
}

using Places = std::array<Vector2d, 3>;

Places places(const PalletFixture& pallet) {
  Places axes_mm;
  for (std::size_t i = 0; i < 3; ++i) {
    const planner::PlanarPin& pin = pallet.fixture.pins[pallet.pins[i]];
    axes_mm[i] = pin.p_PFoot_mm - kRadius_mm * pin.n_P;
  }
  return axes_mm;
}

/// The same three pins, whatever their order.
bool same(const Places& a, const Places& b) {
  return std::ranges::all_of(a, [&](const Vector2d& axis_mm) {
    return std::ranges::any_of(b,
                               [&](const Vector2d& other_mm) { return (axis_mm - other_mm).norm() < 1e-5; });
  });
}

model::JawSide jaw_of(const PalletFixture& pallet, std::size_t pin) {
  return pallet.fixture.pins[pin].hole.jaw;
}

TEST(Pallets, of_no_fixture_are_none) {
  EXPECT_TRUE(pallets_of({}, kRadius_mm).empty());
}

TEST(Pallets, need_three_pins_on_one_jaw) {
  auto all = fixtures(planner::Twins::Both);
  std::erase_if(all, [](const PlanarFixture& one) { return one.split != model::Split::TwoTwo; });
  ASSERT_FALSE(all.empty());
  EXPECT_TRUE(pallets_of(all, kRadius_mm).empty());
}

TEST(Pallets, keep_the_three_pins_and_drop_the_lone_one) {
  const auto pallets = pallets_of(fixtures(planner::Twins::Both), kRadius_mm);
  ASSERT_FALSE(pallets.empty());
  for (const PalletFixture& pallet : pallets) {
    const std::set<std::size_t> kept(pallet.pins.begin(), pallet.pins.end());
    ASSERT_EQ(kept.size(), 3U);
    for (std::size_t pin = 0; pin < 4; ++pin) {
      EXPECT_EQ(kept.contains(pin), jaw_of(pallet, pin) == jaw_of(pallet, pallet.pins[0]));
    }
  }
}

TEST(Pallets, are_every_set_of_three_pins_in_the_part_frame_once) {
  const auto all = fixtures(planner::Twins::Both);
  const auto pallets = pallets_of(all, kRadius_mm);
  for (std::size_t i = 0; i < pallets.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) EXPECT_FALSE(same(places(pallets[i]), places(pallets[k])));
  }
  std::size_t with_three = 0;
  for (const PlanarFixture& fixture : all) {
    const auto alone = pallets_of({fixture}, kRadius_mm);
    if (alone.empty()) continue;
    ++with_three;
    EXPECT_TRUE(std::ranges::any_of(
        pallets, [&](const PalletFixture& pallet) { return same(places(pallet), places(alone.front())); }));
  }
  EXPECT_GT(with_three, 2 * pallets.size()) << "twins, and lone pins in several places";
}

TEST(Pallets, are_the_same_whether_twins_are_listed_once_or_both) {
  const auto once = pallets_of(fixtures(planner::Twins::Once), kRadius_mm);
  const auto both = pallets_of(fixtures(planner::Twins::Both), kRadius_mm);
  EXPECT_EQ(once.size(), both.size());
}

}  // namespace
}  // namespace pinjaw::cell
