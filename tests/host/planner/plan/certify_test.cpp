#include "host/planner/plan/certify.hpp"

#include <algorithm>
#include <fstream>
#include <functional>
#include <limits>

#include "host/planner/plan/check_certified.hpp"
#include "host/planner/plan/plan_json.hpp"
#include "tests/host/planner/plan/planned.hpp"

namespace pinjaw::planner {
namespace {

const Planned& certified_valve() {
  static const Planned kPlanned = plan_of("valve-pedestal", {.top = 5, .certify = 3});
  return kPlanned;
}

std::vector<std::string> failures(const std::vector<Claim>& claims) {
  std::vector<std::string> failed;
  for (const Claim& claim : claims) {
    if (!claim.holds) failed.push_back(claim.claim + ": " + claim.found);
  }
  return failed;
}

TEST(Certify, tells_the_best_designs_their_worst_spray_which_no_sample_exceeds) {
  const Planned& valve = certified_valve();
  ASSERT_EQ(valve.plan.designs.size(), 5U);
  for (std::size_t i = 0; i < 5; ++i) {
    const model::Design& design = valve.plan.designs[i];
    ASSERT_EQ(design.certified.has_value(), i < 3);
    if (!design.certified) continue;
    EXPECT_NEAR(design.certified->sampled_n, design.squeeze.required_n,
                1e-6);  // sprays are all it must resist
    EXPECT_LE(design.certified->sampled_n, design.certified->high_n + 1e-6);
    EXPECT_LE(design.certified->low_n, design.certified->high_n);
    EXPECT_GE(design.certified->low_n, design.certified->sampled_n);
  }
}

TEST(Certify, is_found_again_by_check_and_its_lies_are_caught) {
  const Planned& valve = certified_valve();
  const model::Design& best = valve.plan.designs.front();
  EXPECT_EQ(failures(check_certified(valve.plan, valve.scene, best)), std::vector<std::string>{});
  const std::vector<std::function<void(model::Certified&)>> lies = {
      [](auto& c) { c.low_n -= 0.01; },      [](auto& c) { c.high_n -= 0.01; },
      [](auto& c) { c.sampled_n += 1; },     [](auto& c) { c.at_mm.z() -= 0.01; },
      [](auto& c) { c.from = -c.from; },     [](auto& c) { c.normal = -c.normal; },
      [](auto& c) { c.normal *= 1.1; },      [](auto& c) { c.spray = "hose"; },
      [](auto& c) { c.curved = !c.curved; }, [](auto& c) { c.closed = !c.closed; }};
  for (const auto& lie : lies) {
    model::Design design = best;
    lie(*design.certified);
    EXPECT_NE(failures(check_certified(valve.plan, valve.scene, design)), std::vector<std::string>{});
  }
}

TEST(Certify, comes_back_from_a_file_as_it_was) {
  const Planned& valve = certified_valve();
  Plan plan = valve.plan;
  plan.jets.front().spray.from = model::Vector3d(0, 0.6, 0.8);
  plan.jets.front().spray.within_rad = 0.5;
  plan.designs.back().certified = plan.designs.front().certified;
  plan.designs.back().certified->low_n = std::numeric_limits<double>::infinity();
  plan.designs.back().certified->high_n = std::numeric_limits<double>::infinity();
  const auto file = std::filesystem::path(testing::TempDir()) / "certified.json";
  std::ofstream(file) << to_json(plan);
  const auto read = read_plan(file);
  ASSERT_TRUE(read.has_value());
  EXPECT_EQ(to_json(*read), to_json(plan));
  EXPECT_EQ(read->jets.front().with.size(), 1U);
}

TEST(Certify, is_caught_where_it_needs_less_than_a_sample) {
  const Planned& valve = certified_valve();
  model::Design design = valve.plan.designs.front();
  design.certified->low_n = design.certified->sampled_n - 1;
  const auto failed = failures(check_certified(valve.plan, valve.scene, design));
  EXPECT_TRUE(std::ranges::any_of(failed, [](const std::string& f) {
    return f.starts_with("no sampled spray needs more than the worst one");
  }));
}

TEST(Certify, refuses_a_task_without_a_spray) {
  const Planned& other = cam();
  EXPECT_FALSE(make_plan(other.task, other.scene, {.top = 1, .certify = 1}).has_value());
}

}  // namespace
}  // namespace pinjaw::planner
