#include "host/planner/loading/loading.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "host/base/random.hpp"
#include "host/model/tolerance.hpp"
#include "tests/host/geometry/solids.hpp"

namespace pinjaw::planner {
namespace {

using geometry::Surface;
using geometry::Vector2d;
using geometry::testing::blocks;
using geometry::testing::Bounds;
using model::JawSide;

constexpr double kPlateTop_mm = -2;
constexpr double kTop_mm = 11;

model::Kit kit() {
  model::Kit kit;
  kit.grid = {.spacing_mm = 10, .columns = 3, .rows = 5, .edge_offset_mm = 5};
  kit.pins = {
      .radius_mm = 2.5, .lengths_mm = {}, .min_engagement_mm = 1, .protrusion_mm = 1, .clearance_mm = 0.2};
  kit.jaws.separation_mm = {0, 40};
  kit.jaws.plate_gap_mm = 2;
  return kit;
}

/// A block of 20 x 20 x 10 held by two pins on either side, 5 off its middle; the jaws 15 apart.
const Bounds kBlock{{-10, -10, 0}, {10, 10, 10}};

PlanarFixture fixture() {
  PlanarFixture fixture;
  fixture.span_mm = 25;
  fixture.x_left_mm = 12.5;
  fixture.y_mm = 5;
  fixture.closure_margin = 0.25;
  std::size_t i = 0;
  for (const JawSide jaw : {JawSide::Left, JawSide::Right}) {
    const double side = jaw == JawSide::Left ? -1 : 1;
    for (const int row : {0, 1}) {
      fixture.pins[i++] = {.hole = {jaw, 0, row},
                           .feature = row,
                           .foot_margin_mm = 5,
                           .p_PFoot_mm = {side * 10, row == 0 ? -5.0 : 5.0},
                           .n_P = {-side, 0}};
    }
  }
  return fixture;
}

std::vector<PinToLoad> standing(int count = 4, double top_mm = kTop_mm) {
  std::vector<PinToLoad> pins;
  for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
    pins.push_back({.pin = i, .length_mm = top_mm - kPlateTop_mm, .top_mm = top_mm, .contact_z_mm = {0, 10}});
  }
  return pins;
}

/// The block with more blocks about it.
Surface part_with(std::vector<Bounds> more) {
  more.push_back(kBlock);
  return Surface{blocks(more)};
}

base::Expected<model::Design, LoadingLoss> load_part(const Surface& part, const model::Kit& on,
                                                     const LoadingOptions& options = {}) {
  return load(fixture(), standing(), on, {&part, {}, kPlateTop_mm}, options);
}

LoadingLoss loss_of(const Surface& part, const model::Kit& on, const LoadingOptions& options = {}) {
  const auto design = load_part(part, on, options);
  EXPECT_FALSE(design);
  return design ? LoadingLoss::NoShift : design.error();
}

void expect_pins_touch_at_their_holes(const model::Design& design, const model::Kit& on) {
  for (const model::PinDesign& pin : design.pins) {
    const Vector2d axis_mm = pin.contact_mm - on.pins.radius_mm * pin.normal;
    const Vector2d hole_mm = model::p_GHole_mm(on.grid, pin.hole, design.jaw_separation_mm);
    EXPECT_NEAR((axis_mm - hole_mm).norm(), 0, 1e-9);
  }
}

TEST(Loading, the_least_shift_is_taken_and_the_others_are_listed) {
  const auto design = load_part(part_with({}), kit());
  ASSERT_TRUE(design);
  EXPECT_EQ(design->jaw_separation_mm, 15);
  EXPECT_EQ(design->jaw_open_mm, 40);
  EXPECT_EQ(design->closure_margin, 0.25);
  ASSERT_EQ(design->alternatives.size(), 2U);
  EXPECT_EQ(design->alternatives[0].left_shift, 1);
  EXPECT_EQ(design->alternatives[0].right_shift, 0);
  EXPECT_EQ(design->alternatives[0].jaw_separation_mm, 5);
  EXPECT_EQ(design->alternatives[1].right_shift, 1);
  ASSERT_EQ(design->pins.size(), 4U);
  EXPECT_EQ(design->pins[0].hole, (model::Hole{JawSide::Left, 0, 1}))
      << "rows centred, the lower of two middles";
  EXPECT_EQ(design->pins[3].hole, (model::Hole{JawSide::Right, 0, 2}));
  EXPECT_EQ(design->pins[1].top_z_mm, kTop_mm);
  EXPECT_EQ(design->pins[1].length_mm, 13);
  EXPECT_EQ(design->pins[1].feature, 1);
  expect_pins_touch_at_their_holes(*design, kit());
}

TEST(Loading, a_post_in_the_way_of_a_pin_discards_and_a_shorter_travel_keeps) {
  const Surface part = part_with({{{-22, -7, 0}, {-20, -3, 10}}});
  model::Kit short_travel = kit();
  EXPECT_EQ(loss_of(part, short_travel), LoadingLoss::PinSweep);
  short_travel.jaws.opening_mm = 4.9;
  const auto design = load_part(part, short_travel);
  ASSERT_TRUE(design) << "the pin's rim stops at -19.9";
  EXPECT_EQ(design->jaw_open_mm, 15 + 2 * 4.9);
  short_travel.jaws.opening_mm = 5.1;
  EXPECT_EQ(loss_of(part, short_travel), LoadingLoss::PinSweep);
}

TEST(Loading, what_hangs_above_a_pins_top_is_in_the_way_of_infinite_pins_only) {
  const Surface part = part_with({{{-22, -7, kTop_mm + 0.01}, {-20, -3, 20}}});
  EXPECT_TRUE(load_part(part, kit()));
  EXPECT_EQ(loss_of(part, kit(), {.sweeps = SweepHeights::Infinite}), LoadingLoss::PinSweep);
  const Surface lower = part_with({{{-22, -7, kTop_mm - 0.01}, {-20, -3, 20}}});
  EXPECT_EQ(loss_of(lower, kit()), LoadingLoss::PinSweep);
}

TEST(Loading, a_flange_over_the_closed_pins_stops_infinite_pins) {
  const Surface part = part_with({{{-14, -10, 12}, {14, 10, 15}}});
  EXPECT_TRUE(load_part(part, kit()));
  EXPECT_EQ(loss_of(part, kit(), {.sweeps = SweepHeights::Infinite}), LoadingLoss::PinSweep);
}

TEST(Loading, a_pin_may_slide_along_a_wall_that_it_just_touches) {
  EXPECT_TRUE(load_part(part_with({{{-40, 7.5, 0}, {-10, 20, 10}}}), kit()));
  EXPECT_EQ(loss_of(part_with({{{-40, 7.5 - 1.5 * model::kEps_mm, 0}, {-10, 20, 10}}}), kit()),
            LoadingLoss::PinSweep);
}

TEST(Loading, without_a_shift_in_range_there_is_nothing_to_load) {
  model::Kit narrow = kit();
  narrow.grid.columns = 1;
  narrow.jaws.separation_mm = {0, 14};
  EXPECT_EQ(loss_of(part_with({}), narrow), LoadingLoss::NoShift);
  model::Kit one_row = kit();
  one_row.grid.rows = 1;
  EXPECT_EQ(loss_of(part_with({}), one_row), LoadingLoss::NoShift);
}

TEST(Loading, a_jaw_that_cannot_open_takes_the_next_shift) {
  model::Kit tight = kit();
  tight.jaws.separation_mm = {0, 16};
  const auto design = load_part(part_with({}), tight);
  ASSERT_TRUE(design);
  EXPECT_EQ(design->jaw_separation_mm, 5);
  EXPECT_EQ(design->pins[0].hole, (model::Hole{JawSide::Left, 1, 1})) << "the left jaw's columns move first";
  ASSERT_EQ(design->alternatives.size(), 1U);
  expect_pins_touch_at_their_holes(*design, tight);
  tight.jaws.separation_mm = {10, 16};
  EXPECT_EQ(loss_of(part_with({}), tight), LoadingLoss::NoOpening);
}

class LoadingBeside : public ::testing::Test {
 protected:
  base::Expected<model::Design, LoadingLoss> beside(const Bounds& obstacle,
                                                    const LoadingOptions& options = {}) {
    const std::vector<Surface> others{Surface{blocks({obstacle})}};
    return load(fixture(), standing(options.motion == JawMotion::None ? 2 : 4), kit_,
                {&part_, others, kPlateTop_mm}, options);
  }
  model::Kit kit_ = kit();
  Surface part_ = part_with({});
};

TEST_F(LoadingBeside, an_obstacle_far_below_stops_the_open_gripper_on_its_way_along_z) {
  const auto design = beside({{-26, -6, -80}, {-24, -4, -70}});
  ASSERT_FALSE(design);
  EXPECT_EQ(design.error(), LoadingLoss::PinMeetsObstacle);
}

TEST_F(LoadingBeside, an_obstacle_under_the_closed_pins_alone_does_not) {
  const Bounds under_closed{{-13, -6, -80}, {-12, -4, -70}};
  EXPECT_TRUE(beside(under_closed));
  EXPECT_FALSE(beside(under_closed, {.motion = JawMotion::None})) << "a pallet's pins come there along z";
}

TEST_F(LoadingBeside, obstacles_keep_the_kits_clearance_to_pins) {
  EXPECT_FALSE(beside({{-20, -2.4, 0}, {-18, -2.0, 5}})) << "0.1 from the path";
  EXPECT_TRUE(beside({{-20, -2.29, 0}, {-18, -2.0, 5}})) << "0.21 from it";
  EXPECT_FALSE(beside({{-20, -6, kTop_mm + 0.1}, {-18, -4, 20}}));
  EXPECT_TRUE(beside({{-20, -6, kTop_mm + 0.21}, {-18, -4, 20}}));
}

TEST_F(LoadingBeside, another_shift_may_keep_a_plate_clear_of_an_obstacle) {
  const auto design = beside({{-49, -1, -5}, {-47, 1, -3}});
  ASSERT_TRUE(design);
  EXPECT_EQ(design->pins[0].hole.column, 1) << "the left plate stands 10 nearer";
  EXPECT_TRUE(design->alternatives.empty());
}

TEST_F(LoadingBeside, an_obstacle_in_the_way_of_a_plate_is_told_apart) {
  kit_.jaws.separation_mm.lo = 15;
  const auto design = beside({{-49, -1, -5}, {-47, 1, -3}});
  ASSERT_FALSE(design);
  EXPECT_EQ(design.error(), LoadingLoss::PlateMeetsObstacle);
  EXPECT_TRUE(beside({{-60, -1, -5}, {-51, 1, -3}})) << "beyond the open plate";
  EXPECT_TRUE(beside({{-49, -1, kPlateTop_mm}, {-47, 1, 5}})) << "resting on the plate";
}

TEST_F(LoadingBeside, a_body_that_moves_with_its_jaw_must_be_clear_as_the_plate_must) {
  kit_.jaws.separation_mm.lo = 15;
  const Bounds post{{-75, 18, -30}, {-70, 22, -14}};
  EXPECT_TRUE(beside(post)) << "the plate is above it and ends at y = 25 - 5";
  kit_.jaws.bodies = {{{20, 55}, {15, 40}, {-60, -11}}};
  const auto design = beside(post);
  ASSERT_FALSE(design) << "closed the body ends at x = -62.5, open at -75";
  EXPECT_EQ(design.error(), LoadingLoss::PlateMeetsObstacle);
  EXPECT_TRUE(beside({{-75, -22, -30}, {-70, -18, -14}})) << "y counts";
  EXPECT_FALSE(beside({{70, 18, -30}, {75, 22, -14}})) << "the right jaw mirrors the left";
  EXPECT_TRUE(beside({{-75, 18, kPlateTop_mm - 11}, {-70, 22, 5}})) << "resting on the body";
  EXPECT_FALSE(beside({{-75, 18, -90}, {-70, 22, -80}})) << "in its way along z";
}

TEST_F(LoadingBeside, a_body_may_meet_the_part_itself) {
  kit_.jaws.bodies = {{{-6, 0}, {-3, 3}, {0, 4}}};
  const auto design = beside({{100, 100, 0}, {101, 101, 1}});
  ASSERT_FALSE(design) << "it reaches 6 into a gap of 2.5, 2 above the part's lowest point";
  EXPECT_EQ(design.error(), LoadingLoss::PlateMeetsObstacle);
  kit_.jaws.bodies = {{{-6, 0}, {-3, 3}, {0, 1.7}}};
  EXPECT_TRUE(beside({{100, 100, 0}, {101, 101, 1}})) << "under it";
}

TEST_F(LoadingBeside, a_pallet_neither_opens_nor_sweeps) {
  const auto design = beside({{-20, -6, 0}, {-18, -4, 5}}, {.motion = JawMotion::None});
  ASSERT_TRUE(design);
  EXPECT_EQ(design->jaw_open_mm, design->jaw_separation_mm);
  EXPECT_EQ(design->pins.size(), 2U);
}

/// The fixture with its part turned in the part frame: the same thing to the gripper.
PlanarFixture turned(const PlanarFixture& source, double theta_rad) {
  PlanarFixture result = source;
  const geometry::Pose2 X_PG{-theta_rad, Vector2d::Zero()};
  result.theta_rad = theta_rad;
  for (PlanarPin& pin : result.pins) {
    pin.p_PFoot_mm = X_PG * pin.p_PFoot_mm;
    pin.n_P = X_PG * pin.n_P;
  }
  return result;
}

TEST(LoadingLaws, turning_the_part_frame_changes_nothing) {
  base::Random random(31);
  int loaded = 0;
  for (int i = 0; i < 60; ++i) {
    const double x_mm = random.uniform(-40, 20);
    const double y_mm = random.uniform(-20, 15);
    const auto mesh = blocks({kBlock, {{x_mm, y_mm, 0}, {x_mm + 5, y_mm + 5, 10}}});
    const double theta_rad = random.uniform(0, 6.28);
    auto turned_mesh = mesh;
    for (auto& p : turned_mesh.vertices_mm)
      p.head<2>() = geometry::Pose2{-theta_rad, Vector2d::Zero()} * Vector2d(p.head<2>());
    const Surface part{mesh};
    const Surface turned_part{turned_mesh};
    const auto straight = load(fixture(), standing(), kit(), {&part, {}, kPlateTop_mm});
    const auto oblique =
        load(turned(fixture(), theta_rad), standing(), kit(), {&turned_part, {}, kPlateTop_mm});
    ASSERT_EQ(straight.has_value(), oblique.has_value()) << i;
    if (!straight) continue;
    ++loaded;
    for (std::size_t pin = 0; pin < 4; ++pin) {
      EXPECT_EQ(straight->pins[pin].hole, oblique->pins[pin].hole);
      EXPECT_NEAR((straight->pins[pin].contact_mm - oblique->pins[pin].contact_mm).norm(), 0, 1e-9);
      EXPECT_NEAR((straight->pins[pin].normal - oblique->pins[pin].normal).norm(), 0, 1e-9);
    }
    EXPECT_EQ(straight->alternatives.size(), oblique->alternatives.size());
  }
  EXPECT_GT(loaded, 10);
  EXPECT_LT(loaded, 55);
}

/// Whether a pin of radius `radius_mm` is somewhere over the block's plan in one of many places on its way.
bool seen_in_samples(const Bounds& block, double radius_mm) {
  const PlanarFixture source = fixture();
  for (const PlanarPin& pin : source.pins) {
    for (int step = 0; step <= 1000; ++step) {
      const double opening_mm = 12.5 * step / 1000;
      const Vector2d at = pin.p_PFoot_mm - (2.5 + opening_mm) * pin.n_P;
      const Vector2d beside =
          (Vector2d(block.lo.head<2>()) - at).cwiseMax(at - Vector2d(block.hi.head<2>())).cwiseMax(0.0);
      if (beside.norm() <= radius_mm) return true;
    }
  }
  return false;
}

TEST(LoadingLaws, agrees_with_dense_samples_of_the_way) {
  base::Random random(32);
  int blocked = 0;
  for (int i = 0; i < 300; ++i) {
    const double x_mm = random.uniform(-40, 30);
    const double y_mm = random.uniform(-25, 20);
    const Bounds post{{x_mm, y_mm, 0}, {x_mm + random.uniform(1, 6), y_mm + random.uniform(1, 6), 10}};
    const Surface part = part_with({post});
    model::Kit only_one_shift = kit();
    only_one_shift.jaws.separation_mm.lo = 15;
    const auto design = load_part(part, only_one_shift);
    const double radius_mm = 2.5 - model::kEps_mm;
    if (design) {
      EXPECT_FALSE(seen_in_samples(post, radius_mm - 1e-6)) << i;
    } else {
      ++blocked;
      EXPECT_TRUE(seen_in_samples(post, radius_mm + 0.001)) << i;
    }
  }
  EXPECT_GT(blocked, 50);
  EXPECT_LT(blocked, 250);
}

TEST(LoadingLosses, each_has_its_own_name) {
  for (const LoadingLoss a : kLoadingLosses) {
    EXPECT_NE(to_string(a), "?");
    for (const LoadingLoss b : kLoadingLosses) {
      if (a != b) {
        EXPECT_NE(to_string(a), to_string(b));
      }
    }
  }
}

}  // namespace
}  // namespace pinjaw::planner
