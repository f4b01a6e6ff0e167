#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>

#include "host/base/random.hpp"
#include "host/geometry/facet.hpp"
#include "host/geometry/surface.hpp"
#include "tests/host/geometry/surface_referee.hpp"

namespace pinjaw::geometry {
namespace {

/// Slack for rounding, on a few tens of mm.
constexpr double kRounding_mm = 1e-6;

/// Random facets, with flat, upright and zero-area ones and shared corners among them: coordinates are often
/// whole.
TriangleMesh random_mesh(base::Random& random, int facets) {
  TriangleMesh mesh;
  const auto coordinate = [&] {
    const double c = random.uniform(-10, 10);
    return random.uniform() < 0.5 ? std::round(c / 5) * 5 : c;
  };
  for (int i = 0; i < 3 * facets; ++i)
    mesh.vertices_mm.emplace_back(coordinate(), coordinate(), coordinate());
  const auto pick = [&] { return static_cast<int>(random.uniform(0, 3 * facets)); };
  for (int i = 0; i < facets; ++i) {
    mesh.triangles.push_back({pick(), pick(), pick()});
    mesh.face_of.push_back(i);
  }
  return mesh;
}

Sweep random_sweep(base::Random& random) {
  const Vector2d from{random.uniform(-12, 12), random.uniform(-12, 12)};
  const double radius_mm = random.uniform() < 0.2 ? 5.0 : random.uniform(0.01, 6);
  if (random.uniform() < 0.4) return {from, from, radius_mm};
  return {from,
          {random.uniform(-12, 12), random.uniform() < 0.3 ? from.y() : random.uniform(-12, 12)},
          radius_mm};
}

Slab random_slab(base::Random& random) {
  if (random.uniform() < 0.3) return {};
  const double lo = random.uniform(-12, 12);
  return {lo, lo + random.uniform(0, 12)};
}

TEST(SurfaceProperty, the_lowest_and_highest_z_lie_between_the_referees_brackets) {
  const bool held = rc::check("lowest and highest", [](std::uint64_t seed) {
    base::Random random(seed);
    const Surface surface{random_mesh(random, 1 + static_cast<int>(random.uniform(0, 40)))};
    for (int i = 0; i < 8; ++i) {
      const Sweep region = random_sweep(random);
      const Slab slab = random_slab(random);
      const double low = surface.lowest_z_mm(region, slab);
      const auto lowest = testing::lowest_bracket_mm(surface.mesh(), region, slab);
      RC_ASSERT(low >= lowest.outer - kRounding_mm);
      RC_ASSERT(low <= lowest.inner + kRounding_mm);
      const double high = surface.highest_z_mm(region, slab);
      const auto highest = testing::highest_bracket_mm(surface.mesh(), region, slab);
      RC_ASSERT(high <= highest.outer + kRounding_mm);
      RC_ASSERT(high >= highest.inner - kRounding_mm);
      RC_ASSERT(surface.meets(region, slab) == (low <= high));
    }
  });
  EXPECT_TRUE(held);
}

/// The z range over the region and within the slab by asking every facet: no tree, no spans, no early end.
Interval every_facet(const TriangleMesh& mesh, const Sweep& region, const Slab& slab) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const Stadium stadium(region);
  Interval all{kInfinity, -kInfinity};
  for (const auto& corners : mesh.triangles) {
    Facet facet;
    for (std::size_t i = 0; i < 3; ++i)
      facet.p_mm[i] = mesh.vertices_mm[static_cast<std::size_t>(corners[i])];
    const Vector3d normal = (facet.p_mm[1] - facet.p_mm[0]).cross(facet.p_mm[2] - facet.p_mm[0]);
    const double length = normal.norm();
    if (length > 0) facet.normal = normal / length;
    const Interval z = z_range_over(facet, stadium);
    const Interval cut{std::max(z.lo, slab.lo_mm), std::min(z.hi, slab.hi_mm)};
    if (cut.lo > cut.hi) continue;
    all = {std::min(all.lo, cut.lo), std::max(all.hi, cut.hi)};
  }
  return all;
}

TEST(SurfaceProperty, what_is_left_out_early_changes_no_bit_of_an_answer) {
  const bool held = rc::check("screens", [](std::uint64_t seed) {
    base::Random random(seed);
    const Surface surface{random_mesh(random, 1 + static_cast<int>(random.uniform(0, 60)))};
    for (int i = 0; i < 20; ++i) {
      const Sweep region = random_sweep(random);
      const Slab slab = random_slab(random);
      const Interval all = every_facet(surface.mesh(), region, slab);
      RC_ASSERT(surface.lowest_z_mm(region, slab) == all.lo);
      RC_ASSERT(surface.highest_z_mm(region, slab) == all.hi);
      RC_ASSERT(surface.meets(region, slab) == (all.lo <= all.hi));
    }
  });
  EXPECT_TRUE(held);
}

TEST(SurfaceProperty, a_rectangle_meets_what_the_referee_finds_in_it) {
  const bool held = rc::check("rectangles", [](std::uint64_t seed) {
    base::Random random(seed);
    const Surface surface{random_mesh(random, 1 + static_cast<int>(random.uniform(0, 12)))};
    for (int i = 0; i < 20; ++i) {
      const Rectangle region{{random.uniform(-12, 12), random.uniform(-12, 12)},
                             direction(random.uniform() < 0.3 ? 0 : random.uniform(0, 6)),
                             {random.uniform(0.1, 6), random.uniform(0.1, 6)}};
      const Slab slab = random_slab(random);
      const bool met = surface.meets(region, slab);
      if (met) RC_ASSERT(testing::meets_rectangle(surface.mesh(), region, slab, kRounding_mm));
      if (!met) RC_ASSERT(!testing::meets_rectangle(surface.mesh(), region, slab, -kRounding_mm));
    }
  });
  EXPECT_TRUE(held);
}

TEST(SurfaceProperty, a_larger_region_reaches_at_least_as_far) {
  const bool held = rc::check("monotone", [](std::uint64_t seed) {
    base::Random random(seed);
    const Surface surface{random_mesh(random, 60)};
    Sweep region = random_sweep(random);
    const Slab slab = random_slab(random);
    const double low = surface.lowest_z_mm(region, slab);
    const double high = surface.highest_z_mm(region, slab);
    region.radius_mm += random.uniform(0, 2);
    RC_ASSERT(surface.lowest_z_mm(region, slab) <= low + kRounding_mm);
    RC_ASSERT(surface.highest_z_mm(region, slab) >= high - kRounding_mm);
  });
  EXPECT_TRUE(held);
}

TEST(SurfaceProperty, turning_the_mesh_about_z_turns_the_answers) {
  const bool held = rc::check("rigid motion", [](std::uint64_t seed) {
    base::Random random(seed);
    const TriangleMesh mesh = random_mesh(random, 60);
    const Pose2 pose{random.uniform(0, 6), {random.uniform(-9, 9), random.uniform(-9, 9)}};
    TriangleMesh turned = mesh;
    for (Vector3d& p : turned.vertices_mm) p.head<2>() = pose * Vector2d(p.head<2>());
    const Sweep region = random_sweep(random);
    const Sweep moved{pose * region.from_mm, pose * region.to_mm, region.radius_mm};
    const double here = Surface(mesh).lowest_z_mm({region.from_mm, region.to_mm, region.radius_mm});
    const double lower = Surface(turned).lowest_z_mm({moved.from_mm, moved.to_mm, region.radius_mm + 1e-6});
    const double higher = Surface(turned).lowest_z_mm({moved.from_mm, moved.to_mm, region.radius_mm - 1e-6});
    RC_ASSERT(lower <= here + kRounding_mm);
    RC_ASSERT(here <= higher + kRounding_mm);
  });
  EXPECT_TRUE(held);
}

TEST(SurfaceProperty, the_first_hit_is_the_nearest_of_all_facets) {
  const bool held = rc::check("rays", [](std::uint64_t seed) {
    base::Random random(seed);
    const Surface surface{random_mesh(random, 50)};
    for (int i = 0; i < 10; ++i) {
      const Vector3d origin{random.uniform(-12, 12), random.uniform(-12, 12), random.uniform(-12, 12)};
      const Vector3d direction = Vector3d(random.normal(), random.normal(), random.normal()).normalized();
      const auto hit = surface.first_hit({origin, direction});
      const double expected_mm = testing::first_hit_mm(surface.mesh(), {origin, direction});
      RC_ASSERT(hit.has_value() == std::isfinite(expected_mm));
      if (!hit) continue;
      RC_ASSERT(std::abs(hit->distance_mm - expected_mm) < 1e-7);
      RC_ASSERT((hit->point_mm - (origin + direction * hit->distance_mm)).norm() < 1e-9);
    }
  });
  EXPECT_TRUE(held);
}

}  // namespace
}  // namespace pinjaw::geometry
