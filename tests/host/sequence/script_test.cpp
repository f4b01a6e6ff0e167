#include "host/sequence/script.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "tests/host/sequence/small_cell.hpp"

namespace pinjaw::sequence {
namespace {

using model::HandoffStep;
using model::PlaceStep;
using model::RemoveStep;
using model::RotateStep;
using model::SprayStep;

base::Expected<std::vector<StepScript>> script(std::vector<model::Step> steps) {
  model::Sequence sequence = testing::cleaning();
  sequence.steps = std::move(steps);
  Crew crew = Crew::of(sequence.cell, testing::small_cell().design, testing::small_cell().scene).value();
  return script_of(sequence, crew, testing::small_cell().scene);
}

std::string refusal(std::vector<model::Step> steps) {
  const auto scripts = script(std::move(steps));
  return scripts ? "none" : scripts.error().message;
}

TEST(Script, sets_up_first_and_then_plays_every_step) {
  const auto scripts = script(testing::cleaning().steps);
  ASSERT_TRUE(scripts) << scripts.error().message;
  ASSERT_EQ(scripts->size(), 12U);
  EXPECT_EQ(scripts->at(0).name, "set up");
  EXPECT_EQ(scripts->at(2).name, "handoff pallet to arm");
  EXPECT_EQ(scripts->at(2).tries, 3);
  EXPECT_EQ(scripts->at(7).name, "rotate arm by 180 deg");
}

TEST(Script, knows_what_loads_need_of_the_station_that_holds_the_part) {
  const auto scripts = script(testing::cleaning().steps).value();
  const auto& stations = testing::small_cell().design.stations;
  EXPECT_GT(scripts.at(5).needed_n, 0);  // spray on the pedestal
  EXPECT_EQ(scripts.at(5).required_n, stations.at(1).design.squeeze.required_n);
  EXPECT_EQ(scripts.at(8).required_n, stations.at(0).design.squeeze.required_n);
}

TEST(Script, refuses_a_handoff_from_where_the_part_is_not) {
  EXPECT_EQ(refusal({HandoffStep{"pallet", "arm"}}),
            "step 1: handoff pallet to arm: the part is not at pallet then");
  EXPECT_EQ(refusal({PlaceStep{"pallet"}, HandoffStep{"arm", "pedestal"}}),
            "step 2: handoff arm to pedestal: the part is not at arm then");
}

TEST(Script, refuses_a_handoff_of_a_part_turned_over) {
  EXPECT_EQ(refusal({PlaceStep{"pallet"}, HandoffStep{"pallet", "arm"},
                     RotateStep{"arm", std::numbers::pi, 2, 6}, HandoffStep{"arm", "pedestal"}}),
            "step 4: handoff arm to pedestal: arm is turned by 180.0 deg then; rotate it back first");
}

TEST(Script, lets_a_part_be_turned_and_turned_back) {
  EXPECT_EQ(
      refusal({PlaceStep{"pallet"}, HandoffStep{"pallet", "arm"}, RotateStep{"arm", std::numbers::pi, 2, 6},
               RotateStep{"arm", std::numbers::pi, 2, 6}, HandoffStep{"arm", "pedestal"}}),
      "none");
}

TEST(Script, refuses_a_second_part_and_what_is_done_to_none) {
  EXPECT_EQ(refusal({PlaceStep{"pallet"}, PlaceStep{"arm"}}),
            "step 2: place on arm: the part is at pallet already");
  EXPECT_EQ(refusal({RemoveStep{"pallet"}}), "step 1: remove from pallet: the part is not at pallet then");
  EXPECT_EQ(refusal({PlaceStep{"pallet"}, SprayStep{"arm", 1, 4, 1}}),
            "step 2: spray on arm: the part is not there then");
}

TEST(Script, turns_an_empty_station_without_turning_the_part) {
  EXPECT_EQ(refusal({PlaceStep{"pallet"}, RotateStep{"arm", 1, 2, 6}, RemoveStep{"pallet"}}), "none");
}

}  // namespace
}  // namespace pinjaw::sequence
