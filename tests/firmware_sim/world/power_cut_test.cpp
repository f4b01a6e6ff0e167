// Promises: I7, I2, I2c.
// Any controller of a handoff loses power at any moment: the part stays held, and the handoff can be done
// after all.
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/firmware_sim/support/test_cell.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/nightly.hpp"

namespace pinjaw::world {
namespace {

using test::TestCell;
using wire::State;

constexpr int kDark_ms = 40;
constexpr int kSettle_ms = 3500;  // a doubted offer, a resqueeze, or an opening that goes on

struct Handoff {
  int giver;
  int receiver;
};
constexpr Handoff kHandoffs[] = {{3, 1}, {1, 2}, {2, 1}, {1, 3}};

/// The part is where the handoff begins.
void prepare(TestCell& cell, Handoff handoff) {
  ASSERT_TRUE(cell.commission());
  ASSERT_TRUE(cell.load(handoff.giver));
}

/// What an operator's host does with two nodes that stand still: the receiver lets go of what it has not
/// latched, and the handoff is tried again.
bool finish(TestCell& cell, Handoff handoff) {
  if (cell.state_of(handoff.receiver) == State::Hold) return true;
  for (const int node : {handoff.giver, handoff.receiver}) cell.arm(node);
  if (cell.state_of(handoff.receiver) != State::Ready) {
    cell.command(handoff.receiver, wire::plain_command(wire::Op::Abort));
    if (!cell.wait_for(handoff.receiver, State::Ready, 2000)) return false;
    cell.run_ms(1500);  // until its jaws are open
  }
  if (cell.state_of(handoff.giver) == State::Offered) {
    cell.command(handoff.giver, wire::plain_command(wire::Op::Abort));
    cell.run_ms(200);
  }
  return cell.hand_over(handoff.giver, handoff.receiver);
}

/// True where the part was held throughout and is the receiver's in the end.
void expect_held_and_done(Handoff handoff, int cut_node, int after_ms) {
  TestCell cell(test::arm_pedestal_pallet());
  prepare(cell, handoff);
  const auto power = [&cell, cut_node](bool on) { cell.ask(bench::Power{.node = cut_node, .on = on}); };
  cell.at(cell.now_ms() + after_ms, [=] { power(false); });
  cell.at(cell.now_ms() + after_ms + kDark_ms, [=] { power(true); });
  const std::string where = std::to_string(handoff.giver) + " to " + std::to_string(handoff.receiver) +
                            ", node " + std::to_string(cut_node) + " dark after " + std::to_string(after_ms) +
                            " ms\n";
  cell.hand_over(handoff.giver, handoff.receiver);
  cell.run_ms(kSettle_ms);
  EXPECT_TRUE(finish(cell, handoff)) << where << cell.event_log();
  const bench::Truth truth = cell.truth();
  EXPECT_FALSE(truth.dropped) << where << cell.event_log();
  EXPECT_GE(truth.min_holders.value_or(0), 1) << where << cell.event_log();
}

int duration_ms(Handoff handoff) {
  TestCell cell(test::arm_pedestal_pallet());
  prepare(cell, handoff);
  const int from_ms = cell.now_ms();
  EXPECT_TRUE(cell.hand_over(handoff.giver, handoff.receiver));
  return cell.now_ms() - from_ms;
}

TEST(PowerCut, of_any_controller_at_any_moment_of_a_handoff_leaves_the_part_held) {
  const int step_ms = test::nightly() ? 7 : 431;  // prime: no period of the bus is met again and again
  int cuts = 0;
  for (const Handoff handoff : kHandoffs) {
    const int last_ms = duration_ms(handoff);
    for (const int node : {handoff.giver, handoff.receiver}) {
      for (int after_ms = 1 + 37 * node; after_ms < last_ms; after_ms += step_ms) {
        expect_held_and_done(handoff, node, after_ms);
        ++cuts;
      }
    }
  }
  test::figure("I7", "power cuts in handoffs with the part held and handed over after all", cuts, "cuts");
}

}  // namespace
}  // namespace pinjaw::world
