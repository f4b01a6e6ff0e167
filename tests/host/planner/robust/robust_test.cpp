#include "host/planner/robust/robust.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "host/planner/force/force.hpp"
#include "host/planner/plan/rank.hpp"
#include "tests/host/planner/plan/planned.hpp"
#include "tests/host/planner/robust/vise.hpp"

namespace pinjaw::planner {
namespace {

const Planned& plate() {
  static const Planned kPlanned = plan_of("l-plate", {.top = 0});
  return kPlanned;
}

model::Ranges scaled(double by) {
  model::Ranges ranges;
  ranges.pin_position_mm *= by;
  ranges.pin_radius_mm *= by;
  ranges.part_size_mm *= by;
  return ranges;
}

/// Some designs on lines and arcs: of the plate with its inner corner, of the cam with its nose.
struct Sample {
  const Planned& planned;
  std::size_t design;
};
std::vector<Sample> samples() {
  std::vector<Sample> all;
  for (const Planned* planned : {&plate(), &cam()}) {
    const std::size_t count = planned->plan.designs.size();
    for (std::size_t i = 0; i < 6; ++i) all.push_back({*planned, i * (count - 1) / 5});
  }
  return all;
}

/// Errors drawn evenly from all of the ranges.
model::PinErrors drawn(std::mt19937& random) {
  std::uniform_real_distribution<double> share(-1, 1);
  model::PinErrors errors;
  for (model::PinError& error : errors) error = {share(random), share(random)};
  return errors;
}

TEST(Robust, over_ranges_without_width_is_nominal) {
  for (const Sample& sample : samples()) {
    model::Ranges ranges = scaled(0);
    ranges.friction = geometry::Interval{sample.planned.plan.friction, sample.planned.plan.friction};
    ranges.air_pressure = {1, 1};
    const RobustScene scene(sample.planned.plan, sample.planned.scene, ranges);
    const model::Design& design = sample.planned.plan.designs[sample.design];
    const model::Robust robust = robust_of(scene.of, design);
    ASSERT_TRUE(robust.worst_required_n) << robust.failure;
    EXPECT_NEAR(*robust.worst_required_n, design.squeeze.required_n, 1e-7);
    EXPECT_EQ(robust.critical, design.squeeze.critical);
    EXPECT_NEAR(robust.margin_n, design.squeeze.margin_n, 1e-7);
    EXPECT_NEAR(robust.location_error_mm, 0, 1e-9);
    ASSERT_TRUE(robust.location_bound_mm);
    EXPECT_NEAR(*robust.location_bound_mm, 0, 1e-6);
  }
}

TEST(Robust, is_never_better_over_wider_ranges) {
  for (const Sample& sample : samples()) {
    const model::Design& design = sample.planned.plan.designs[sample.design];
    double worst_n = design.squeeze.required_n;
    double off_mm = 0;
    double bound_mm = 0;
    for (const double by : {0.0, 0.5, 1.0, 2.0}) {
      const RobustScene scene(sample.planned.plan, sample.planned.scene, scaled(by));
      const model::Robust robust = robust_of(scene.of, design);
      const double now_n = robust.worst_required_n.value_or(std::numeric_limits<double>::infinity());
      EXPECT_GE(now_n, worst_n - 1e-9);
      EXPECT_GE(robust.location_error_mm, off_mm);
      EXPECT_GE(robust.location_bound_mm.value_or(1e9), bound_mm);
      worst_n = now_n;
      off_mm = robust.location_error_mm;
      bound_mm = robust.location_bound_mm.value_or(1e9);
    }
  }
}

TEST(Robust, needs_less_squeeze_the_more_friction_there_is) {
  for (const Sample& sample : samples()) {
    const RobustScene scene(sample.planned.plan, sample.planned.scene, scaled(1));
    const model::Design& design = sample.planned.plan.designs[sample.design];
    const geometry::Interval friction = scene.of.ranges.friction_about(scene.of.friction);
    double before_n = std::numeric_limits<double>::infinity();
    for (int step = 0; step <= 10; ++step) {
      const RobustPoint point = robust_at(scene.of, design, friction.lo + step * friction.length() / 10, {});
      if (!point.required_n) continue;
      EXPECT_LE(*point.required_n, before_n + 1e-7);
      before_n = *point.required_n;
    }
  }
}

TEST(Robust, worst_point_needs_what_it_is_said_to_and_the_air_leaves_what_it_is_said_to) {
  for (const Sample& sample : samples()) {
    const RobustScene scene(sample.planned.plan, sample.planned.scene, scaled(1));
    const model::Design& design = sample.planned.plan.designs[sample.design];
    const model::Robust robust = robust_of(scene.of, design);
    const RobustPoint again = robust_at(scene.of, design, robust.friction, robust.pins);
    EXPECT_EQ(again.required_n, robust.worst_required_n);
    EXPECT_EQ(again.failure, robust.failure);
    const model::Actuator& actuator = scene.of.kit.actuator;
    EXPECT_DOUBLE_EQ(robust.usable_n, 0.9 * actuator.max_squeeze_n - 2 * actuator.force_uncertainty_n);
  }
}

TEST(Robust, is_no_better_than_what_drawn_errors_need_but_for_a_trifle) {
  std::mt19937 random(7);
  for (const Sample& sample : samples()) {
    const RobustScene scene(sample.planned.plan, sample.planned.scene, scaled(1));
    const model::Design& design = sample.planned.plan.designs[sample.design];
    const model::Robust robust = robust_of(scene.of, design);
    if (!robust.worst_required_n) continue;
    for (int i = 0; i < 200; ++i) {
      const RobustPoint point = robust_at(scene.of, design, robust.friction, drawn(random));
      ASSERT_TRUE(point.required_n) << point.failure;
      EXPECT_LE(*point.required_n, *robust.worst_required_n * (1 + 1e-6));  // sampled, yet nothing was missed
    }
  }
}

TEST(Location, of_drawn_errors_never_passes_the_bound) {
  std::mt19937 random(11);
  for (const Sample& sample : samples()) {
    const Planned& planned = sample.planned;
    const model::Design& design = planned.plan.designs[sample.design];
    for (const double by : {0.1, 1.0, 4.0}) {
      const RobustScene scene(planned.plan, planned.scene, scaled(by));
      const Closing closing(design, scene.features, planned.plan.kit, scene.of.centroid_P_mm);
      const auto bound = closing.bound(scene.of.ranges);
      if (!bound) continue;
      EXPECT_GE(bound->moved_mm, location_error(scene.of, design).moved_mm);
      for (int i = 0; i < 300; ++i) {
        const auto part = closing.at(scene.of.ranges, drawn(random));
        ASSERT_TRUE(part);
        EXPECT_LE(part->moved_mm, bound->moved_mm);
        EXPECT_LE(std::abs(part->turned_rad), bound->turned_rad);
      }
    }
  }
}

TEST(Location, bound_is_proven_for_usual_ranges_and_close_to_the_corners) {
  int proven = 0;
  for (const Sample& sample : samples()) {
    const RobustScene scene(sample.planned.plan, sample.planned.scene, scaled(1));
    const model::Robust robust = robust_of(scene.of, sample.planned.plan.designs[sample.design]);
    if (!robust.location_bound_mm) continue;
    ++proven;
    EXPECT_LE(*robust.location_bound_mm, 1.5 * robust.location_error_mm);
  }
  EXPECT_GE(proven, 10);
}

TEST(Location, is_where_a_slow_vise_closes) {
  std::mt19937 random(3);
  for (const Sample& sample : samples()) {
    const Planned& planned = sample.planned;
    const model::Design& design = planned.plan.designs[sample.design];
    const RobustScene scene(planned.plan, planned.scene, scaled(1));
    const model::Ranges& ranges = scene.of.ranges;
    const Closing closing(design, scene.features, planned.plan.kit, scene.of.centroid_P_mm);
    for (int i = 0; i < 5; ++i) {
      const model::PinErrors errors = drawn(random);
      std::array<PinOff, 4> off;
      for (std::size_t pin = 0; pin < 4; ++pin) {
        const geometry::Vector2d& n = design.pins[pin].normal;
        const model::PinError& e = errors[pin];
        off[pin].axis_mm =
            ranges.pin_position_mm * (e.towards * n + e.across * geometry::Vector2d(-n.y(), n.x()));
        off[pin].radius_mm = e.towards * ranges.pin_radius_mm;
        off[pin].feature_mm = e.towards * ranges.part_size_mm;
      }
      const auto part = closing.at(ranges, errors);
      const auto vised = closed_by_vise(design, scene.features, planned.plan.kit, off);
      ASSERT_TRUE(part);
      ASSERT_TRUE(vised);
      const geometry::Vector2d& at = scene.of.centroid_P_mm;
      EXPECT_NEAR(part->moved_mm, (vised->part_pose * at - design.part_pose * at).norm(), 1e-6);
      EXPECT_NEAR(part->turned_rad, vised->part_pose.theta_rad - design.part_pose.theta_rad, 1e-7);
      EXPECT_NEAR(part->separation_mm, vised->separation_mm, 1e-6);
    }
  }
}

TEST(Location, opens_the_jaws_where_every_pin_is_thicker_and_closes_them_where_every_pin_is_thinner) {
  // in form closure the separation is at its least, so pushing at every contact can only raise it
  for (const Sample& sample : samples()) {
    const Planned& planned = sample.planned;
    const model::Design& design = planned.plan.designs[sample.design];
    model::Ranges ranges = scaled(0);
    ranges.pin_radius_mm = 0.01;
    const RobustScene scene(planned.plan, planned.scene, ranges);
    const Closing closing(design, scene.features, planned.plan.kit, scene.of.centroid_P_mm);
    for (const double sign : {1.0, -1.0}) {
      model::PinErrors errors;
      for (model::PinError& error : errors) error.towards = sign;
      const auto part = closing.at(ranges, errors);
      ASSERT_TRUE(part);
      EXPECT_GT(sign * (part->separation_mm - design.jaw_separation_mm), 0);
    }
  }
}

TEST(Rank, by_the_worst_agrees_with_working_out_every_design) {
  for (const Planned* planned : {&plate(), &cam()}) {
    Plan plan = planned->plan;
    constexpr std::size_t kDesigns = 60;
    if (plan.designs.size() > kDesigns) plan.designs.resize(kDesigns);
    const model::Ranges ranges;
    const RobustScene scene(plan, planned->scene, ranges);
    std::vector<std::pair<double, std::string>> all;
    for (const model::Design& design : plan.designs) {
      const model::Robust robust = robust_of(scene.of, design);
      all.emplace_back(robust.worst_required_n.value_or(1e9), design.id);
    }
    std::ranges::sort(all);
    Plan ranked = plan;
    tell_robustness(ranked, planned->scene, ranges, {.count = 5, .rank = Rank::Robust, .top = 0});
    ASSERT_EQ(ranked.designs.size(), plan.designs.size());
    for (std::size_t i = 0; i < 5; ++i) {
      ASSERT_TRUE(ranked.designs[i].robust);
      EXPECT_EQ(ranked.designs[i].robust->worst_required_n.value_or(1e9), all[i].first);
    }
    for (std::size_t i = 5; i < ranked.designs.size(); ++i) EXPECT_FALSE(ranked.designs[i].robust);
  }
}

TEST(Rank, nominally_keeps_the_order_and_tells_of_the_first) {
  Plan plan = plate().plan;
  tell_robustness(plan, plate().scene, {}, {.count = 3, .rank = Rank::Nominal, .top = 4});
  ASSERT_EQ(plan.designs.size(), 4U);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(plan.designs[i].id, plate().plan.designs[i].id);
    EXPECT_EQ(plan.designs[i].robust.has_value(), i < 3);
  }
}

}  // namespace
}  // namespace pinjaw::planner
