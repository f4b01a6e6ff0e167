#include "host/planner/heights/heights.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <thread>
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

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kEps = model::kEps_mm;
constexpr double kPlateTop_mm = -2;

model::PinStock stock() {
  return {
      .radius_mm = 2.5, .lengths_mm = {}, .min_engagement_mm = 1, .protrusion_mm = 1, .clearance_mm = 0.2};
}

Foot from_the_left(double x_mm, double y_mm) {
  return {{x_mm, y_mm}, Vector2d::UnitX()};
}

void expect_interval(const model::Interval& z, double lo, double hi) {
  EXPECT_NEAR(z.lo, lo, 1e-9);
  EXPECT_NEAR(z.hi, hi, 1e-9);
}

const Surface& box() {
  static const Surface kBox{blocks({{{0, 0, 0}, {20, 20, 10}}})};
  return kBox;
}

/// A stem z 0 to 10 under a flange z 10 to 15 that overhangs it by 10 on either side.
const Surface& t_section() {
  static const Surface kSection{blocks({{{10, 0, 0}, {20, 20, 10}}, {{0, 0, 10}, {30, 20, 15}}})};
  return kSection;
}

TEST(PinHeight, at_a_silhouette_the_pin_protrudes_above_the_part) {
  const auto pin = pin_height(box(), stock(), kPlateTop_mm, from_the_left(0, 10));
  ASSERT_TRUE(pin);
  EXPECT_EQ(pin->contact_min_mm, 0);
  EXPECT_EQ(pin->height_max_mm, kInfinity);
  EXPECT_EQ(pin->contact_max_mm, 10);
  EXPECT_EQ(pin->z_edge_mm, 0);
  EXPECT_EQ(pin->top_mm, 11);
  EXPECT_EQ(pin->length_mm, 13) << "from the plate, 2 under the part";
  expect_interval(pin->contact_z_mm, 0, 10);
}

TEST(PinHeight, under_an_overhang_the_pin_stops_a_clearance_below_it) {
  const auto pin = pin_height(t_section(), stock(), kPlateTop_mm, from_the_left(10, 10));
  ASSERT_TRUE(pin);
  EXPECT_EQ(pin->height_max_mm, 10);
  EXPECT_NEAR(pin->contact_max_mm, 10 - kEps, 1e-12) << "the ceiling itself is no contact";
  EXPECT_NEAR(pin->top_mm, 9.8, 1e-12);
  expect_interval(pin->contact_z_mm, 0, 9.8);
}

TEST(PinHeight, at_the_overhangs_own_rim_the_pin_reaches_past_the_stem) {
  const auto pin = pin_height(t_section(), stock(), kPlateTop_mm, from_the_left(0, 10));
  ASSERT_TRUE(pin);
  EXPECT_EQ(pin->z_edge_mm, 10);
  EXPECT_EQ(pin->height_max_mm, kInfinity);
  EXPECT_EQ(pin->top_mm, 16);
  EXPECT_EQ(pin->length_mm, 18);
  expect_interval(pin->contact_z_mm, 10, 15);
}

TEST(PinHeight, a_groove_in_the_wall_does_not_end_the_contact) {
  const Surface part{blocks({{{0, 0, 0}, {20, 20, 4}}, {{3, 0, 4}, {20, 20, 6}}, {{0, 0, 6}, {20, 20, 10}}})};
  // Above the groove's floor hangs its ceiling at z = 6, but not over a pin that stands outside the wall.
  const auto pin = pin_height(part, stock(), kPlateTop_mm, from_the_left(0, 10));
  ASSERT_TRUE(pin);
  EXPECT_EQ(pin->contact_max_mm, 10);
  expect_interval(pin->contact_z_mm, 0, 10);
}

TEST(PinHeight, in_a_pocket_open_below_the_ceiling_bounds_the_pin) {
  // Walls around x, y in [5, 15] down to z = 0; the ceiling at z = 4.
  const Surface part{blocks({{{0, 0, 0}, {5, 20, 10}},
                             {{15, 0, 0}, {20, 20, 10}},
                             {{5, 0, 0}, {15, 5, 10}},
                             {{5, 15, 0}, {15, 20, 10}},
                             {{5, 5, 4}, {15, 15, 10}}})};
  const auto pin = pin_height(part, stock(), kPlateTop_mm, {{15, 10}, Vector2d::UnitX()});
  ASSERT_TRUE(pin);
  EXPECT_EQ(pin->height_max_mm, 4);
  EXPECT_NEAR(pin->top_mm, 3.8, 1e-12);
  expect_interval(pin->contact_z_mm, 0, 3.8);
}

