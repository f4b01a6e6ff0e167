#include "tests/host/planner/planar/slow/random_profiles.hpp"

#include <algorithm>
#include <cmath>

#include "tests/host/planner/planar/shapes.hpp"
#include "tests/host/planner/planar/slow/turn.hpp"

namespace pinjaw::planner::slow {
namespace {

using base::Random;
using geometry::Arc;
using geometry::Segment;
using geometry::Vector2d;
using model::Kit;
using model::Profile;
using model::ProfileEdge;

int whole(Random& random, int least, int most) {
  return std::min(most, least + static_cast<int>(random.uniform() * (most - least + 1)));
}

/// Corners around the origin, evenly spaced but for `jitter` of a share each, at radii in [least, most].
std::vector<Vector2d> corners_around(Random& random, int count, double jitter, double least_mm,
                                     double most_mm) {
  std::vector<Vector2d> points;
  for (int i = 0; i < count; ++i) {
    const double angle_rad = kTurn * (i + random.uniform(-jitter, jitter)) / count;
    points.push_back(random.uniform(least_mm, most_mm) * geometry::direction(angle_rad));
  }
  return points;
}

ProfileEdge line(const Vector2d& a_mm, const Vector2d& b_mm) {
  ProfileEdge edge;
  edge.curve = Segment{a_mm, b_mm};
  return edge;
}

/// From a to b about a centre `rise_mm` left of the middle of the way: convex where it turns left.
ProfileEdge bulge(const Vector2d& a_mm, const Vector2d& b_mm, double rise_mm, bool convex) {
  const double half_mm = (b_mm - a_mm).norm() / 2;
  const double radius_mm = std::hypot(half_mm, rise_mm);
  const Vector2d left = Vector2d(a_mm.y() - b_mm.y(), b_mm.x() - a_mm.x()).normalized();
  const Vector2d center_mm = (a_mm + b_mm) / 2 + (convex ? rise_mm : -rise_mm) * left;
  const Vector2d first = (convex ? a_mm : b_mm) - center_mm;
  ProfileEdge edge;
  edge.reversed = !convex;
  edge.curve =
      Arc{center_mm, radius_mm, std::atan2(first.y(), first.x()), 2 * std::asin(half_mm / radius_mm)};
  return edge;
}

std::vector<ProfileEdge> circular_hole(const Vector2d& center_mm, double radius_mm) {
  ProfileEdge edge;
  edge.curve = Arc{center_mm, radius_mm, 0.4, kTurn};
  edge.reversed = true;
  return {edge};
}

std::vector<ProfileEdge> slot_hole(const Vector2d& middle_mm, double half_length_mm, double radius_mm,
                                   double lean_rad) {
  const Vector2d along = geometry::direction(lean_rad);
  const Vector2d across(-along.y(), along.x());
  const Vector2d one_mm = middle_mm - half_length_mm * along;
  const Vector2d two_mm = middle_mm + half_length_mm * along;
  std::vector<ProfileEdge> loop(4);
  loop[0] = line(one_mm + radius_mm * across, two_mm + radius_mm * across);
  loop[1].curve = Arc{two_mm, radius_mm, lean_rad - kTurn / 4, kTurn / 2};
  loop[1].reversed = true;
  loop[2] = line(two_mm - radius_mm * across, one_mm - radius_mm * across);
  loop[3].curve = Arc{one_mm, radius_mm, lean_rad + kTurn / 4, kTurn / 2};
  loop[3].reversed = true;
  return loop;
}

/// Corners of a convex polygon replaced by arcs that join smoothly, of `share` of the largest radius.
Profile rounded(const std::vector<Vector2d>& points, double share) {
  const std::size_t count = points.size();
  const auto way = [&](std::size_t i) { return Vector2d(points[(i + 1) % count] - points[i % count]); };
  const auto half_tangent = [&](std::size_t i) {
    const double cosine = way(i + count - 1).normalized().dot(way(i).normalized());
    return std::tan(std::acos(cosine) / 2);
  };
  double radius_mm = 1e9;
  for (std::size_t i = 0; i < count; ++i) {
    radius_mm = std::min(radius_mm, share * way(i).norm() / (half_tangent(i) + half_tangent(i + 1)));
  }
  const auto joint = [&](std::size_t i, bool leaving) {
    const Vector2d along = leaving ? way(i) : Vector2d(-way(i + count - 1));
    return Vector2d(points[i % count] + radius_mm * half_tangent(i) * along.normalized());
  };
  std::vector<ProfileEdge> loop;
  for (std::size_t i = 0; i < count; ++i) {
    const Vector2d a_mm = joint(i, true);
    const Vector2d b_mm = joint(i + 1, false);
    const Vector2d c_mm = joint(i + 1, true);
    loop.push_back(line(a_mm, b_mm));
    const double half_mm = (c_mm - b_mm).norm() / 2;
    loop.push_back(bulge(b_mm, c_mm, std::sqrt(radius_mm * radius_mm - half_mm * half_mm), true));
  }
  return profile_of_loop(loop);
}

// ---- families

Profile convex_polygon(Random& random, const Kit&) {
  const int count = whole(random, 3, 7);
  const double wide = random.uniform(0.7, 1.0);
  std::vector<Vector2d> points = corners_around(random, count, 0.35, 18, 18);
  for (Vector2d& point : points) point.y() *= wide;
  return polygon_profile(points);
}

Profile star(Random& random, const Kit&) {
  return polygon_profile(corners_around(random, whole(random, 5, 9), 0.25, 11, 22));
}

Profile bulging_star(Random& random, const Kit&) {
  const auto points = corners_around(random, whole(random, 4, 6), 0.25, 14, 22);
  std::vector<ProfileEdge> loop;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vector2d& a_mm = points[i];
    const Vector2d& b_mm = points[(i + 1) % points.size()];
    const double half_mm = (b_mm - a_mm).norm() / 2;
    const double kind = random.uniform();
    loop.push_back(kind < 0.4 ? line(a_mm, b_mm)
                              : bulge(a_mm, b_mm, half_mm * random.uniform(0.5, 2), kind < 0.75));
  }
  return profile_of_loop(loop);
}

Profile tangent_joins(Random& random, const Kit&) {
  return rounded(corners_around(random, whole(random, 3, 5), 0.2, 18, 22), random.uniform(0.05, 0.95));
}

Profile bored(Random& random, const Kit& kit) {
  Profile profile = polygon_profile(corners_around(random, whole(random, 3, 5), 0.2, 19, 24));
  profile.loops.push_back(circular_hole({random.uniform(-2, 2), random.uniform(-2, 2)},
                                        kit.pins.radius_mm + random.uniform(-0.5, 3)));
  return profile;
}

Profile slotted(Random& random, const Kit& kit) {
  Profile profile = polygon_profile(corners_around(random, 4, 0.15, 20, 25));
  profile.loops.push_back(slot_hole({random.uniform(-1, 1), random.uniform(-1, 1)}, random.uniform(2, 5),
                                    kit.pins.radius_mm + random.uniform(0.1, 2), random.uniform(0, kTurn)));
  return profile;
}

Profile symmetric(Random& random, const Kit&) {
  const int order = whole(random, 2, 5);
  const double tip_mm = random.uniform(15, 21);
  const double dent_mm = random.uniform(0.55, 0.95) * tip_mm;
  const double lean_rad = random.uniform() < 0.5 ? 0 : random.uniform(0, kTurn);
  std::vector<Vector2d> points;
  for (int i = 0; i < 2 * order; ++i) {
    points.push_back((i % 2 == 0 ? tip_mm : dent_mm) *
                     geometry::direction(lean_rad + kTurn * i / (2 * order)));
  }
  return polygon_profile(points);
}

Profile rectangle(Random& random, const Kit& kit) {
  const bool round = random.uniform() < 0.5;
  const double d_mm = kit.grid.spacing_mm;
  const double x_mm = round ? d_mm * whole(random, 1, 3) : random.uniform(10, 34);
  const double y_mm = round ? d_mm * whole(random, 1, 3) : random.uniform(10, 34);
  return polygon_profile({{0, 0}, {x_mm, 0}, {x_mm, y_mm}, {0, y_mm}});
}

/// Steps and an L of whole or half spacings, along the axes.
Profile on_the_grid(Random& random, const Kit& kit) {
  const double unit_mm = kit.grid.spacing_mm / whole(random, 1, 2);
  const auto some = [&](int least, int most) { return unit_mm * whole(random, least, most); };
  const double w1 = some(1, 2);
  const double w2 = w1 + some(1, 2);
  const double h1 = some(1, 2);
  const double h2 = h1 + some(1, 2);
  if (random.uniform() < 0.5)
    return polygon_profile({{0, 0}, {w2, 0}, {w2, h1}, {w1, h1}, {w1, h2}, {0, h2}});
  return polygon_profile({{0, 0}, {w2, 0}, {w2 + unit_mm, h1}, {w1, h2}, {0, h1}});
}

/// A block with a square notch exactly as wide as a pin, or a little wider, in its lower side, and a V above.
Profile notched(Random& random, const Kit& kit) {
  const double play_mm = random.uniform() < 0.6 ? 0 : random.uniform(0.01, 1);
  const double width_mm = 2 * kit.pins.radius_mm + play_mm;
  const double depth_mm = random.uniform(2, 8);
  const double from_mm = random.uniform(6, 14);
  const double lean_mm = random.uniform() < 0.5 ? 0 : random.uniform(-4, 4);
  return polygon_profile({{0, 0},
                          {from_mm, 0},
                          {from_mm, depth_mm},
                          {from_mm + width_mm, depth_mm},
                          {from_mm + width_mm, 0},
                          {33, lean_mm},
                          {33, 22},
                          {20, 14},
                          {0, 22 + lean_mm}});
}

/// Two equal bosses a whole number of holes apart, their circles coinciding at one angle, under a random
/// roof.
Profile bosses(Random& random, const Kit& kit) {
  const double d_mm = kit.grid.spacing_mm;
  const double r_mm = d_mm / 2;
  std::vector<ProfileEdge> loop(2);
  loop[0].curve = Arc{Vector2d(0, d_mm), r_mm, kTurn / 4, kTurn / 2};
  loop[1].curve = Arc{Vector2d(0, 0), r_mm, kTurn / 4, kTurn / 2};
  const std::vector<Vector2d> points{{0, -r_mm},
                                     {12, random.uniform(-12, -6)},
                                     {random.uniform(26, 34), random.uniform(0, 11)},
                                     {12, random.uniform(17, 23)},
                                     {0, d_mm + r_mm}};
  for (std::size_t i = 0; i + 1 < points.size(); ++i) loop.push_back(line(points[i], points[i + 1]));
  return profile_of_loop(loop);
}

constexpr Family kFamilies[] = {
    {"convex polygon", false, convex_polygon},
    {"star", false, star},
    {"star with arcs", false, bulging_star},
    {"smooth joins", false, tangent_joins},
    {"bore", false, bored},
    {"slot", false, slotted},
    {"symmetric", true, symmetric},
    {"rectangle", true, rectangle},
    {"on the grid", true, on_the_grid},
    {"notch as wide as a pin", true, notched},
    {"equal bosses", true, bosses},
};

}  // namespace

std::span<const Family> families() {
  return kFamilies;
}

model::Kit random_kit(Random& random) {
  model::Kit kit = small_kit(2, 3);
  if (random.uniform() < 0.2) kit.grid.columns = 3;
  if (random.uniform() < 0.25) kit.grid.rows = whole(random, 4, 5);
  if (random.uniform() < 0.5) kit.pins.radius_mm = random.uniform(2, 3);
  if (random.uniform() < 0.3) kit.jaws.separation_mm = {random.uniform(0, 15), random.uniform(20, 40)};
  if (random.uniform() < 0.2) kit.pins.min_foot_margin_mm = random.uniform(0, 1.5);
  return kit;
}

}  // namespace pinjaw::planner::slow
