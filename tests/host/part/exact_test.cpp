#include "host/part/exact.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <numbers>

#include "host/base/random.hpp"
#include "tests/host/part/shipped_parts.hpp"

namespace pinjaw::part {
namespace {

using geometry::Rectangle;
using geometry::Sweep;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kExact_mm = 1e-6;

model::PartSource profile_source(const model::Profile& profile, const Vector3d& up = Vector3d::UnitZ()) {
  model::PartSource source;
  source.file = std::filesystem::path(testing::TempDir()) / (profile.name + ".yaml");
  std::ofstream(source.file) << "profile: " << profile.name << "\n";
  source.density_g_cm3 = 1;
  source.profile = profile;
  source.up = up;
  return source;
}

/// A block from the origin to (40, 20, 10).
model::PartSource block() {
  using geometry::Segment;
  model::Profile profile{.name = "block", .thickness_mm = 10, .loops = {}};
  profile.loops.push_back({{.curve = Segment{{0, 0}, {40, 0}}},
                           {.curve = Segment{{40, 0}, {40, 20}}},
                           {.curve = Segment{{40, 20}, {0, 20}}},
                           {.curve = Segment{{0, 20}, {0, 0}}}});
  return profile_source(profile);
}

/// A round bar of radius 8 along x, its axis at z = 0: a disc whose +x stands upright.
model::PartSource lying_bar() {
  model::Profile profile{.name = "bar", .thickness_mm = 30, .loops = {}};
  profile.loops.push_back({{.curve = geometry::Arc{{0, 0}, 8, 0, 2 * std::numbers::pi}}});
  return profile_source(profile, Vector3d::UnitX());
}

Column disc(double x_mm, double y_mm, double radius_mm, const geometry::Slab& slab = {}) {
  return {Sweep{{x_mm, y_mm}, {x_mm, y_mm}, radius_mm}, slab};
}

double answer(const ExactBody& body, const ExactQuestion& question) {
  const auto answers = ask_exactly({body}, {question});
  EXPECT_TRUE(answers) << answers.error().message;
  return answers ? answers->mm.front() : std::nan("");
}

TEST(Exact, a_column_beside_a_block_is_as_far_as_its_side) {
  EXPECT_NEAR(answer({block()}, ExactDistance{0, disc(-5, 10, 2)}), 3, kExact_mm);
  EXPECT_NEAR(answer({block()}, ExactDistance{0, disc(-3, -4, 2)}), 3, kExact_mm) << "to the upright edge";
  EXPECT_NEAR(answer({block()}, ExactDistance{0, disc(-3, 10, 2, {.lo_mm = 14, .hi_mm = 20})}),
              std::hypot(1, 4), kExact_mm);
  EXPECT_NEAR(answer({block()}, ExactDistance{0, {Sweep{{-5, -9}, {45, -9}, 2}, {}}}), 7, kExact_mm);
  const Rectangle leaning{{-10, 10}, Vector2d(3, 4) / 5, {2, 1}};
  EXPECT_NEAR(answer({block()}, ExactDistance{0, {leaning, {}}}), 10 - (2 * 0.6 + 1 * 0.8), kExact_mm);
}

TEST(Exact, what_meets_a_block_is_told_by_how_much_it_must_shrink) {
  EXPECT_NEAR(answer({block()}, ExactDistance{0, disc(-1.97, 10, 2)}), -0.03, 2 * kHeightStep_mm);
  EXPECT_NEAR(answer({block()}, ExactDistance{0, disc(20, 10, 2, {.hi_mm = 0.3})}), -0.3, 2 * kHeightStep_mm)
      << "from below, its top alone is in it";
  EXPECT_NEAR(answer({block()}, ExactDistance{0, disc(20, 10, 2)}), -2, 1e-3) << "no thinner column is clear";
  EXPECT_NEAR(answer({block()}, ExactDistance{0, disc(20, 10, 2, {.lo_mm = -3, .hi_mm = 7})}), -2, 1e-3)
      << "shrunk until it lies in the material it is not clear of it";
  EXPECT_EQ(answer({block()}, ExactDistance{0, disc(-2, 10, 2)}), 0) << "a touch";
  EXPECT_EQ(answer({block()}, ExactDistance{0, disc(20, 10, 0)}), 0) << "a line";
}

TEST(Exact, what_lies_in_the_material_is_as_deep_as_the_nearest_face) {
  EXPECT_NEAR(answer({block()}, ExactDistance{0, disc(20, 10, 1, {.lo_mm = 4, .hi_mm = 7})}), -3, kExact_mm);
}

TEST(Exact, heights_of_a_lying_bar_are_those_of_its_circle_whatever_the_guess) {
  for (const double guess_mm : {-8.0, -7.9, 3.0, kInfinity}) {
    const auto lowest = [&](const Column& column) {
      return answer({lying_bar()}, ExactHeight{0, column, End::Lowest, guess_mm});
    };
    EXPECT_NEAR(lowest(disc(0, 0, 3)), -8, kHeightStep_mm);
    EXPECT_NEAR(lowest(disc(0, 9, 3)), -std::sqrt(64 - 36), kHeightStep_mm);
    EXPECT_NEAR(lowest(disc(0, 5, 0)), -std::sqrt(64 - 25), kHeightStep_mm);
    EXPECT_EQ(lowest(disc(0, 12, 3)), kInfinity);
  }
  EXPECT_NEAR(answer({lying_bar()}, ExactHeight{0, disc(0, 9, 3, {.hi_mm = 1}), End::Highest, -2}), 1,
              kHeightStep_mm)
      << "cut by the slab";
  EXPECT_NEAR(answer({lying_bar()}, ExactHeight{0, disc(0, 9, 3), End::Highest, -kInfinity}),
              std::sqrt(64 - 36), kHeightStep_mm);
}

TEST(Exact, a_bodys_pose_moves_it) {
  ExactBody body{block()};
  body.X_QB.translate(Vector3d(100, 0, 5));
  body.X_QB.rotate(Eigen::AngleAxisd(std::numbers::pi / 2, Vector3d::UnitZ()));
  EXPECT_NEAR(answer(body, ExactDistance{0, disc(103, 20, 1)}), 2, kExact_mm);
  EXPECT_NEAR(answer(body, ExactHeight{0, disc(90, 20, 1), End::Lowest, 0}), 5, kHeightStep_mm);
}

TEST(Exact, agrees_with_the_triangles_of_a_machined_part_within_their_chord) {
  const Part& valve = shipped_part("valve_housing");
  const auto& [lo, hi] = std::pair(valve.surface.x_range_mm(), valve.surface.y_range_mm());
  base::Random random(7);
  std::vector<ExactQuestion> questions;
  std::vector<double> mesh_mm;
  for (int i = 0; i < 12; ++i) {
    const Vector2d p_mm(lo.lo + random.uniform() * lo.length(), hi.lo + random.uniform() * hi.length());
    questions.emplace_back(ExactHeight{0, disc(p_mm.x(), p_mm.y(), 2.4), End::Lowest, 0});
    mesh_mm.push_back(valve.surface.lowest_z_mm(Sweep{p_mm, p_mm, 2.4}));
  }
  const auto answers = ask_exactly({ExactBody{source_of(shipped("valve_housing"))}}, questions);
  ASSERT_TRUE(answers) << answers.error().message;
  for (std::size_t i = 0; i < mesh_mm.size(); ++i) EXPECT_NEAR(answers->mm[i], mesh_mm[i], 0.02) << i;
  EXPECT_LT(answers->tolerance_mm.front(), 1e-3);
}

TEST(Exact, a_mesh_has_no_faces_to_ask) {
  const auto answers = ask_exactly({ExactBody{source_of(test::source_dir("configs/parts/l_bracket.stl"))}},
                                   {ExactDistance{0, disc(0, 0, 1)}});
  ASSERT_FALSE(answers);
  EXPECT_THAT(answers.error().message, testing::EndsWith("l_bracket.stl: a mesh has no exact faces"));
  EXPECT_FALSE(has_brep(source_of("a.STL")));
  EXPECT_TRUE(has_brep(block()));
}

}  // namespace
}  // namespace pinjaw::part