TEST(PinHeight, a_thick_pin_touches_lower_walls_on_its_rim_without_counting_them_at_the_foot) {
  // A second wall beside the pin, tangent to it, reaches lower than the edge at the foot.
  const Surface part{blocks({{{0, 0, 5}, {20, 20, 10}}, {{-10, 12.5, -3}, {-1, 20, 8}}})};
  const auto pin = pin_height(part, stock(), -5, from_the_left(0, 10));
  ASSERT_TRUE(pin);
  EXPECT_EQ(pin->contact_min_mm, -3);
  EXPECT_EQ(pin->z_edge_mm, 5);
  EXPECT_EQ(pin->height_max_mm, kInfinity);
  expect_interval(pin->contact_z_mm, 5, 10);
}

TEST(PinHeight, too_low_a_ceiling_leaves_no_engagement) {
  const auto under_ceiling_mm = [](double ceiling_mm) {
    const Surface part{blocks({{{10, 0, 0}, {20, 20, ceiling_mm}}, {{0, 0, ceiling_mm}, {30, 20, 15}}})};
    return pin_height(part, stock(), kPlateTop_mm, from_the_left(10, 10));
  };
  ASSERT_FALSE(under_ceiling_mm(1.19));
  EXPECT_EQ(under_ceiling_mm(1.19).error(), HeightLoss::NoEngagement);
  EXPECT_TRUE(under_ceiling_mm(1.2)) << "engagement and clearance, exactly";
}

TEST(PinHeight, a_part_thinner_than_the_engagement_is_held_by_the_protruding_pin) {
  const Surface sheet{blocks({{{0, 0, 0}, {20, 20, 0.5}}})};
  const auto pin = pin_height(sheet, stock(), kPlateTop_mm, from_the_left(0, 10));
  ASSERT_TRUE(pin);
  expect_interval(pin->contact_z_mm, 0, 0.5);
}

TEST(PinHeight, a_contact_under_a_thousandth_is_one_point) {
  const Surface foil{blocks({{{0, 0, 4}, {20, 20, 4.0008}}})};
  const auto pin = pin_height(foil, stock(), kPlateTop_mm, from_the_left(0, 10));
  ASSERT_TRUE(pin);
  EXPECT_EQ(pin->contact_z_mm.lo, pin->contact_z_mm.hi);
  EXPECT_NEAR(pin->contact_z_mm.lo, 4.0004, 1e-9);
}

TEST(PinHeight, a_foot_beside_the_part_has_no_surface) {
  const auto pin = pin_height(box(), stock(), kPlateTop_mm, from_the_left(-0.5, 10));
  ASSERT_FALSE(pin);
  EXPECT_EQ(pin.error(), HeightLoss::NoSurfaceAtFoot);
}

TEST(PinHeight, a_foot_under_a_flat_face_has_no_engagement) {
  const auto pin = pin_height(box(), stock(), kPlateTop_mm, from_the_left(7, 10));
  ASSERT_FALSE(pin);
  EXPECT_EQ(pin.error(), HeightLoss::NoEngagement);
}

TEST(PinHeight, the_longest_stock_length_that_fits_is_taken) {
  const auto with = [](std::vector<double> lengths_mm) {
    model::PinStock pins = stock();
    pins.lengths_mm = std::move(lengths_mm);
    return pin_height(box(), pins, kPlateTop_mm, from_the_left(0, 10));
  };
  EXPECT_EQ(with({5, 10, 13, 13.01})->length_mm, 13);
  EXPECT_EQ(with({5, 10, 13.01})->length_mm, 10);
  EXPECT_EQ(with({5, 10, 13.01})->top_mm, 8);
  expect_interval(with({5, 10})->contact_z_mm, 0, 8);
  EXPECT_EQ(with({13.01}).error(), HeightLoss::NoStockLength);
  EXPECT_EQ(with({2.99, 14}).error(), HeightLoss::StockTooShort);
  EXPECT_TRUE(with({3, 14})) << "exactly the engagement";
}

