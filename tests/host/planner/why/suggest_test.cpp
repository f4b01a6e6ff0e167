#include "host/planner/why/suggest.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/host/planner/why/spoilt.hpp"

namespace pinjaw::planner {
namespace {

/// The first suggestion that changes `key`, the search being stopped there.
std::optional<Suggestion> first_with(const Spoilt& job, const std::string& key) {
  std::stop_source stop;
  Variant variant{job.task, job.options};
  variant.options.stop = stop.get_token();
  std::optional<Suggestion> found;
  const auto told = [&](const Suggestion& suggestion) {
    if (found || suggestion.changes.back().key != key) return;
    found = suggestion;
    stop.request_stop();
  };
  suggest(variant, job.scene, job.plan, job.misses(), told);
  return found;
}

Plan plan_with(const Spoilt& job, const std::vector<Change>& changes) {
  Variant variant{job.task, job.options};
  for (const Change& change : changes) change.apply(variant);
  const auto scene = read_scene(variant.task);
  if (!scene) throw std::runtime_error(scene.error().message);
  return plan_or_throw(variant.task, *scene, variant.options);
}

struct Fault {
  const char* name;
  void (*spoil)(model::Task&);
  const char* cure;  ///< key of a change that must be found
};

void lay_in_short_stock(model::Task& task) {
  task.kit.pins.lengths_mm = {2.25, 2.5};
}
void weaken(model::Task& task) {
  task.kit.actuator = {1, 0.25};
}
void widen_the_grid(model::Task& task) {
  task.kit.grid.spacing_mm = 60;
  task.kit.grid.rows = 3;
}
void thicken_the_pins(model::Task& task) {
  task.kit.pins.radius_mm = 20;
  task.kit.grid.spacing_mm = 41;
  task.kit.grid.columns = 1;
}
void ask_for_wide_margins(model::Task& task) {
  task.kit.pins.min_foot_margin_mm = 18;
}

class SuggestionsFor : public testing::TestWithParam<Fault> {};

TEST_P(SuggestionsFor, hold_when_applied_and_planned_anew) {
  const Spoilt job = spoilt(GetParam().spoil);
  ASSERT_TRUE(job.plan.designs.empty());
  const auto cure = first_with(job, GetParam().cure);
  ASSERT_TRUE(cure) << "no change of " << GetParam().cure << " was found";
  const Plan cured = plan_with(job, cure->changes);
  EXPECT_GT(cure->designs, 0);
  EXPECT_EQ(cured.funnel.strong, cure->designs);
  EXPECT_EQ(cured.designs.front().squeeze.required_n, cure->best_n);
}

INSTANTIATE_TEST_SUITE_P(Faults, SuggestionsFor,
                         testing::Values(Fault{"travel", shorten_travel, "kit.jaws.separation_mm"},
                                         Fault{"stock", lay_in_short_stock, "kit.pins.lengths_mm"},
                                         Fault{"obstacle", stand_a_ring_about_it, "kit.jaws.opening_mm"},
                                         Fault{"actuator", weaken, "kit.actuator.max_squeeze_n"},
                                         Fault{"grid", widen_the_grid, "kit.grid.spacing_mm"},
                                         Fault{"pins", thicken_the_pins, "kit.pins.radius_mm"},
                                         Fault{"margin", ask_for_wide_margins,
                                               "kit.pins.min_foot_margin_mm"}),
                         [](const auto& fault) { return fault.param.name; });

TEST(Suggestion, is_the_least_of_its_ladder) {
  const Spoilt job = spoilt(shorten_travel);
  const auto cure = first_with(job, "kit.jaws.separation_mm");
  ASSERT_TRUE(cure);
  Variant variant{job.task, job.options};
  cure->changes.front().apply(variant);
  variant.task.kit.jaws.separation_mm.hi -= 1;  // one step less
  EXPECT_TRUE(plan_or_throw(variant.task, job.scene).designs.empty());
}

TEST(Suggestion, pairs_changes_where_no_single_one_helps) {
  const Spoilt job = spoilt([](model::Task& task) {
    lay_in_short_stock(task);
    weaken(task);
  });
  ASSERT_EQ(job.plan.funnel.heights, 0);
  const auto cure = first_with(job, "kit.actuator.max_squeeze_n");
  ASSERT_TRUE(cure);
  ASSERT_EQ(cure->changes.size(), 2U);
  EXPECT_EQ(plan_with(job, cure->changes).funnel.strong, cure->designs);
}

TEST(Suggestion, search_that_is_stopped_says_what_it_did_not_try) {
  const Spoilt job = spoilt(shorten_travel);
  std::stop_source stop;
  stop.request_stop();
  Variant variant{job.task, job.options};
  variant.options.stop = stop.get_token();
  const Suggestions none = suggest(variant, job.scene, job.plan, {});
  EXPECT_TRUE(none.found.empty());
  EXPECT_EQ(none.plans, 0);
  EXPECT_FALSE(none.not_tried.empty());
}

TEST(Ladders, hold_only_kits_that_a_kit_file_may_hold) {
  const Spoilt job = spoilt(shorten_travel);
  const Variant variant{job.task, job.options};
  for (const Ladder& ladder : ladders(variant, job.scene, job.plan, job.misses())) {
    for (const Change& change : ladder) {
      Variant changed = variant;
      change.apply(changed);
      EXPECT_TRUE(model::conflicts_of(changed.task.kit).empty()) << change.key << " " << change.to;
    }
  }
}

}  // namespace
}  // namespace pinjaw::planner
