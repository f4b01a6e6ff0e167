#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/planner/planar/column_shifts.hpp"
#include "host/planner/planar/contact_curve.hpp"
#include "host/planner/planar/outline.hpp"
#include "host/planner/planar/pair.hpp"
#include "tests/host/planner/planar/read_case.hpp"
#include "tests/host/planner/planar/shapes.hpp"

namespace pinjaw::planner {
namespace {

using geometry::Arc;
using geometry::Segment;
using geometry::Vector2d;

constexpr double kPi = std::numbers::pi;

/// A flat back along y at x = 0, symmetric about y = 16.5.
model::Profile kite() {
  return polygon_profile(
      {Vector2d(0, 0), Vector2d(20, -4), Vector2d(44, 16.5), Vector2d(20, 37), Vector2d(0, 33)});
}

std::ptrdiff_t count_at(const std::vector<PlanarFixture>& fixtures, double theta_rad) {
  return std::ranges::count_if(fixtures, [&](const PlanarFixture& fixture) {
    return std::abs(std::remainder(fixture.theta_rad - theta_rad, 2 * kPi)) < 1e-9;
  });
}

bool same_pose(const PlanarFixture& a, const PlanarFixture& b) {
  for (std::size_t k = 0; k < 4; ++k) {
    if (a.pins[k].hole != b.pins[k].hole) return false;
  }
  return std::abs(std::remainder(a.theta_rad - b.theta_rad, 2 * kPi)) < 1e-7 &&
         std::abs(a.span_mm - b.span_mm) < 1e-6 && std::abs(a.y_mm - b.y_mm) < 1e-6;
}

TEST(PlanarDegeneracies, two_pins_of_a_jaw_on_one_edge_are_found) {
  const KnownCase triangle = read_case("triangle");
  const auto fixtures = all_fixtures(triangle.profile, triangle.kit);
  EXPECT_EQ(fixtures.size(), 306U);
  for (const PlanarFixture& fixture : fixtures) {
    bool shared = false;
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t k = 0; k < i; ++k) {
        shared = shared || (fixture.pins[i].feature == fixture.pins[k].feature &&
                            fixture.pins[i].hole.jaw == fixture.pins[k].hole.jaw);
      }
    }
    EXPECT_TRUE(shared);
  }
}

TEST(PlanarDegeneracies, two_pins_of_a_jaw_on_parallel_edges_are_found) {
  const auto stepped = polygon_profile({Vector2d(0, 0), Vector2d(22, -7), Vector2d(44, 14), Vector2d(20, 38),
                                        Vector2d(-4, 33), Vector2d(-4, 16), Vector2d(0, 16)});
  const auto fixtures = all_fixtures(stepped, small_kit(3, 4));
  const auto on_both_steps = [](const PlanarFixture& fixture) {
    return fixture.pins[0].hole.jaw == fixture.pins[1].hole.jaw &&
           std::minmax(fixture.pins[0].feature, fixture.pins[1].feature) == std::minmax(4, 6);
  };
  EXPECT_TRUE(std::ranges::any_of(fixtures, on_both_steps));
}

TEST(PlanarDegeneracies, three_pins_of_a_jaw_on_one_edge_never_hold) {
  const auto wedge = polygon_profile({Vector2d(0, 0), Vector2d(60, 0), Vector2d(30, 24)});
  const auto fixtures = all_fixtures(wedge, small_kit(4, 6));
  EXPECT_GT(fixtures.size(), 100U);
  for (const PlanarFixture& fixture : fixtures) {
    for (const std::size_t first : {0U, 1U}) {
      const bool one_jaw = fixture.pins[first].hole.jaw == fixture.pins[first + 2].hole.jaw;
      const bool one_edge = fixture.pins[first].feature == fixture.pins[first + 1].feature &&
                            fixture.pins[first].feature == fixture.pins[first + 2].feature;
      EXPECT_FALSE(one_jaw && one_edge);
    }
  }
}

TEST(PlanarDegeneracies, a_disc_turns_in_any_pins_and_has_no_fixture) {
  model::ProfileEdge edge;
  edge.curve = Arc{Vector2d(3, 4), 18, 0.3, 2 * kPi};
  EXPECT_TRUE(all_fixtures(profile_of_loop({edge}), small_kit(3, 4)).empty());
}