TEST(PinHeight, what_is_attached_lowers_the_plate_and_lengthens_the_pin) {
  model::Kit kit;
  kit.jaws.plate_gap_mm = 2;
  EXPECT_EQ(plate_top_mm(kit, box()), -2);
  const std::vector<Surface> attached{Surface{blocks({{{5, 5, -4}, {6, 6, 0}}})}};
  EXPECT_EQ(plate_top_mm(kit, box(), attached), -6);
  EXPECT_EQ(pin_height(box(), stock(), -6, from_the_left(0, 10))->length_mm, 17);
}

/// The definitions of phase 3 on upright blocks, each in closed form.
class BlocksReferee {
 public:
  explicit BlocksReferee(std::vector<Bounds> all) : all_(std::move(all)) {}

  double lowest_mm(const Vector2d& at, double radius_mm) const {
    double z = kInfinity;
    for (const Bounds& b : all_) {
      if (distance_mm(b, at) <= radius_mm) z = std::min(z, b.lo.z());
    }
    return z;
  }
  double highest_under_mm(const Vector2d& at, double radius_mm, double ceiling_mm) const {
    double z = -kInfinity;
    for (const Bounds& b : all_) {
      if (distance_mm(b, at) > radius_mm || b.lo.z() > ceiling_mm) continue;
      z = std::max(z, b.lo.z());
      if (depth_mm(b, at) <= radius_mm) z = std::max(z, std::min(b.hi.z(), ceiling_mm));
      if (b.hi.z() <= ceiling_mm) z = std::max(z, b.hi.z());
    }
    return z;
  }

 private:
  static double distance_mm(const Bounds& b, const Vector2d& p) {
    return (Vector2d(b.lo.head<2>()) - p).cwiseMax(p - Vector2d(b.hi.head<2>())).cwiseMax(0.0).norm();
  }
  /// How deep inside the block's plan the point lies; -inf outside.
  static double depth_mm(const Bounds& b, const Vector2d& p) {
    return std::min((p - Vector2d(b.lo.head<2>())).minCoeff(), (Vector2d(b.hi.head<2>()) - p).minCoeff());
  }
  std::vector<Bounds> all_;
};

TEST(PinHeight, agrees_with_the_closed_form_on_random_blocks) {
  base::Random random(21);
  int found = 0;
  for (int trial = 0; trial < 400; ++trial) {
    std::vector<Bounds> all;
    for (int i = 0; i < 6; ++i) {
      const geometry::Vector3d lo{random.uniform(0, 20), random.uniform(0, 20), random.uniform(0, 20)};
      all.push_back(
          {lo, lo + geometry::Vector3d(random.uniform(1, 12), random.uniform(1, 12), random.uniform(1, 12))});
    }
    const Surface part{blocks(all)};
    const BlocksReferee referee(all);
    for (const Bounds& b : all) {
      const Foot foot = from_the_left(b.lo.x(), random.uniform(b.lo.y(), b.hi.y()));
      const Vector2d axis = foot.p_PFoot_mm - 2.5 * foot.n_P;
      const double ceiling_mm = referee.lowest_mm(axis, 2.5 - kEps);
      const double highest_mm = referee.highest_under_mm(axis, 2.5 + kEps, ceiling_mm - kEps);
      const double edge_mm = referee.lowest_mm(foot.p_PFoot_mm + kEps * foot.n_P, 0);
      const double top_mm = std::min(highest_mm + 1, ceiling_mm - 0.2);
      const auto pin = pin_height(part, stock(), -2, foot);
      ASSERT_EQ(pin.has_value(), top_mm >= edge_mm + 1) << trial;
      if (!pin) continue;
      ++found;
      EXPECT_NEAR(pin->contact_min_mm, referee.lowest_mm(axis, 2.5 + kEps), 1e-9);
      EXPECT_NEAR(pin->top_mm, top_mm, 1e-9);
      EXPECT_NEAR(pin->z_edge_mm, edge_mm, 1e-9);
      if (std::isfinite(ceiling_mm)) {
        EXPECT_NEAR(pin->height_max_mm, ceiling_mm, 1e-9);
      }
      EXPECT_LE(pin->contact_z_mm.lo, edge_mm + 1e-9);
      if (b.lo.z() <= top_mm) {
        EXPECT_GE(pin->contact_z_mm.hi, std::min(b.hi.z(), top_mm) - 1e-9);
      }
      EXPECT_LE(pin->contact_z_mm.hi, top_mm);
    }
  }
  EXPECT_GT(found, 500);
}

