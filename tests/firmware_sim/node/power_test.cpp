// Promises: I7.
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