TEST(PlanarDegeneracies, a_part_of_concentric_arcs_has_no_fixture) {
  std::vector<model::ProfileEdge> loop(2);
  loop[0].curve = Arc{Vector2d(0, 0), 18, 0.3, kPi};
  loop[1].curve = Arc{Vector2d(0, 0), 18, 0.3 + kPi, kPi};
  EXPECT_TRUE(all_fixtures(profile_of_loop(loop), small_kit(3, 4)).empty());
}

TEST(PlanarDegeneracies, poses_along_the_axes_are_found) {
  const model::Kit kit = small_kit(3, 4);
  const auto fixtures = all_fixtures(kite(), kit);
  const auto along = count_at(fixtures, 0);
  EXPECT_GT(along, 0);
  EXPECT_EQ(count_at(fixtures, kPi), along);  // the twins
  for (const double turn_rad : {0.3, kPi / 2, kPi}) {
    const auto turned = all_fixtures(moved(kite(), {turn_rad, Vector2d(1, 2)}), kit);
    EXPECT_EQ(turned.size(), fixtures.size());
    EXPECT_EQ(count_at(turned, -turn_rad), along);
  }
}

TEST(PlanarDegeneracies, theta_is_never_told_as_a_whole_turn) {
  for (const PlanarFixture& fixture : all_fixtures(kite(), small_kit(3, 4))) {
    EXPECT_GE(fixture.theta_rad, 0);
    EXPECT_LT(fixture.theta_rad, 2 * kPi - 1e-9);
  }
}

TEST(PlanarDegeneracies, a_rectangle_is_not_held_by_sides_along_the_closing_axis) {
  const auto rectangle =
      polygon_profile({Vector2d(0, 0), Vector2d(33, 0), Vector2d(33, 22), Vector2d(0, 22)});
  const auto fixtures = all_fixtures(rectangle, small_kit(3, 4));
  for (int quarter = 0; quarter < 4; ++quarter) EXPECT_EQ(count_at(fixtures, quarter * kPi / 2), 0);
}

TEST(PlanarDegeneracies, normals_that_only_oppose_never_close) {
  const auto parallelogram =
      polygon_profile({Vector2d(0, 0), Vector2d(33, 3), Vector2d(38, 28), Vector2d(5, 25)});
  for (const PlanarFixture& fixture : all_fixtures(parallelogram, small_kit(3, 4))) {
    EXPECT_GT(fixture.closure_margin, 1e-6);
  }
}

TEST(PlanarDegeneracies, an_edge_told_as_two_gives_the_same_poses) {
  const auto whole = polygon_profile(
      {Vector2d(0, 0), Vector2d(32, -4), Vector2d(43, 19), Vector2d(21, 38), Vector2d(-6, 24)});
  const auto split = polygon_profile({Vector2d(0, 0), Vector2d(16, -2), Vector2d(32, -4), Vector2d(43, 19),
                                      Vector2d(21, 38), Vector2d(-6, 24)});
  const auto of_whole = all_fixtures(whole, small_kit(3, 4));
  const auto of_split = all_fixtures(split, small_kit(3, 4));
  EXPECT_EQ(of_whole.size(), of_split.size());
  for (const PlanarFixture& fixture : of_whole) {
    EXPECT_TRUE(
        std::ranges::any_of(of_split, [&](const PlanarFixture& other) { return same_pose(fixture, other); }));
  }
}

TEST(PlanarDegeneracies, feet_exactly_at_both_ends_of_an_edge_hold) {
  const auto fixtures = all_fixtures(kite(), small_kit(3, 4));  // its back is three spacings long
  EXPECT_TRUE(std::ranges::any_of(fixtures, [](const PlanarFixture& fixture) {
    return fixture.split == model::Split::TwoTwo && fixture.pins[0].feature == 4 &&
           fixture.pins[1].feature == 4 && fixture.pins[1].hole.row - fixture.pins[0].hole.row == 3 &&
           fixture.pins[0].foot_margin_mm < 1e-9 && fixture.pins[1].foot_margin_mm < 1e-9;
  }));
}

