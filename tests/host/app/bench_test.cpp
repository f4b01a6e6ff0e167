#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "tests/host/app/child.hpp"

/// Buses, cells and runs.
namespace pinjaw::app_test {
namespace {

using nlohmann::json;
using testing::HasSubstr;

class Buses : public testing::TestWithParam<const char*> {
 protected:
  Buses() {
    bench_.write("plan.json",
                 bench_.pinjaw("plan " + shipped("configs/tasks/l-plate.yaml") + " --top 1").out);
  }
  Bench bench_;
};

TEST_P(Buses, within_one_command_are_refused_with_the_name_of_one_that_is_not) {
  const Ran ran = bench_.pinjaw(GetParam());
  EXPECT_EQ(ran.exit_code, 2);
  EXPECT_EQ(ran.out, "");
  EXPECT_THAT(ran.err, HasSubstr("can:"));
}

TEST_P(Buses, that_are_not_there_are_told_with_the_way_out) {
  const Ran ran = bench_.pinjaw(std::string(GetParam()) + " --bus can:nosuch0");
  EXPECT_EQ(ran.exit_code, 5);
  EXPECT_EQ(ran.out, "");
  EXPECT_THAT(ran.err, testing::AnyOf(HasSubstr("vcan-run"), HasSubstr("type vcan")));
  EXPECT_EQ(std::count(ran.err.begin(), ran.err.end(), '\n'), 1);
}

TEST_P(Buses, may_be_named_by_the_environment) {
  bench_.set("PINJAW_BUS=can:nosuch0");
  EXPECT_EQ(bench_.pinjaw(GetParam()).exit_code, 5);
  EXPECT_EQ(bench_.pinjaw(std::string(GetParam()) + " --bus sim:").exit_code,
            2);  // the command line comes first
}

INSTANTIATE_TEST_SUITE_P(Commands, Buses,
                         testing::Values("jaw status --node 1", "jaw hold --node 1",
                                         "send plan.json --node 1"),
                         [](const auto& command) { return "no_" + std::to_string(command.index); });

/// The shipped cell with a small prismatic part and small kits; the arm's pins are short enough to share the
/// part.
class SmallCell : public testing::Test {
 protected:
  SmallCell() {
    const std::string grid = "grid: {spacing_mm: 11.1125, columns: 2, rows: 5, edge_offset_mm: 5.55625}\n";
    const std::string pins = ", min_engagement_mm: 1.0, protrusion_mm: 1.0}\n";
    const std::string short_pins = grid + "pins: {radius_mm: 2.38125, lengths_mm: [10]" + pins;
    const std::string actuator = "actuator: {max_squeeze_n: 140, force_uncertainty_n: 12}\n";
    const std::string jaws = "jaws: {separation_mm: [0, 60], plate_gap_mm: 2.0}\n";
    bench_.write("arm-kit.yaml", "kit: arm\n" + short_pins + jaws + actuator);
    bench_.write("pedestal-kit.yaml", "kit: pedestal\n" + short_pins + jaws + actuator);
    bench_.write("pallet-kit.yaml",
                 "kit: pallet\n" + short_pins + "jaws: {separation_mm: [0, 60], plate_gap_mm: 0}\n");
    const std::string part = "part: {file: " + shipped("configs/parts/cam.yaml") + ", mass_kg: 0.1}\n";
    const std::string loads =
        "friction: 0.3\nalways: [{gravity: [0, 0, -1]}]\ndisturbances:\n"
        "  - acceleration: {peak_g: 1, along: [[1, 0, 0], [0, 1, 0], [0, 0, 1]]}\n";
    bench_.write("arm.yaml", "task: arm\n" + part + "kit: arm-kit.yaml\nside: above\n" + loads);
    bench_.write("pedestal.yaml", "task: pedestal\n" + part + "kit: pedestal-kit.yaml\n" + loads);
    bench_.write("pallet.yaml",
                 "task: pallet\n" + part + "kit: pallet-kit.yaml\nfriction: 0.3\ndisturbances: []\n");
    const std::string adjust = "adjust: {x_mm: [-40, 40], y_mm: [-40, 40], theta_deg: [-180, 180]}}\n";
    bench_.write("cell.yaml", "cell: small\n" + part +
                                  "stations:\n"
                                  "  - {name: arm, node: 1, task: arm.yaml, " +
                                  adjust + "  - {name: pedestal, node: 2, task: pedestal.yaml, " + adjust +
                                  "  - {name: pallet, node: 3, task: pallet.yaml, grips: false, " + adjust +
                                  "handoffs: [[pallet, arm], [arm, pedestal]]\n");
    bench_.write("sequence.yaml",
                 "sequence: small\ncell: cell.yaml\ndesign: best\nsteps:\n  - place: {on: pallet}\n"
                 "  - handoff: {from: pallet, to: arm}\n  - handoff: {from: arm, to: pedestal}\n");
  }
  Bench bench_;
};

TEST_F(SmallCell, has_designs_that_can_hand_the_part_over) {
  const Ran ran = bench_.pinjaw("cell cell.yaml -o cell.json --top 5");
  EXPECT_EQ(ran.exit_code, 0) << ran.err;
  EXPECT_THAT(ran.out, HasSubstr("combinations of all stations"));
  const json plan = json::parse(bench_.read("cell.json"));
  EXPECT_EQ(plan.at("format"), "pinjaw-cell/1");
  EXPECT_EQ(plan.at("designs").size(), 5U);
  EXPECT_EQ(bench_.pinjaw("cell cell.yaml --top 5").out, bench_.read("cell.json"));
}

TEST_F(SmallCell, tells_what_a_run_would_do_and_speaks_to_nobody) {
  const Ran ran = bench_.pinjaw("run sequence.yaml --dry --bus can:nosuch0");
  EXPECT_EQ(ran.exit_code, 0) << ran.err;
  EXPECT_THAT(ran.out, HasSubstr("cell design "));
}

TEST_F(SmallCell, runs_its_sequence_on_the_in_process_bus_the_same_each_time) {
  const Ran ran = bench_.pinjaw("run sequence.yaml --report run.json --log run.log --seed 5");
  EXPECT_EQ(ran.exit_code, 0) << ran.err << ran.out;
  EXPECT_THAT(ran.out, HasSubstr("the part was never dropped"));
  EXPECT_EQ(json::parse(bench_.read("run.json")).at("result"), "done");
  const Ran again = bench_.pinjaw("run sequence.yaml --log again.log --seed 5 --json");
  EXPECT_EQ(json::parse(again.out), json::parse(bench_.read("run.json")));
  EXPECT_EQ(bench_.read("again.log"), bench_.read("run.log"));
}

TEST_F(SmallCell, is_not_run_on_a_bus_that_is_not_there_or_unknown) {
  EXPECT_EQ(bench_.pinjaw("run sequence.yaml --bus can:nosuch0 --report run.json").exit_code, 5);
  const Ran unknown = bench_.pinjaw("run sequence.yaml --bus usb:0 --report run.json");
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_THAT(unknown.err, HasSubstr("can:IFACE"));
  EXPECT_EQ(bench_.pinjaw("run sequence.yaml --world w").exit_code, 2);
  EXPECT_FALSE(bench_.has("run.json"));
}

}  // namespace
}  // namespace pinjaw::app_test
