#include "host/geometry/chain_fit.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "host/base/random.hpp"

namespace pinjaw::geometry {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr FitLimits kLimits{.tolerance_mm = 1e-3, .most_sagitta_mm = 0.2};

using Chain = std::vector<Vector2d>;

void add(Chain& chain, const Vector2d& p_mm) {
  if (chain.empty() || (chain.back() - p_mm).norm() > 1e-12) chain.push_back(p_mm);
}

void add_segment(Chain& chain, const Segment& segment, int chords) {
  for (int i = 0; i <= chords; ++i) {
    add(chain, segment.a_mm + (segment.b_mm - segment.a_mm) * i / chords);
  }
}

void add_arc(Chain& chain, const Arc& arc, int chords, bool clockwise = false) {
  for (int i = 0; i <= chords; ++i) {
    const double part = static_cast<double>(clockwise ? chords - i : i) / chords;
    add(chain, arc.center_mm + arc.radius_mm * direction(arc.from_rad + part * arc.sweep_rad));
  }
}

/// A plate 40 x 20 with corners of radius 5, a bite of radius 4 out of its upper side, counter-clockwise.
Chain plate() {
  Chain chain;
  add_segment(chain, {{5, 0}, {35, 0}}, 7);
  add_arc(chain, {{35, 5}, 5, -kPi / 2, kPi / 2}, 8);
  add_segment(chain, {{40, 5}, {40, 15}}, 1);
  add_arc(chain, {{35, 15}, 5, 0, kPi / 2}, 6);
  add_segment(chain, {{35, 20}, {24, 20}}, 3);
  add_arc(chain, {{20, 20}, 4, kPi, kPi}, 12, true);
  add_segment(chain, {{16, 20}, {5, 20}}, 1);
  add_arc(chain, {{5, 15}, 5, kPi / 2, kPi / 2}, 7);
  add_segment(chain, {{0, 15}, {0, 5}}, 2);
  add_arc(chain, {{5, 5}, 5, kPi, kPi / 2}, 5);
  chain.pop_back();
  return chain;
}
constexpr std::size_t kPlatePieces = 10;

double distance_mm(const Curve& curve, const Vector2d& p_mm) {
  if (const auto* segment = std::get_if<Segment>(&curve)) {
    const Vector2d along = segment->b_mm - segment->a_mm;
    const double t = std::clamp(along.dot(p_mm - segment->a_mm) / along.squaredNorm(), 0.0, 1.0);
    return (p_mm - segment->a_mm - t * along).norm();
  }
  const auto& arc = std::get<Arc>(curve);
  const Vector2d spoke = p_mm - arc.center_mm;
  const double along_rad = wrapped_rad(std::atan2(spoke.y(), spoke.x()) - arc.from_rad + 1e-7);
  if (along_rad <= arc.sweep_rad + 2e-7) return std::abs(spoke.norm() - arc.radius_mm);
  return std::min((p_mm - point_at(curve, 0)).norm(), (p_mm - point_at(curve, length_mm(curve))).norm());
}

std::size_t run_length(const FittedPiece& piece, std::size_t points) {
  return piece.last > piece.first ? piece.last - piece.first : piece.last + points - piece.first;
}

/// Runs follow each other around the whole chain; every point and chord is as near as its piece states.
void expect_true(const std::vector<FittedPiece>& pieces, const Chain& chain, bool closed) {
  std::size_t covered = 0;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const FittedPiece& piece = pieces[i];
    if (i > 0) {
      EXPECT_EQ(piece.first, pieces[i - 1].last);
    }
    covered += run_length(piece, chain.size());
    for (std::size_t k = 0; k <= run_length(piece, chain.size()); ++k) {
      const Vector2d& p_mm = chain[(piece.first + k) % chain.size()];
      EXPECT_LE(distance_mm(piece.curve, p_mm), piece.error_mm + 1e-9) << "piece " << i << " point " << k;
      if (k == 0) continue;
      const Vector2d middle_mm = (p_mm + chain[(piece.first + k - 1) % chain.size()]) / 2;
      EXPECT_LE(distance_mm(piece.curve, middle_mm), std::max(piece.sagitta_mm, piece.error_mm) + 1e-9)
          << "piece " << i << " chord " << k;
    }
  }
  EXPECT_EQ(covered, closed ? chain.size() : chain.size() - 1);
}