/// A flat back along y at x = 0; on the right a dent whose two walls both push up, in which a pin of 2.4 mm
/// stands at (38, 11), and a roof that another touches from (38, 33).
model::Profile dented() {
  const Vector2d n1 = geometry::direction(-0.3);
  const Vector2d n2 = geometry::direction(-0.9);
  const Vector2d nr = geometry::direction(0.5);
  const auto along = [](const Vector2d& n) { return Vector2d(-n.y(), n.x()); };
  const Vector2d corner = Vector2d(38, 11) - 2.4 / (1 + n1.dot(n2)) * (n1 + n2);
  const Vector2d roof = Vector2d(38, 33) - 2.4 * nr;
  return polygon_profile({Vector2d(0, 0), Vector2d(20, -8), corner - 8 * along(n1), corner,
                          corner + 6 * along(n2), roof - 7 * along(nr), roof + 7 * along(nr),
                          Vector2d(0, 36)});
}

TEST(PlanarDegeneracies, a_pin_that_touches_both_walls_of_a_dent_is_listed_for_the_smaller_id_only) {
  const auto fixtures = all_fixtures(dented(), small_kit(3, 4));
  int found = 0;
  for (const PlanarFixture& fixture : fixtures) {
    const bool upright = std::abs(std::remainder(fixture.theta_rad, 2 * kPi)) < 1e-9;
    const bool both_walls =
        fixture.split == model::Split::TwoTwo && fixture.pins[3].feature == 5 &&
        (fixture.pins[2].p_PFoot_mm - 2.4 * fixture.pins[2].n_P - Vector2d(38, 11)).norm() < 1e-6;
    const bool backed = fixture.pins[0].hole.row == 0 && fixture.pins[1].hole.row == 3;  // either wall closes
    if (!upright || !both_walls || !backed) continue;
    EXPECT_EQ(fixture.pins[2].feature, 2);
    ++found;
  }
  EXPECT_EQ(found, 1);
  for (std::size_t i = 0; i < fixtures.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) EXPECT_FALSE(same_pose(fixtures[i], fixtures[k]));
  }
}

TEST(PlanarDegeneracies, no_pose_is_listed_twice) {
  for (const char* name : {"lshape", "star12", "arcs"}) {
    const KnownCase known = read_case(name);
    const auto fixtures = all_fixtures(known.profile, known.kit);
    for (std::size_t i = 0; i < fixtures.size(); ++i) {
      for (std::size_t k = 0; k < i; ++k) EXPECT_FALSE(same_pose(fixtures[i], fixtures[k]));
    }
  }
}

TEST(PlanarDegeneracies, an_edge_listed_twice_counts_for_its_smaller_id) {
  const KnownCase known = read_case("pentagon");
  auto features = model::features_of(known.profile);
  const std::size_t before = features.size();
  features.push_back(features[1]);
  features.back().id = static_cast<int>(before);
  PlanarOptions options;
  options.outline = &known.profile;
  const auto result = plan_planar_fixtures(features, known.kit, options);
  EXPECT_EQ(result.fixtures.size(), known.fixtures.size());
  for (const PlanarFixture& fixture : result.fixtures) {
    for (const PlanarPin& pin : fixture.pins) EXPECT_LT(pin.feature, static_cast<int>(before));
  }
}

TEST(PlanarDegeneracies, pins_may_stand_up_to_a_convex_corner) {
  const model::Profile part = kite();
  const auto features = model::features_of(part);
  const auto curves = planar::contact_curves(features, 2.4, &part);
  ASSERT_EQ(curves.size(), features.size());
  for (std::size_t i = 0; i < curves.size(); ++i) {
    EXPECT_NEAR(curves[i].range.length(), geometry::length_mm(features[i].curve), 1e-9);
  }
}

TEST(PlanarDegeneracies, pins_stop_where_they_touch_the_other_wall_of_a_dent) {
  const KnownCase known = read_case("lshape");
  const auto features = model::features_of(known.profile);
  const auto curves = planar::contact_curves(features, 2.4, &known.profile);
  EXPECT_NEAR(curves[2].range.length(), 23 - 2.4, 1e-5);
  EXPECT_NEAR(curves[3].range.length(), 21 - 2.4, 1e-5);
}

TEST(PlanarDegeneracies, every_root_is_exact_also_where_symmetry_makes_terms_vanish) {
  const model::Kit kit = small_kit(3, 4);
  for (const PlanarFixture& fixture : all_fixtures(kite(), kit)) {
    const PlacedFixture placed = placed_least(kit, fixture);
    for (std::size_t k = 0; k < 4; ++k) {
      const Vector2d p_GHole = model::p_GHole_mm(kit.grid, placed.holes[k], placed.jaw_separation_mm);
      const Vector2d p_GFoot = placed.part_pose * fixture.pins[k].p_PFoot_mm;
      const Vector2d n_G = placed.part_pose.turned(fixture.pins[k].n_P);
      EXPECT_LT((p_GHole + kit.pins.radius_mm * n_G - p_GFoot).norm(), 1e-9);
    }
  }
}

