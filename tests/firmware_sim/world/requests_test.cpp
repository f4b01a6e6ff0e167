// Promises: WORLD.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/firmware_sim/support/test_cell.hpp"

namespace pinjaw::world {
namespace {

using test::TestCell;
using ::testing::HasSubstr;

std::vector<bench::Grasp> grasps() {
  return {{1, 30, 60}, {2, 36, 40}, {3, 30, 0}};
}

std::string why(const bench::Reply& reply) {
  const auto* refused = std::get_if<bench::Refused>(&reply);
  return refused == nullptr ? "" : refused->reason;
}

bool done(const bench::Reply& reply) {
  return std::holds_alternative<bench::Done>(reply);
}

TEST(World, a_part_on_the_pallet_closes_its_seats) {
  TestCell cell(test::arm_pedestal_pallet());
  EXPECT_TRUE(done(cell.ask(bench::Place{3, grasps()})));
  cell.run_ms(5);
  EXPECT_TRUE(cell.truth_of(3).seated);
  EXPECT_EQ(cell.truth().holders, std::vector{3});
  EXPECT_EQ(cell.truth().min_holders, 1);
  EXPECT_TRUE(cell.truth().placed);
}

TEST(World, refuses_what_cannot_be_and_says_why) {
  TestCell cell(test::arm_pedestal_pallet());
  EXPECT_THAT(why(cell.ask(bench::Place{9, grasps()})), HasSubstr("no node 9"));
  EXPECT_THAT(why(cell.ask(bench::Place{3, {{9, 30, 60}}})), HasSubstr("no node 9"));
  EXPECT_THAT(why(cell.ask(bench::Place{1, {{2, 36, 40}}})), HasSubstr("no grasp of node 1"));
  EXPECT_THAT(why(cell.ask(bench::Remove{3})), HasSubstr("does not touch"));
  EXPECT_THAT(why(cell.ask(bench::Meet{{1, 9}})), HasSubstr("no node 9"));
  EXPECT_THAT(why(cell.ask(bench::Move{.node = 9})), HasSubstr("no node 9"));
  EXPECT_THAT(why(cell.ask(bench::Disturb{"d", {{9, 1}}})), HasSubstr("no node 9"));
  EXPECT_THAT(why(cell.ask(bench::Power{9, false})), HasSubstr("no node 9"));
  EXPECT_THAT(why(cell.ask(bench::Enable{9, false})), HasSubstr("no node 9"));
  EXPECT_THAT(why(cell.ask(bench::Break{9, "spool_stuck"})), HasSubstr("no node 9"));
  EXPECT_THAT(why(cell.ask(bench::Break{1, "rust"})), HasSubstr("no such fault"));
  EXPECT_TRUE(done(cell.ask(bench::Place{3, grasps()})));
  EXPECT_THAT(why(cell.ask(bench::Place{3, grasps()})), HasSubstr("there already"));
  EXPECT_THAT(why(cell.ask(bench::Meet{{1}})), HasSubstr("stay behind"));
}

TEST(World, a_station_away_cannot_touch_the_part) {
  TestCell cell(test::arm_pedestal_pallet());
  cell.ask(bench::Place{3, grasps()});
  EXPECT_TRUE(done(cell.ask(bench::Meet{{1, 3}})));
  EXPECT_TRUE(done(cell.ask(bench::Move{.node = 1})));
  cell.run_ms(5);
  EXPECT_TRUE(cell.truth_of(3).seated);
  EXPECT_FALSE(cell.truth_of(1).touches);
}

TEST(World, a_pallet_carries_the_part_away_with_it) {
  TestCell cell(test::arm_pedestal_pallet());
  cell.ask(bench::Place{3, grasps()});
  cell.ask(bench::Meet{{1, 3}});
  EXPECT_TRUE(done(cell.ask(bench::Move{.node = 3})));
  cell.run_ms(5);
  EXPECT_EQ(cell.truth().holders, std::vector{3});
}

TEST(World, a_hand_takes_a_part_from_the_pallet) {
  TestCell cell(test::arm_pedestal_pallet());
  cell.ask(bench::Place{3, grasps()});
  cell.run_ms(5);
  EXPECT_TRUE(done(cell.ask(bench::Remove{3})));
  cell.run_ms(5);
  EXPECT_FALSE(cell.truth().placed);
  EXPECT_FALSE(cell.truth().dropped);
  EXPECT_EQ(cell.truth().min_holders, 1);
  EXPECT_FALSE(cell.truth_of(3).seated);
  EXPECT_TRUE(done(cell.ask(bench::Place{3, grasps()})));
}

TEST(World, a_hand_waits_while_the_local_enable_is_held) {
  TestCell cell(test::arm_pedestal_pallet());
  cell.ask(bench::Place{3, grasps()});
  cell.ask(bench::Enable{3, true});
  cell.run_ms(5);
  EXPECT_TRUE(done(cell.ask(bench::Remove{3})));
  cell.run_ms(500);
  EXPECT_TRUE(cell.truth_of(3).seated);
  cell.ask(bench::Enable{3, false});
  cell.run_ms(5);
  EXPECT_FALSE(cell.truth().placed);
  EXPECT_FALSE(cell.truth().dropped);
}

/// The arm holds a part and lets an operator take it.
void release_into_a_hand(TestCell& cell) {
  ASSERT_TRUE(cell.commission());
  ASSERT_TRUE(cell.load(1)) << cell.event_log();
  cell.ask(bench::Enable{1, true});
  EXPECT_TRUE(done(cell.ask(bench::Remove{1})));
  cell.run_ms(50);
  EXPECT_EQ(cell.command(1, wire::manual_release_ask()).result, wire::CommandResult::Ok);
  ASSERT_TRUE(cell.run_until([&] { return cell.host().heard(1).challenge.has_value(); }, 500));
  EXPECT_EQ(cell.command(1, wire::manual_release_answer(*cell.host().heard(1).challenge)).result,
            wire::CommandResult::Ok);
  EXPECT_TRUE(cell.wait_for(1, wire::State::Ready, 2000));
  cell.ask(bench::Enable{1, false});
  cell.run_ms(5);
}

TEST(World, a_gripper_releases_the_part_into_a_hand) {
  TestCell cell(test::arm_pedestal_pallet());
  release_into_a_hand(cell);
  EXPECT_FALSE(cell.truth().placed);
  EXPECT_FALSE(cell.truth().dropped);
  EXPECT_EQ(cell.truth().min_holders, 1);
}

TEST(World, a_part_that_is_refused_leaves_everything_as_it_was) {
  TestCell cell(test::arm_pedestal_pallet());
  release_into_a_hand(cell);
  cell.ask(bench::Disturb{"spray[3]", {{2, 77}}});
  const bench::Truth before = cell.truth();
  ASSERT_GT(cell.truth_of(1).max_squeeze_n, 60) << "there is something to lose";
  ASSERT_EQ(cell.truth_of(1).needed_n, 60);
  constexpr double kWiderThanTheJaws_mm = 70;
  EXPECT_THAT(why(cell.ask(bench::Place{1, {{1, kWiderThanTheJaws_mm, 20}, {2, 50, 20}}})),
              HasSubstr("the part needs 70.00 mm"));
  EXPECT_THAT(why(cell.ask(bench::Place{1, {{2, 50, 20}}})), HasSubstr("no grasp of node 1"));
  EXPECT_EQ(bench::encode(cell.truth()), bench::encode(before));
  EXPECT_TRUE(done(cell.ask(bench::Place{1, {{1, 30, 20}}}))) << "what is not refused does change it";
  EXPECT_NE(bench::encode(cell.truth()), bench::encode(before));
}

TEST(World, a_disturbance_lasts_until_the_next_and_unnamed_stations_keep_theirs) {
  TestCell cell(test::arm_pedestal_pallet());
  cell.ask(bench::Place{3, grasps()});
  EXPECT_EQ(cell.truth().disturbance, "rest");
  cell.ask(bench::Disturb{"spray[3]", {{1, 77}}});
  EXPECT_EQ(cell.truth().disturbance, "spray[3]");
  EXPECT_EQ(cell.truth_of(1).needed_n, 77);
  EXPECT_EQ(cell.truth_of(2).needed_n, 40);
}

TEST(World, everything_asked_and_happened_is_logged) {
  TestCell cell(test::arm_pedestal_pallet());
  cell.ask(bench::Place{3, grasps()});
  cell.run_ms(2);
  cell.ask(bench::Meet{{1}});
  EXPECT_THAT(cell.event_log(), HasSubstr("0.000 done {\"place\""));
  EXPECT_THAT(cell.event_log(), HasSubstr("0.001 holders [3]"));
  EXPECT_THAT(cell.event_log(), HasSubstr("0.002 refused {\"meet\""));
  EXPECT_THAT(cell.event_log(), HasSubstr("because the part would stay behind"));
}

}  // namespace
}  // namespace pinjaw::world
