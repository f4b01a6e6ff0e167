#include "host/planner/force/worst_spray.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/base/random.hpp"
#include "host/planner/force/source_loads.hpp"
#include "tests/host/planner/force/peers.hpp"

namespace pinjaw::planner {
namespace {

using geometry::Surface;
using geometry::TriangleMesh;

constexpr double kJet_n = 8.4;

/// A box between two corners, outward; `inward` turns it inside out: a void.
void add_box(TriangleMesh& mesh, const Vector3d& lo, const Vector3d& hi, bool inward = false) {
  const int first = static_cast<int>(mesh.vertices_mm.size());
  for (int i = 0; i < 8; ++i) {
    mesh.vertices_mm.emplace_back((i & 1) != 0 ? hi.x() : lo.x(), (i & 2) != 0 ? hi.y() : lo.y(),
                                  (i & 4) != 0 ? hi.z() : lo.z());
  }
  const std::array<std::array<int, 3>, 12> corners = {{{0, 2, 3},
                                                       {0, 3, 1},
                                                       {4, 5, 7},
                                                       {4, 7, 6},
                                                       {0, 1, 5},
                                                       {0, 5, 4},
                                                       {2, 6, 7},
                                                       {2, 7, 3},
                                                       {0, 4, 6},
                                                       {0, 6, 2},
                                                       {1, 3, 7},
                                                       {1, 7, 5}}};
  for (auto [a, b, c] : corners) {
    if (inward) std::swap(b, c);
    mesh.triangles.push_back({first + a, first + b, first + c});
    mesh.face_of.push_back(static_cast<int>(mesh.face_of.size()) / 2);
  }
}

Surface box(const Vector3d& lo, const Vector3d& hi) {
  TriangleMesh mesh;
  add_box(mesh, lo, hi);
  return Surface(std::move(mesh));
}

/// An upright cylinder about the origin's z, `sides` facets round, with the true normals at its nodes.
Surface cylinder(double radius_mm, double height_mm, int sides) {
  TriangleMesh mesh;
  const auto node = [&](const Vector3d& p, const Vector3d& normal) {
    mesh.vertices_mm.push_back(p);
    mesh.normals.push_back(normal);
    return static_cast<int>(mesh.vertices_mm.size()) - 1;
  };
  const auto triangle = [&](int a, int b, int c, int face) {
    mesh.triangles.push_back({a, b, c});
    mesh.face_of.push_back(face);
  };
  for (int i = 0; i < sides; ++i) {
    const auto at = [&](int k, double z) {
      const double angle_rad = 2 * std::numbers::pi * k / sides;
      return Vector3d(radius_mm * std::cos(angle_rad), radius_mm * std::sin(angle_rad), z);
    };
    const auto out = [&](int k) { return Vector3d(at(k, 0).normalized()); };
    const int a = node(at(i, 0), out(i));
    const int b = node(at(i + 1, 0), out(i + 1));
    const int c = node(at(i + 1, height_mm), out(i + 1));
    const int d = node(at(i, height_mm), out(i));
    triangle(a, b, c, 0);
    triangle(a, c, d, 0);
    for (const int end : {0, 1}) {
      const double z = end * height_mm;
      const Vector3d normal(0, 0, end == 0 ? -1 : 1);
      const int middle = node({0, 0, z}, normal);
      const int one = node(at(i, z), normal);
      const int other = node(at(i + 1, z), normal);
      triangle(middle, end == 0 ? other : one, end == 0 ? one : other, 1 + end);
    }
  }
  return Surface(std::move(mesh));
}

/// Two pins a side of a 40 x 20 x 10 block, each touching at two heights.
Grasp grasp(double mu = 0.2) {
  Grasp result;
  result.mu = mu;
  const auto pin = [&](int number, const Vector2d& p_mm, const Vector2d& normal, model::JawSide jaw) {
    for (const double z : {1.0, 6.0})
      result.contacts.push_back({{p_mm.x(), p_mm.y(), z}, normal.normalized(), jaw, number});
  };
  pin(0, {0, 4}, {1, 0.2}, model::JawSide::Left);
  pin(1, {0, 16}, {1, -0.3}, model::JawSide::Left);
  pin(2, {40, 6}, {-1, 0.3}, model::JawSide::Right);
  pin(3, {40, 15}, {-1, -0.2}, model::JawSide::Right);
  return result;
}

Jet jet(std::optional<Vector3d> from = {}, double within_rad = 0) {
  Jet result;
  result.name = "spray";
  result.spray.force_n = kJet_n;
  result.spray.count = 1;
  result.spray.from = std::move(from);
  if (result.spray.from) result.spray.within_rad = within_rad;
  result.with = {{"", force_at({20, 10, 5}, {0, 0, -2})}};
  return result;
}

model::Certified worst(const Surface& surface, const Jet& jet, double chord_error_mm = 0,
                       const WorstOptions& options = {}) {
  WorstSpray search({&surface, chord_error_mm}, {jet}, options);
  return search.of(grasp(), model::Side::Below, model::FrictionModel::Pyramid).value();
}

double tolerance_n(const model::Certified& found) {
  const WorstOptions options;
  return std::max(options.tolerance_n, options.tolerance_share * found.low_n);
}

/// The most that any of `count` sampled sprays needs.
double sampled_n(const Surface& surface, Jet jet, int count, std::uint64_t seed) {
  jet.spray.count = count;
  jet.spray.seed = seed;
  SqueezeSolver solver(grasp());
  double worst_n = 0;
  const std::vector<SprayHit> hits = spray_hits(jet.spray, surface).value();
  for (const SprayHit& hit : hits) {
    worst_n = std::max(worst_n, jet_need(solver, jet, hit.p_mm, -hit.force_n / kJet_n, model::Side::Below,
                                         model::FrictionModel::Pyramid)
                                    .force_n);
  }
  return worst_n;
}

TEST(WorstSpray, of_a_box_is_at_the_corner_that_another_solver_finds_worst) {
  const Surface block = box({0, 0, 0}, {40, 20, 10});
  const Jet spray = jet();
  double corner_n = 0;
  for (int i = 0; i < 8; ++i) {
    const Vector3d p_mm((i & 1) != 0 ? 40 : 0, (i & 2) != 0 ? 20 : 0, (i & 4) != 0 ? 10 : 0);
    for (int axis = 0; axis < 3; ++axis) {
      const Vector3d normal = ((i >> axis) & 1) != 0 ? Vector3d::Unit(axis) : Vector3d(-Vector3d::Unit(axis));
      const auto peer = peers::glpk(grasp(), spray.with[0].wrench + force_at(p_mm, -kJet_n * normal));
      ASSERT_EQ(peer.status, peers::Status::Optimal);
      corner_n = std::max(corner_n, peer.value);
    }
  }
  const model::Certified found = worst(block, spray);
  EXPECT_NEAR(found.high_n, corner_n, 1e-6);
  EXPECT_LE(found.low_n, corner_n + 1e-6);
  EXPECT_GE(found.low_n, corner_n - tolerance_n(found));
  EXPECT_FALSE(found.curved);
  EXPECT_EQ(found.spray, "spray");
}

TEST(WorstSpray, is_approached_from_below_by_more_and_more_samples) {
  const Surface block = box({0, 0, 0}, {40, 20, 10});
  const model::Certified found = worst(block, jet());
  double last_n = 0;
  for (const int count : {10, 300, 10000}) {
    const double now_n = sampled_n(block, jet(), count, 4);
    EXPECT_LE(now_n, found.high_n + 1e-9);
    EXPECT_GE(now_n, last_n);  // a longer sample of one seed holds the shorter one
    last_n = now_n;
  }
  EXPECT_GE(last_n, 0.95 * found.low_n);
}

TEST(WorstSpray, is_where_its_ray_comes_from_and_needs_what_it_says) {
  const Surface block = box({0, 0, 0}, {40, 20, 10});
  const model::Certified found = worst(block, jet());
  EXPECT_TRUE(jet_meets_first(block, found.at_mm, found.from));
  SqueezeSolver solver(grasp());
  EXPECT_NEAR(
      jet_need(solver, jet(), found.at_mm, found.normal, model::Side::Below, model::FrictionModel::Pyramid)
          .force_n,
      found.low_n, 1e-9);
}

TEST(WorstSpray, within_a_cone_comes_from_there_alone) {
  const Surface block = box({0, 0, 0}, {40, 20, 10});
  const model::Certified all = worst(block, jet());
  const Vector3d aside = Vector3d::UnitY();
  const model::Certified side = worst(block, jet(aside, 0.1));
  EXPECT_LE(side.low_n, all.high_n);
  EXPECT_GE(side.from.dot(aside), std::cos(0.1) - 1e-9);
  EXPECT_LE(sampled_n(block, jet(aside, 0.1), 3000, 1), side.high_n + 1e-9);
  EXPECT_EQ(worst(block, jet(aside, 0)).normal, aside);
}

TEST(WorstSpray, of_a_cylinder_lies_between_a_dense_search_of_the_true_surface_and_its_own_high_end) {
  constexpr int kSides = 48;
  const Surface part = cylinder(12, 10, kSides);
  const double chord_mm = 12 * (1 - std::cos(std::numbers::pi / kSides));
  const model::Certified found = worst(part, jet(), chord_mm);
  SqueezeSolver solver(grasp());
  double dense_n = 0;
  const auto try_at = [&](const Vector3d& p_mm, const Vector3d& normal) {
    dense_n = std::max(
        dense_n,
        jet_need(solver, jet(), p_mm, normal, model::Side::Below, model::FrictionModel::Pyramid).force_n);
  };
  for (int i = 0; i < 3000; ++i) {
    const double angle_rad = 2 * std::numbers::pi * i / 3000;
    const Vector3d out(std::cos(angle_rad), std::sin(angle_rad), 0);
    for (const double z : {0.0, 10.0}) {
      try_at(12 * out + z * Vector3d::UnitZ(), out);
      try_at(12 * out + z * Vector3d::UnitZ(), Vector3d(0, 0, z > 5 ? 1 : -1));
    }
  }
  EXPECT_LE(dense_n, found.high_n);
  EXPECT_GE(dense_n, found.low_n - 1e-3);
  EXPECT_LE(found.high_n, 1.02 * found.low_n);
  EXPECT_LE(sampled_n(part, jet(), 10000, 1), found.high_n + 1e-9);
}

TEST(WorstSpray, needs_no_less_than_any_sample_even_where_the_search_may_not_split) {
  const Surface part = cylinder(12, 10, 24);
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    for (const int splits : {0, 5, 1000}) {
      Jet spray = jet();
      spray.spray.count = 300;
      spray.spray.seed = seed;
      WorstOptions options;
      options.most_splits = splits;
      options.most_looks = 0;
      const model::Certified found = worst(part, spray, 12 * (1 - std::cos(std::numbers::pi / 24)), options);
      EXPECT_NEAR(found.sampled_n, sampled_n(part, jet(), 300, seed), 1e-9);
      EXPECT_GE(found.low_n, found.sampled_n);
      EXPECT_GE(found.high_n, found.low_n);
      EXPECT_TRUE(found.closed || splits < 1000);
      EXPECT_TRUE(found.closed || found.high_n - found.low_n > tolerance_n(found));
      EXPECT_TRUE(jet_meets_first(part, found.at_mm, found.from));
    }
  }
}

TEST(WorstSpray, names_the_state_that_acts_with_it) {
  const Surface block = box({0, 0, 0}, {40, 20, 10});
  Jet spray = jet();
  spray.with = {{"gravity[-z]", force_at({20, 10, 5}, {0, 0, -2})},
                {"gravity[+z]", force_at({20, 10, 5}, {0, 0, 6})}};
  const model::Certified both = worst(block, spray);
  double single_n = 0;
  for (const model::Disturbance& with : spray.with) {
    Jet one = spray;
    one.with = {with};
    single_n = std::max(single_n, worst(block, one).high_n);
  }
  EXPECT_NEAR(both.high_n, single_n, 1e-9);
  EXPECT_TRUE(both.spray == "spray with gravity[-z]" || both.spray == "spray with gravity[+z]");
}

TEST(WorstSpray, grows_with_the_friction_cone_cut_to_a_pyramid) {
  const Surface block = box({0, 0, 0}, {40, 20, 10});
  WorstSpray search({&block, 0}, {jet()});
  const auto pyramid = search.of(grasp(), model::Side::Below, model::FrictionModel::Pyramid).value();
  const auto cone = search.of(grasp(), model::Side::Below, model::FrictionModel::Cone).value();
  EXPECT_LE(cone.low_n, pyramid.high_n + 1e-9);
}

TEST(WorstSpray, turns_with_the_side) {
  const Surface block = box({0, 0, 0}, {40, 20, 10});
  Grasp above = grasp();
  for (PointContact& contact : above.contacts) {  // the same pins, seen turned by pi about y
    contact.p_P_mm.x() *= -1;
    contact.p_P_mm.z() *= -1;
    contact.n_P.x() *= -1;
    contact.jaw = contact.jaw == model::JawSide::Left ? model::JawSide::Right : model::JawSide::Left;
  }
  WorstSpray search({&block, 0}, {jet()});
  EXPECT_NEAR(search.of(above, model::Side::Above, model::FrictionModel::Pyramid)->high_n,
              worst(block, jet()).high_n, 1e-6);
}

TEST(JetReach, tells_the_floor_of_a_deep_pocket_by_a_direction_and_a_void_by_none) {
  TriangleMesh mesh;
  add_box(mesh, {0, 0, 0}, {40, 20, 10});
  add_box(mesh, {15, 5, 3}, {25, 15, 7}, true);
  const Surface hollow(std::move(mesh));
  JetReach reach(hollow, jet().spray);
  EXPECT_TRUE(reach.direction_to({20, 10, 10}, 2).has_value() ||
              reach.direction_to({20, 10, 10}, 3).has_value());
  for (int triangle = 12; triangle < 24; ++triangle) {
    const auto& corners = hollow.mesh().triangles[static_cast<std::size_t>(triangle)];
    Vector3d middle_mm = Vector3d::Zero();
    for (const int corner : corners)
      middle_mm += hollow.mesh().vertices_mm[static_cast<std::size_t>(corner)] / 3;
    EXPECT_FALSE(reach.direction_to(middle_mm, triangle).has_value());
  }
}

}  // namespace
}  // namespace pinjaw::planner