/// Curves as sets of points: ends of segments in either order, arcs by their middles.
bool same(const Curve& a, const Curve& b, double within_mm) {
  if (a.index() != b.index()) return false;
  const auto end = [](const Curve& curve, double part) { return point_at(curve, part * length_mm(curve)); };
  const bool forwards =
      (end(a, 0) - end(b, 0)).norm() < within_mm && (end(a, 1) - end(b, 1)).norm() < within_mm;
  const bool backwards =
      (end(a, 0) - end(b, 1)).norm() < within_mm && (end(a, 1) - end(b, 0)).norm() < within_mm;
  return (forwards || backwards) && (end(a, 0.5) - end(b, 0.5)).norm() < within_mm;
}

void expect_same(const std::vector<FittedPiece>& pieces, const std::vector<Curve>& curves, double within_mm) {
  EXPECT_EQ(pieces.size(), curves.size());
  for (const Curve& curve : curves) {
    const auto matches = std::ranges::count_if(
        pieces, [&](const FittedPiece& piece) { return same(piece.curve, curve, within_mm); });
    EXPECT_EQ(matches, 1) << "at " << point_at(curve, length_mm(curve) / 2).transpose();
  }
}

std::vector<Curve> curves_of(const std::vector<FittedPiece>& pieces,
                             const std::function<Curve(const Curve&)>& map) {
  std::vector<Curve> curves;
  for (const FittedPiece& piece : pieces) curves.push_back(map(piece.curve));
  return curves;
}

Curve mapped(const Curve& curve, const std::function<Vector2d(const Vector2d&)>& map, bool mirrors) {
  if (const auto* segment = std::get_if<Segment>(&curve))
    return Segment{map(segment->a_mm), map(segment->b_mm)};
  Arc arc = std::get<Arc>(curve);
  const Vector2d start_mm = map(point_at(curve, mirrors ? length_mm(curve) : 0));
  arc.center_mm = map(arc.center_mm);
  arc.from_rad = std::atan2((start_mm - arc.center_mm).y(), (start_mm - arc.center_mm).x());
  return arc;
}

TEST(ChainFit, finds_each_segment_and_arc_that_a_chain_was_drawn_with) {
  const Chain chain = plate();
  const auto pieces = fitted_pieces(chain, true, kLimits);
  expect_true(pieces, chain, true);
  expect_same(pieces,
              {Segment{{5, 0}, {35, 0}}, Arc{{35, 5}, 5, -kPi / 2, kPi / 2}, Segment{{40, 5}, {40, 15}},
               Arc{{35, 15}, 5, 0, kPi / 2}, Segment{{35, 20}, {24, 20}}, Arc{{20, 20}, 4, kPi, kPi},
               Segment{{16, 20}, {5, 20}}, Arc{{5, 15}, 5, kPi / 2, kPi / 2}, Segment{{0, 15}, {0, 5}},
               Arc{{5, 5}, 5, kPi, kPi / 2}},
              1e-6);
  EXPECT_EQ(std::ranges::count_if(pieces, &FittedPiece::clockwise), 1);
}

TEST(ChainFit, makes_one_arc_of_a_circle_with_its_sagitta_stated) {
  Chain chain;
  add_arc(chain, {{3, -7}, 12, 1, 2 * kPi}, 20);
  chain.pop_back();
  for (const bool backwards : {false, true}) {
    if (backwards) std::ranges::reverse(chain);
    const auto pieces = fitted_pieces(chain, true, kLimits);
    ASSERT_EQ(pieces.size(), 1U);
    const auto& arc = std::get<Arc>(pieces[0].curve);
    EXPECT_EQ(arc.sweep_rad, 2 * kPi);
    EXPECT_NEAR(arc.radius_mm, 12, 1e-9);
    EXPECT_LT((arc.center_mm - Vector2d(3, -7)).norm(), 1e-9);
    EXPECT_EQ(pieces[0].clockwise, backwards);
    EXPECT_NEAR(pieces[0].sagitta_mm, 12 * (1 - std::cos(kPi / 20)), 1e-9);
    expect_true(pieces, chain, true);
  }
}