TEST(PlanarDegeneracies, branches_of_an_arc_meet_in_a_fold_without_a_gap) {
  const auto features = model::features_of(rounded_part());
  const auto curves = planar::contact_curves(features, 2.4, nullptr);
  planar::ContactCurve arc = curves[1];
  arc.full = true;
  planar::ContactCurve line = curves[0];
  line.range = {-1e3, 1e3};
  line.ends_mm = {planar::centre_at(line, -1e3), planar::centre_at(line, 1e3)};
  const planar::Pair pair{&line, &arc, Vector2d(0, 33)};
  double from[2] = {10, 10};
  double to[2] = {-10, -10};
  for (const planar::Stretch& stretch : planar::stretches(pair)) {
    from[stretch.branch] = std::min(from[stretch.branch], stretch.theta_rad.lo);
    to[stretch.branch] = std::max(to[stretch.branch], stretch.theta_rad.hi);
    const auto lo = planar::state_at(pair, stretch.theta_rad.lo, stretch.branch);
    const auto hi = planar::state_at(pair, stretch.theta_rad.hi, stretch.branch);
    EXPECT_TRUE(lo && hi);
  }
  EXPECT_TRUE(from[0] < to[0] || from[1] < to[1]);
}

/// A boss and a flat on the left, their offsets flush; a roof on the right whose tip is `off_mm` above half a
/// row, so that the lower left pin stands as much beside the boss's outermost point.
model::Profile boss_and_flat(double off_mm) {
  std::vector<model::ProfileEdge> loop = polygon(
      {Vector2d(0, -6), Vector2d(24, -12 + off_mm), Vector2d(42, 5.5 + off_mm), Vector2d(24, 23 + off_mm),
       Vector2d(-6, 30), Vector2d(-6, 9), 6 * geometry::direction(2 * kPi / 3)});
  loop.back().curve = Arc{Vector2d(0, 0), 6, 2 * kPi / 3, 5 * kPi / 6};
  return profile_of_loop(loop);
}

TEST(PlanarDegeneracies, a_fixture_is_not_lost_where_it_passes_a_fold) {
  for (const double off_mm : {-0.5, -0.02, -1e-3, -1e-5, -1e-7, 0.0, 1e-9, 1e-7, 1e-5, 1e-3, 0.02, 0.5}) {
    const auto fixtures = all_fixtures(boss_and_flat(off_mm), small_kit(2, 3));
    const auto held = std::ranges::count_if(fixtures, [](const PlanarFixture& fixture) {
      const auto& pins = fixture.pins;
      return fixture.split == model::Split::TwoTwo && pins[0].feature == 6 && pins[1].feature == 4 &&
             pins[2].feature == 1 && pins[3].feature == 2 && pins[0].hole.row == 0 && pins[1].hole.row == 1 &&
             pins[0].hole.column == pins[1].hole.column && pins[2].hole.row == 0 && pins[3].hole.row == 1 &&
             pins[2].hole.column == pins[3].hole.column && std::cos(fixture.theta_rad) > 0.9;
    });
    EXPECT_EQ(held, 1) << off_mm;
  }
}

/// Two equal bosses one hole apart on the left, a roof on the right.
model::Profile two_bosses(double roof_mm) {
  std::vector<model::ProfileEdge> loop(6);
  loop[0].curve = Arc{Vector2d(0, 11), 5.5, kPi / 2, kPi};
  loop[1].curve = Arc{Vector2d(0, 0), 5.5, kPi / 2, kPi};
  loop[2].curve = Segment{Vector2d(0, -5.5), Vector2d(12, -9)};
  loop[3].curve = Segment{Vector2d(12, -9), Vector2d(34, roof_mm)};
  loop[4].curve = Segment{Vector2d(34, roof_mm), Vector2d(12, 20)};
  loop[5].curve = Segment{Vector2d(12, 20), Vector2d(0, 16.5)};
  return profile_of_loop(loop);
}

