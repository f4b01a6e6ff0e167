// Promises: SLIP.
/// From a part's file to the part between the jaws: a design of the real planner, its layout in a real
/// controller, its disturbances in the world. What the planner says is needed is where the part begins to
/// slip.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "host/config/read.hpp"
#include "host/planner/force/squeeze.hpp"
#include "host/planner/plan/layout.hpp"
#include "host/planner/plan/plan.hpp"
#include "tests/firmware_sim/support/test_cell.hpp"
#include "tests/support/places.hpp"

namespace pinjaw::test {
namespace {

constexpr double kUncertainty_n = 12;  // the kit's, and the controller's
constexpr double kNear = 0.03;         // of the needed squeeze: over what friction leaves unsure

planner::Plan make_block_plan() {
  const auto task = config::read_task(source_dir("tests/host/sequence/small/grip-below.yaml"));
  if (!task) throw std::runtime_error(base::render(task.error(), "no task"));
  const auto scene = planner::read_scene(*task);
  if (!scene) throw std::runtime_error(scene.error().message);
  auto plan = planner::make_plan(*task, *scene, {.top = 0});
  if (!plan) throw std::runtime_error(plan.error().message);
  return std::move(*plan);
}

/// Every design of a block that is sprayed and shaken.
const planner::Plan& block_plan() {
  static const planner::Plan kPlan = make_block_plan();
  return kPlan;
}

/// The first, middle and last of the designs that need more than a controller's least set point.
std::vector<model::Design> some_designs() {
  std::vector<model::Design> all;
  for (const model::Design& design : block_plan().designs) {
    if (design.squeeze.required_n > 45) all.push_back(design);
  }
  if (all.size() < 3) throw std::runtime_error("the block has too few designs that need 45 N");
  return {all.front(), all[all.size() / 2], all.back()};
}

/// What the planner says that `design` needs under each of its plan's disturbances.
std::vector<double> needs_n(const model::Design& design) {
  const planner::Plan& plan = block_plan();
  planner::SqueezeSolver solver(planner::grasp_of(design, plan.friction));
  std::vector<double> needs;
  for (const model::Disturbance& disturbance : plan.disturbances) {
    const auto outcome =
        solver.least_squeeze(planner::turned(disturbance.wrench, plan.side), plan.friction_model);
    needs.push_back(std::max(0.0, std::get<planner::Required>(outcome).force_n));
  }
  return needs;
}

/// A controller that was sent the design's layout, but to hold with `hold_n`, and holds the part.
class Grip {
 public:
  Grip(const model::Design& design, double hold_n) : cell_({grip_of(design, hold_n)}) {
    EXPECT_TRUE(cell_.commission());
    EXPECT_TRUE(cell_.load(1)) << design.id << ' ' << hold_n;
    cell_.run_ms(500);
  }
  double squeeze_n() { return cell_.truth_of(1).squeeze_n; }
  /// Whether the part slipped within 3 s of what needs `needed_n` of this grip.
  bool slips_under(double needed_n) {
    cell_.ask(bench::Disturb{"load", {{1, needed_n}}});
    cell_.run_ms(3000);
    EXPECT_EQ(cell_.truth().slipped, cell_.truth().dropped) << "what goes on slipping falls";
    return cell_.truth().slipped;
  }

 private:
  static TestGrip grip_of(const model::Design& design, double hold_n) {
    const planner::Plan& plan = block_plan();
    auto layout = planner::layout_of({plan.kit, design, plan.part.sha256});
    if (!layout) throw std::runtime_error(layout.error().message);
    layout->f_required_dn = static_cast<std::uint16_t>(std::lround(hold_n * 10));
    return {.node = 1, .separation_mm = design.jaw_separation_mm, .needed_n = 0, .layout = *layout};
  }
  TestCell cell_;
};

TEST(PlannedSlip, the_plan_s_squeeze_is_the_most_that_any_of_its_disturbances_needs) {
  for (const model::Design& design : some_designs()) {
    EXPECT_NEAR(std::ranges::max(needs_n(design)), design.squeeze.required_n, 1e-6) << design.id;
  }
}

TEST(PlannedSlip, a_controller_that_was_sent_the_plan_s_layout_holds_the_part_under_all_its_disturbances) {
  for (const model::Design& design : some_designs()) {
    Grip grip(design, design.squeeze.required_n);
    EXPECT_GE(grip.squeeze_n(), design.squeeze.required_n) << design.id;
    EXPECT_FALSE(grip.slips_under(design.squeeze.required_n)) << design.id;
  }
}

TEST(PlannedSlip, a_little_more_squeeze_than_the_plan_needs_holds_and_a_little_less_slips) {
  for (const model::Design& design : some_designs()) {
    const double needed_n = design.squeeze.required_n;
    // Friction and the controller's doubt stand between what it is told and what it gives: found once.
    const double surplus_n = Grip(design, needed_n).squeeze_n() - needed_n;
    EXPECT_LT(std::abs(surplus_n), 2 * kUncertainty_n);
    for (const double excess : {kNear, -kNear}) {
      Grip grip(design, needed_n * (1 + excess) - surplus_n);
      EXPECT_EQ(grip.squeeze_n() < needed_n, excess < 0) << design.id;
      EXPECT_NEAR(grip.squeeze_n() / needed_n, 1, 2 * kNear) << design.id;
      EXPECT_EQ(grip.slips_under(needed_n), excess < 0) << design.id << ' ' << grip.squeeze_n();
    }
  }
}

TEST(PlannedSlip, where_the_worst_disturbance_moves_the_part_one_that_needs_less_than_the_squeeze_does_not) {
  const model::Design design = some_designs().front();
  const double needed_n = design.squeeze.required_n;
  const double surplus_n = Grip(design, needed_n).squeeze_n() - needed_n;
  std::vector<double> milder = needs_n(design);
  std::erase_if(milder, [&](double need_n) { return need_n > needed_n * (1 - 2 * kNear); });
  ASSERT_FALSE(milder.empty());
  Grip grip(design, needed_n * (1 - kNear) - surplus_n);
  EXPECT_FALSE(grip.slips_under(std::ranges::max(milder)));
  EXPECT_TRUE(grip.slips_under(needed_n));
}

}  // namespace
}  // namespace pinjaw::test
