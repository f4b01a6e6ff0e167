#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <limits>
#include <optional>

#include "host/model/tolerance.hpp"
#include "host/planner/features/features.hpp"
#include "tests/host/planner/features/brep_part.hpp"
#include "tests/host/planner/planar/shapes.hpp"
#include "tests/host/planner/planar/slow/comparison.hpp"

// On a CAD part the features' reach takes the outline's place: where it is wrong, so are the fixtures.
namespace pinjaw::planner {
namespace {

/// The part's lowest z over a point (radius 0) or a disc in plan; nothing where it is not there.
using LowestZ = std::function<std::optional<double>(const Vector2d& center_mm, double radius_mm)>;

/// By the definition (DESIGN 3.1 no. 4): a closed pin's disc stays below the part by the engagement.
bool has_room(const model::Feature& feature, double along_mm, const model::PinStock& pins,
              const LowestZ& lowest_z) {
  const Vector2d foot_mm = geometry::point_at(feature.curve, along_mm);
  const Vector2d normal = model::outward_normal_at(feature, along_mm);
  const auto edge_z_mm = lowest_z(foot_mm - model::kEps_mm * normal, 0);
  if (!edge_z_mm) return false;
  const auto over_disc_mm = lowest_z(foot_mm + pins.radius_mm * normal, pins.radius_mm - model::kEps_mm);
  return !over_disc_mm || *over_disc_mm >= *edge_z_mm + pins.min_engagement_mm - 1e-9;
}

/// The feature with its reach found by trying places every twentieth of a millimetre and halving in between.
model::Feature with_tried_reach(model::Feature feature, const model::PinStock& pins,
                                const LowestZ& lowest_z) {
  const double length_mm = geometry::length_mm(feature.curve);
  const auto room = [&](double along_mm) { return has_room(feature, along_mm, pins, lowest_z); };
  const int count = std::max(2, static_cast<int>(length_mm / 0.05));
  const auto place = [&](int i) { return length_mm * std::clamp(i * 1.0 / count, 1e-9, 1 - 1e-9); };
  std::vector<geometry::Interval> reach_mm;
  for (int i = 0; i < count; ++i) {
    double lo = place(i);
    double hi = place(i + 1);
    const bool at_lo = room(lo);
    const bool at_hi = room(hi);
    if (i == 0 && at_lo) reach_mm.push_back({0, length_mm});
    if (at_lo == at_hi) continue;
    for (int k = 0; k < 40; ++k) {
      const double middle = (lo + hi) / 2;
      (room(middle) == at_lo ? lo : hi) = middle;
    }
    if (at_lo) {
      reach_mm.back().hi = lo;
    } else {
      reach_mm.push_back({hi, length_mm});
    }
  }
  feature.reach_mm = reach_mm;
  return feature;
}

model::Kit coarse_kit(int columns, int rows) {
  model::Kit kit = small_kit(columns, rows);
  kit.pins.radius_mm = 2.38125;
  kit.pins.min_engagement_mm = 1;
  return kit;
}

void expect_same_fixtures(const part::Part& part, const model::Kit& kit, const LowestZ& lowest_z,
                          const char* name, int least) {
  const std::vector<model::Feature> found = find_features(part, kit.pins).features;
  std::vector<model::Feature> tried;
  for (const model::Feature& feature : found) tried.push_back(with_tried_reach(feature, kit.pins, lowest_z));
  slow::Task task = slow::task_of(tried, kit, nullptr);
  task.reach_hair_mm = 1e-4;  // what trying places says of an end
  PlanarOptions options;
  options.threads = 1;
  const slow::Tally tally = slow::compare(task, plan_planar_fixtures(found, kit, options).fixtures, name);
  std::printf("%s: %zu features, %d fixtures, %d borderline, %d that the slow search overlooked\n", name,
              found.size(), tally.fixtures, tally.borderlines, tally.overlooked);
  for (const std::string& disagreement : tally.disagreements) ADD_FAILURE() << disagreement;
  EXPECT_GT(tally.fixtures, least);
  EXPECT_LE(tally.borderlines, 1 + tally.fixtures / 100);
  EXPECT_LE(tally.overlooked, 1 + tally.fixtures / 500);
}

/// Boxes whose lowest z over a disc needs no surface, only their corners.
LowestZ lowest_of(const std::vector<Box3>& solids) {
  return [solids](const Vector2d& center_mm, double radius_mm) {
    std::optional<double> least_mm;
    for (const Box3& box : solids) {
      const Vector2d nearest = center_mm.cwiseMax(box.lo_mm.head<2>()).cwiseMin(box.hi_mm.head<2>());
      if ((nearest - center_mm).norm() > radius_mm) continue;
      if (!least_mm || box.lo_mm.z() < *least_mm) least_mm = box.lo_mm.z();
    }
    return least_mm;
  };
}

TEST(PlanarCadParts, a_block_with_steps_and_overhangs_has_the_fixtures_of_its_boxes) {
  const std::vector<Box3> solids{{{0, 0, 0}, {24, 17, 12}},     // foot
                                 {{-6, 3, 5}, {31, 26, 12}},    // plate over it, lower on three sides
                                 {{4, 20, 2}, {9, 24, 12}},     // a boss below the plate, near the foot
                                 {{26, 5, 2.5}, {30, 9, 12}}};  // and one that stands beside its side
  expect_same_fixtures(part_of(boxes(solids)), coarse_kit(2, 4), lowest_of(solids), "block with steps", 50);
}

TEST(PlanarCadParts, a_block_with_pockets_has_the_fixtures_of_its_walls) {
  const std::vector<Box3> solids{{{0, 0, 4}, {40, 30, 10}},  // ceiling of the pockets
                                 {{0, 0, 0}, {40, 4, 10}},  {{0, 26, 0}, {40, 30, 10}},
                                 {{0, 4, 0}, {5, 26, 10}},  {{33, 4, 0}, {40, 26, 10}},
                                 {{17, 4, 0}, {21, 26, 10}}};
  expect_same_fixtures(part_of(boxes(solids)), coarse_kit(2, 3), lowest_of(solids), "block with pockets", 50);
}

class PlanarShippedPart : public testing::TestWithParam<const char*> {};

TEST_P(PlanarShippedPart, has_the_fixtures_of_a_reach_found_by_trying) {
  const part::Part whole = part_of(shipped_shape(GetParam()));
  for (const model::Side side : {model::Side::Below, model::Side::Above}) {
    const part::Part part = part::turned(whole, side);
    const LowestZ lowest_z = [&](const Vector2d& center_mm, double radius_mm) -> std::optional<double> {
      if (radius_mm == 0) {
        const auto hit = part.surface.lowest_above(center_mm);
        return hit ? std::optional(hit->point_mm.z()) : std::nullopt;
      }
      const double z_mm = part.surface.lowest_z_mm({center_mm, center_mm, radius_mm});
      return std::isfinite(z_mm) ? std::optional(z_mm) : std::nullopt;
    };
    expect_same_fixtures(part, coarse_kit(2, 3), lowest_z, GetParam(), 10);
  }
}

INSTANTIATE_TEST_SUITE_P(Parts, PlanarShippedPart, testing::Values("l_bracket"),
                         [](const auto& one) { return std::string(one.param); });

}  // namespace
}  // namespace pinjaw::planner