TEST(ChainFit, leaves_polygons_alone_though_their_corners_lie_on_circles) {
  for (const int corners : {3, 4, 6, 8, 10}) {
    Chain chain;
    add_arc(chain, {{0, 0}, 10, 0.2, 2 * kPi}, corners);
    chain.pop_back();
    EXPECT_EQ(fitted_pieces(chain, true, kLimits).size(), static_cast<std::size_t>(corners));
  }
  const Chain chamfered{{0, 0}, {10, 0}, {13, 3}, {13, 13}};  // concyclic, as any symmetric chamfer
  EXPECT_EQ(fitted_pieces(chamfered, false, kLimits).size(), 3U);
}

TEST(ChainFit, prefers_a_line_where_both_fit) {
  Chain chain;
  add_arc(chain, {{0, 0}, 4000, 0, 1e-3}, 8);  // bulges by half a micrometre
  const auto pieces = fitted_pieces(chain, false, kLimits);
  ASSERT_EQ(pieces.size(), 1U);
  EXPECT_TRUE(std::holds_alternative<Segment>(pieces[0].curve));
  const auto strict = fitted_pieces(chain, false, {.tolerance_mm = 1e-5, .most_sagitta_mm = 0.2});
  ASSERT_EQ(strict.size(), 1U);
  EXPECT_TRUE(std::holds_alternative<Arc>(strict[0].curve));
}

TEST(ChainFit, joins_a_line_cut_into_many_points) {
  Chain chain;
  base::Random random(3);
  for (double x_mm = 0; x_mm < 50; x_mm += random.uniform(1e-4, 1)) chain.emplace_back(x_mm, 0.25 * x_mm);
  const auto pieces = fitted_pieces(chain, false, kLimits);
  ASSERT_EQ(pieces.size(), 1U);
  expect_true(pieces, chain, false);
}

TEST(ChainFit, passes_over_repeated_points) {
  Chain chain;
  for (const Vector2d& p_mm : plate()) chain.insert(chain.end(), 3, p_mm);
  const auto pieces = fitted_pieces(chain, true, kLimits);
  EXPECT_EQ(pieces.size(), kPlatePieces);
  for (const FittedPiece& piece : pieces) EXPECT_LT(piece.error_mm, 1e-9);
}

TEST(ChainFit, makes_nothing_of_less_than_two_points) {
  EXPECT_TRUE(fitted_pieces(Chain{}, true, kLimits).empty());
  EXPECT_TRUE(fitted_pieces(Chain{{1, 2}}, true, kLimits).empty());
  EXPECT_TRUE(fitted_pieces(Chain(5, Vector2d(1, 2)), false, kLimits).empty());
  EXPECT_EQ(fitted_pieces(Chain{{1, 2}, {2, 2}}, false, kLimits).size(), 1U);
}

TEST(ChainFit, sees_the_curves_through_the_noise_of_single_precision) {
  const Vector2d far_mm(250, -180);
  Chain chain = plate();
  for (Vector2d& p_mm : chain) p_mm = (p_mm + far_mm).cast<float>().cast<double>();
  const auto pieces = fitted_pieces(chain, true, kLimits);
  expect_true(pieces, chain, true);
  const auto exact = fitted_pieces(plate(), true, kLimits);
  expect_same(pieces,
              curves_of(exact,
                        [&](const Curve& c) {
                          return mapped(
                              c, [&](const Vector2d& p) -> Vector2d { return p + far_mm; }, false);
                        }),
              1e-4);
}

TEST(ChainFit, does_not_depend_on_where_a_closed_chain_begins) {
  const auto curves = curves_of(fitted_pieces(plate(), true, kLimits), std::identity{});
  for (std::size_t start = 1; start < plate().size(); ++start) {
    Chain chain = plate();
    std::ranges::rotate(chain, chain.begin() + static_cast<std::ptrdiff_t>(start));
    const auto pieces = fitted_pieces(chain, true, kLimits);
    expect_same(pieces, curves, 1e-9);
    expect_true(pieces, chain, true);
  }
}

class Motion : public ::testing::TestWithParam<bool> {};