TEST(Heights, remembers_what_pin_height_finds) {
  const Heights heights(t_section(), stock(), kPlateTop_mm);
  for (const double y_mm : {3.0, 10.0, 3.0}) {
    const auto expected = pin_height(t_section(), stock(), kPlateTop_mm, from_the_left(10, y_mm));
    const auto pin = heights.at(from_the_left(10, y_mm));
    ASSERT_TRUE(pin);
    EXPECT_NEAR(pin->top_mm, expected->top_mm, 1e-12);
    EXPECT_NEAR(pin->length_mm, expected->length_mm, 1e-12);
  }
  EXPECT_EQ(heights.at(from_the_left(5, 10)).error(), HeightLoss::NoEngagement);
}

TEST(Heights, a_foot_that_differs_by_rounding_has_the_same_height_to_the_last_bit) {
  const Surface slope{
      geometry::TriangleMesh{{{0, -50, 0}, {0, 50, 0}, {50, 0, 37}, {0, -50, 10}, {0, 50, 10}},
                             {{0, 2, 1}, {0, 1, 4}, {0, 4, 3}},
                             {0, 1, 1}}};
  const Heights heights(slope, stock(), kPlateTop_mm);
  const auto a = heights.at(from_the_left(0, 1.0 / 3));
  const auto b = heights.at(from_the_left(1e-13, 1.0 / 3 + 1e-13));
  ASSERT_TRUE(a);
  EXPECT_EQ(a->top_mm, b->top_mm);
  EXPECT_EQ(a->contact_z_mm, b->contact_z_mm);
}

TEST(Heights, a_fixture_is_lost_with_its_first_pin_that_has_no_height) {
  const Heights heights(t_section(), stock(), kPlateTop_mm);
  PlanarFixture fixture;
  for (std::size_t i = 0; i < 4; ++i) {
    fixture.pins[i].p_PFoot_mm = {i < 2 ? 10.0 : 20.0, 4.0 + 10.0 * static_cast<double>(i % 2)};
    fixture.pins[i].n_P = i < 2 ? Vector2d(1, 0) : Vector2d(-1, 0);
  }
  const auto good = heights.of(fixture);
  ASSERT_TRUE(good);
  for (const PinHeight& pin : *good) EXPECT_NEAR(pin.top_mm, 9.8, 1e-12);
  fixture.pins[2].p_PFoot_mm.x() = 25;
  const auto lost = heights.of(fixture);
  ASSERT_FALSE(lost);
  EXPECT_EQ(lost.error().pin, 2U);
  EXPECT_EQ(lost.error().reason, HeightLoss::NoEngagement);
}

TEST(Heights, serves_many_threads_alike) {
  const Heights heights(t_section(), stock(), kPlateTop_mm);
  const auto work = [&heights](double* sum) {
    for (int i = 0; i < 3000; ++i) {
      if (const auto pin = heights.at(from_the_left(10, 1 + (i % 700) * 0.02))) *sum += pin->top_mm;
    }
  };
  std::array<double, 3> sums{};
  {
    const std::jthread a(work, &sums[0]);
    const std::jthread b(work, &sums[1]);
    work(&sums[2]);
  }
  EXPECT_GT(sums[0], 0);
  EXPECT_EQ(sums[0], sums[1]);
  EXPECT_EQ(sums[0], sums[2]);
}

TEST(HeightLosses, each_has_its_own_name) {
  for (const HeightLoss a : kHeightLosses) {
    EXPECT_NE(to_string(a), "?");
    for (const HeightLoss b : kHeightLosses) {
      if (a != b) {
        EXPECT_NE(to_string(a), to_string(b));
      }
    }
  }
}

}  // namespace
}  // namespace pinjaw::planner
