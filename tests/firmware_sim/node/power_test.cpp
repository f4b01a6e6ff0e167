// Promises: I5, I7.
#include <gtest/gtest.h>

#include "tests/firmware_sim/support/test_cell.hpp"

namespace pinjaw::node {
namespace {

using test::TestCell;

std::unique_ptr<TestCell> holding_cell() {
  auto cell = std::make_unique<TestCell>(
      std::vector<test::TestGrip>{{.node = 1, .separation_mm = 30, .needed_n = 60}});
  EXPECT_TRUE(cell->commission());
  EXPECT_TRUE(cell->load(1)) << cell->event_log();
  return cell;
}

TEST(Power, a_cut_while_holding_keeps_holding) {
  const auto owner = holding_cell();
  TestCell& cell = *owner;
  cell.ask(bench::Power{1, false});
  cell.run_ms(3000);
  EXPECT_FALSE(cell.truth().dropped);
  EXPECT_EQ(cell.truth().min_holders, 1);
  EXPECT_FALSE(cell.truth_of(1).powered);
}

TEST(Power, after_a_cut_the_controller_comes_up_holding) {
  const auto owner = holding_cell();
  TestCell& cell = *owner;
  cell.ask(bench::Power{1, false});
  cell.run_ms(1000);
  cell.ask(bench::Power{1, true});
  cell.run_ms(2000);
  EXPECT_FALSE(cell.truth().dropped);
  EXPECT_EQ(cell.truth().min_holders, 1);
  EXPECT_EQ(cell.state_of(1), wire::State::Hold);
}

/// I5: outputs stay as they were told for 50 ms at most, then the hardware holds.
TEST(Watchdog, resets_a_processor_that_hangs_and_it_comes_up_holding) {
  const auto owner = holding_cell();
  TestCell& cell = *owner;
  const Node& node = *cell.world().find(1);
  const std::uint32_t steps_before = node.firmware().counters.steps;
  cell.ask(bench::Break{1, "hang"});
  cell.run_ms(49);
  EXPECT_EQ(node.firmware().counters.steps, steps_before) << "it does nothing";
  cell.run_ms(1);
  EXPECT_EQ(node.firmware().id, wire::State::Boot) << "reset";
  EXPECT_EQ(node.told_valves(), core::Valves{});
  cell.run_ms(2000);
  EXPECT_EQ(cell.state_of(1), wire::State::Hold);
  EXPECT_TRUE(node.firmware().faults.active(wire::FaultCode::Watchdog));
  EXPECT_FALSE(cell.truth().dropped);
  EXPECT_EQ(cell.truth().min_holders, 1);
}

TEST(Watchdog, stops_jaws_that_a_hung_processor_left_closing) {
  TestCell cell({{.node = 1, .separation_mm = 30, .needed_n = 60}});
  ASSERT_TRUE(cell.commission());
  cell.ask(bench::Place{1, {{1, 30, 60}}});
  cell.ask(bench::Enable{1, true});
  cell.run_ms(50);
  cell.command(1, wire::plain_command(wire::Op::CloseLight));
  const Node& node = *cell.world().find(1);
  ASSERT_TRUE(cell.run_until([&] { return node.told_valves().spool == core::Spool::Close; }, 1000));
  cell.ask(bench::Break{1, "hang"});
  cell.run_ms(49);
  EXPECT_EQ(node.told_valves().spool, core::Spool::Close);
  cell.run_ms(1);
  EXPECT_EQ(node.told_valves(), core::Valves{});
}

TEST(Power, without_power_it_neither_hears_nor_says_anything) {
  const auto owner = holding_cell();
  TestCell& cell = *owner;
  cell.ask(bench::Power{1, false});
  cell.run_ms(10);
  const std::string before = cell.frame_log();
  cell.kill_host_at(cell.now_ms() + 1);
  EXPECT_THROW(cell.run_ms(10), test::HostKilled);
  cell.run_ms(500);
  EXPECT_LE(cell.frame_log().size(), before.size() + 40);
}

TEST(Power, air_loss_while_holding_keeps_holding) {
  const auto owner = holding_cell();
  TestCell& cell = *owner;
  cell.ask(bench::Break{1, "supply_lost"});
  cell.run_ms(3000);
  EXPECT_FALSE(cell.truth().dropped);
  EXPECT_EQ(cell.truth().min_holders, 1);
}

TEST(Power, layout_and_custody_survive_in_the_memory) {
  const auto owner = holding_cell();
  TestCell& cell = *owner;
  const Nvm& memory = cell.world().find(1)->memory();
  ASSERT_TRUE(memory.image().record);
  EXPECT_EQ(memory.image().record->custody, core::Custody::Sole);
  EXPECT_GT(memory.image().layout.size, 0);
}

}  // namespace
}  // namespace pinjaw::node