TEST(PlanarDegeneracies, equal_bosses_one_hole_apart_are_held_where_their_circles_coincide) {
  for (const double roof_mm : {5.5, 6.25, 4.0}) {
    const model::Profile part = two_bosses(roof_mm);
    const auto fixtures = all_fixtures(part, small_kit(3, 5));
    const bool found = std::ranges::any_of(fixtures, [](const PlanarFixture& fixture) {
      return fixture.split == model::Split::TwoTwo &&
             std::min(fixture.theta_rad, 2 * kPi - fixture.theta_rad) < 1e-9 &&
             fixture.pins[0].feature == 1 && fixture.pins[1].feature == 0;
    });
    EXPECT_TRUE(found) << roof_mm;
  }
}

TEST(PlanarDegeneracies, pins_never_overlap) {
  model::Kit kit = small_kit(3, 6);
  kit.grid.spacing_mm = 4;  // neighbours would overlap: 2 r is 4.8
  kit.grid.edge_offset_mm = 0.5;
  const auto fixtures = all_fixtures(scaled(kite(), 0.4), kit);
  EXPECT_FALSE(fixtures.empty());
  for (const PlanarFixture& fixture : fixtures) {
    const PlacedFixture placed = placed_least(kit, fixture);
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t k = 0; k < i; ++k) {
        const Vector2d a = model::p_GHole_mm(kit.grid, placed.holes[i], placed.jaw_separation_mm);
        const Vector2d b = model::p_GHole_mm(kit.grid, placed.holes[k], placed.jaw_separation_mm);
        EXPECT_GE((a - b).norm(), 2 * kit.pins.radius_mm - 1e-8);
      }
    }
  }
}

TEST(PlanarDegeneracies, a_separation_exactly_at_the_limit_is_in_range) {
  model::Kit kit = small_kit(3, 4);
  const auto fixtures = all_fixtures(kite(), kit);
  ASSERT_FALSE(fixtures.empty());
  const double s_mm = column_shifts(kit, fixtures.front()).front().jaw_separation_mm;
  kit.jaws.separation_mm = {s_mm, s_mm};
  const auto kept = all_fixtures(kite(), kit);
  EXPECT_TRUE(
      std::ranges::any_of(kept, [&](const PlanarFixture& one) { return same_pose(one, fixtures.front()); }));
  for (const PlanarFixture& fixture : kept) EXPECT_FALSE(column_shifts(kit, fixture).empty());
}

TEST(PlanarDegeneracies, the_pins_of_a_fixture_are_a_set_told_from_the_least_hole) {
  for (const PlanarFixture& fixture : all_fixtures(rounded_part(), small_kit(3, 5))) {
    int least_row = 99;
    int least_column[2] = {99, 99};
    for (std::size_t k = 0; k < 4; ++k) {
      const model::Hole& hole = fixture.pins[k].hole;
      EXPECT_TRUE(k == 0 || fixture.pins[k - 1].hole < hole);
      int& column = least_column[hole.jaw == model::JawSide::Left ? 0 : 1];
      column = std::min(column, hole.column);
      least_row = std::min(least_row, hole.row);
    }
    EXPECT_EQ(least_row, 0);
    EXPECT_EQ(least_column[0], 0);
    EXPECT_EQ(least_column[1], 0);
  }
}

TEST(PlanarDegeneracies, a_part_of_threefold_symmetry_lists_each_fixture_three_times) {
  std::vector<Vector2d> points;
  for (int i = 0; i < 6; ++i)
    points.push_back((i % 2 == 0 ? 24.0 : 15.0) * geometry::direction(i * kPi / 3 + 0.1));
  const auto fixtures = all_fixtures(polygon_profile(points), small_kit(3, 4));
  EXPECT_GT(fixtures.size(), 0U);
  EXPECT_EQ(fixtures.size() % 3, 0U);
}

TEST(PlanarDegeneracies, a_bore_no_wider_than_the_pin_offers_no_contact) {
  model::Profile part = kite();
  model::ProfileEdge bore;
  bore.curve = Arc{Vector2d(18, 16), 2.4, 0, 2 * kPi};
  bore.reversed = true;
  part.loops.push_back({bore});
  EXPECT_EQ(all_fixtures(part, small_kit(3, 4)).size(), all_fixtures(kite(), small_kit(3, 4)).size());
}

}  // namespace
}  // namespace pinjaw::planner