TEST_P(Motion, and_mirror_and_reversal_carry_the_pieces_along) {
  const bool mirrors = GetParam();
  const Pose2 pose{0.77, {12, -5}};
  const auto map = [&](const Vector2d& p) { return pose * Vector2d(mirrors ? -p.x() : p.x(), p.y()); };
  const auto moved_curves = curves_of(fitted_pieces(plate(), true, kLimits),
                                      [&](const Curve& c) { return mapped(c, map, mirrors); });
  Chain chain = plate();
  for (Vector2d& p_mm : chain) p_mm = map(p_mm);
  expect_same(fitted_pieces(chain, true, kLimits), moved_curves, 1e-6);
  std::ranges::reverse(chain);
  const auto backwards = fitted_pieces(chain, true, kLimits);
  expect_same(backwards, moved_curves, 1e-6);
  EXPECT_EQ(std::ranges::count_if(backwards, &FittedPiece::clockwise), mirrors ? 1 : 4);
}

INSTANTIATE_TEST_SUITE_P(Plane, Motion, ::testing::Bool());

/// Random tangent and cornered runs of segments and arcs, each with its own chording.
TEST(ChainFit, finds_random_chains_again_from_both_ends) {
  base::Random random(11);
  for (int round = 0; round < 200; ++round) {
    Chain chain;
    std::vector<Curve> drawn;
    Vector2d at_mm(random.uniform(-50, 50), random.uniform(-50, 50));
    double heading_rad = random.uniform(0, 2 * kPi);
    for (int i = 0; i < 8; ++i) {
      const bool tangent = i % 2 == 1 && random.uniform() < 0.5;
      if (!tangent) heading_rad += random.uniform(0.7, 1.5);
      if (i % 2 == 0) {
        const Segment segment{at_mm, at_mm + random.uniform(3, 20) * direction(heading_rad)};
        add_segment(chain, segment, 1 + static_cast<int>(random.bits() % 4));
        drawn.emplace_back(segment);
        at_mm = segment.b_mm;
        continue;
      }
      const bool clockwise = random.uniform() < 0.5;
      const double turn = clockwise ? -1 : 1;
      const double radius_mm = random.uniform(2, 30);
      const double sweep_rad = random.uniform(0.5, 3);
      const Vector2d center_mm = at_mm + turn * radius_mm * direction(heading_rad + kPi / 2);
      const double here_rad = heading_rad - turn * kPi / 2;
      const Arc arc{center_mm, radius_mm, clockwise ? here_rad - sweep_rad : here_rad, sweep_rad};
      add_arc(chain, arc, std::max(4, static_cast<int>(sweep_rad / 0.15)), clockwise);
      drawn.emplace_back(arc);
      heading_rad += turn * sweep_rad;
      at_mm = chain.back();
    }
    const auto pieces = fitted_pieces(chain, false, kLimits);
    expect_true(pieces, chain, false);
    expect_same(pieces, drawn, 1e-6);
    std::ranges::reverse(chain);
    expect_same(fitted_pieces(chain, false, kLimits), drawn, 1e-6);
    if (HasFailure()) FAIL() << "in round " << round;
  }
}

TEST(ChainFit, covers_any_chain_though_its_noise_is_as_large_as_the_tolerance) {
  base::Random random(17);
  for (int round = 0; round < 2000; ++round) {
    Chain chain;
    const double ripple_mm = random.uniform(0, 3e-3);
    const auto count = 3 + random.bits() % 40;
    for (std::uint64_t i = 0; i < count; ++i) {
      const double t_rad = 0.15 * static_cast<double>(i);
      chain.emplace_back(8 * std::cos(t_rad) + random.uniform(-ripple_mm, ripple_mm),
                         5 * std::sin(t_rad) + random.uniform(-ripple_mm, ripple_mm));
    }
    const bool closed = round % 2 == 0;
    expect_true(fitted_pieces(chain, closed, kLimits), chain, closed);
    if (HasFailure()) FAIL() << "in round " << round;
  }
}

TEST(ChainFit, follows_a_freeform_chain_within_its_tolerance_with_few_arcs) {
  Chain chain;
  for (int i = 0; i <= 400; ++i) {
    const double t_rad = 2 * kPi * i / 400;
    chain.emplace_back(30 * std::cos(t_rad), 18 * std::sin(t_rad));  // an ellipse
  }
  chain.pop_back();
  const auto pieces = fitted_pieces(chain, true, {.tolerance_mm = 5e-3, .most_sagitta_mm = 5e-3 + 0.01});
  expect_true(pieces, chain, true);
  EXPECT_LT(pieces.size(), 40U);
  for (const FittedPiece& piece : pieces) EXPECT_LE(piece.error_mm, 5e-3);
}

}  // namespace
}  // namespace pinjaw::geometry
