// Promises: SOAK.
/// 100,000 handoffs in 30 days of virtual time. Counters start near their ends, so that the short run meets
/// every wrap that the long one does. The core has no clock that could overflow: every time in it is a
/// countdown, and `steps` is a counter that nothing waits for. Of events_ignored no cell reaches the end: an
/// event that the state table ignores is never asked of it, so this counts mistakes of the core alone.
#include <gtest/gtest.h>

#include <cstdio>
#include <set>
#include <vector>

#include "firmware_sim/core/commands.hpp"
#include "tests/firmware_sim/support/test_cell.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/nightly.hpp"

namespace pinjaw::test {
namespace {

constexpr int kIdle_ms = 10;  // one step of a cell where nothing happens
constexpr double kDays_s = 30.0 * 86400;

/// Memory of this process that is in use now, in bytes; 0 where the system does not tell.
long resident_bytes() {
  long pages = 0;
  long resident = 0;
  if (std::FILE* file = std::fopen("/proc/self/statm", "r")) {
    if (std::fscanf(file, "%ld %ld", &pages, &resident) != 2) resident = 0;
    std::fclose(file);
  }
  return resident * 4096;
}

constexpr std::uint16_t kToken = 65530;
constexpr std::uint32_t kSession = 65534;
constexpr std::uint16_t kRequest = 65500;
constexpr std::uint32_t kStep = 0xFFFFFFFFU - 2000;
constexpr std::uint32_t kRefused = 0xFFFFFFFFU;

/// Tokens, sessions, requests to the memory and counters shortly before their ends.
void age(TestCell& cell) {
  for (const int number : {1, 2, 3}) {
    core::State& firmware = cell.world().find(number)->firmware_for_tests();
    firmware.store.record.handoff_number = kToken;
    firmware.next_session = kSession;
    firmware.store.record.session_block = kSession + core::kSessionBlock;
    firmware.store.requested = kRequest;
    firmware.counters.steps = kStep;
    firmware.counters.events_refused = kRefused;
  }
}

/// Each that age() has set has passed its end, at the nodes that take part in handoffs.
void expect_all_wrapped(TestCell& cell) {
  for (const int number : {1, 2}) {
    const core::State& firmware = cell.world().find(number)->firmware();
    EXPECT_LT(firmware.store.record.handoff_number, kToken) << "tokens of " << number;
    EXPECT_GT(firmware.next_session, 65535U) << "sessions of " << number << " have passed 16 bits";
    EXPECT_GT(firmware.store.record.session_block, firmware.next_session) << number;
    EXPECT_LT(firmware.counters.steps, kStep) << "steps of " << number;
    EXPECT_LT(firmware.counters.events_refused, kRefused) << "refused events of " << number;
    EXPECT_EQ(firmware.counters.events_ignored, 0U) << number;
  }
}

/// A new session before the last sequence number of this one is used.
void renew_session(TestCell& cell, int node, int& renewals) {
  const auto& answer = cell.host().heard(node).answer;
  if (answer && answer->next_sequence < by_night(250, 10)) return;
  EXPECT_TRUE(cell.arm(node));
  ++renewals;
}

void idle(TestCell& cell, int duration_ms) {
  for (int i = 0; i < duration_ms; i += kIdle_ms) cell.advance(kIdle_ms);
}

/// A holder refuses a layout, and counts it.
void expect_no_layout_taken(TestCell& cell, int holder) {
  const TestGrip grip = arm_pedestal_pallet()[static_cast<std::size_t>(holder - 1)];
  EXPECT_EQ(cell.send_layout(grip), wire::TransferStatus::WrongState) << holder;
}

wire::FaultCode worst_fault(TestCell& cell) {
  for (const int number : {1, 2, 3}) {
    const wire::FaultCode worst = cell.world().find(number)->firmware().faults.worst();
    if (worst != wire::FaultCode::None) return worst;
  }
  return wire::FaultCode::None;
}

TEST(Soak, handoffs_for_a_month_drop_nothing_raise_no_fault_and_take_no_memory) {
  const int handoffs = by_night(100000, 60);
  const int rest_ms = by_night(static_cast<int>(1000 * kDays_s / 100000) - 1600, 1000);
  TestCell cell(arm_pedestal_pallet());
  cell.keep_logs(false);
  age(cell);
  ASSERT_TRUE(cell.commission());
  ASSERT_TRUE(cell.load(1));
  int renewals = 0;
  long before_bytes = 0;
  std::set<int> requests_wrapped;  // of which nodes; at night they wrap more than once
  int done = 0;
  for (; done < handoffs && !HasFailure(); ++done) {
    const int giver = done % 2 == 0 ? 1 : 2;
    const int receiver = 3 - giver;
    for (const int node : {giver, receiver}) renew_session(cell, node, renewals);
    ASSERT_TRUE(cell.hand_over(giver, receiver)) << "handoff " << done;
    cell.run_ms(50);
    if (done < 2) expect_no_layout_taken(cell, receiver);
    idle(cell, rest_ms);
    for (const int node : {1, 2}) {
      if (cell.world().find(node)->firmware().store.requested < kRequest) requests_wrapped.insert(node);
    }
    const bench::Truth& truth = cell.truth();
    ASSERT_FALSE(truth.dropped || truth.slipped) << "handoff " << done;
    ASSERT_GE(truth.min_holders.value_or(0), 1) << "handoff " << done;
    ASSERT_EQ(truth.holders, std::vector{receiver}) << "handoff " << done;
    ASSERT_EQ(worst_fault(cell), wire::FaultCode::None) << "handoff " << done;
    if (done == handoffs / 4) before_bytes = resident_bytes();
    if (done % 10000 == 9999) {  // hours at night
      std::printf("%d of %d handoffs\n", done + 1, handoffs);
      std::fflush(stdout);
    }
  }
  while (nightly() && !HasFailure() && cell.truth().time_s < kDays_s) idle(cell, 60000);
  const long grown_bytes = resident_bytes() - before_bytes;
  figure("SOAK", "handoffs", done);
  figure("SOAK", "simulated time", cell.truth().time_s / 86400, "days");
  figure("SOAK", "sessions renewed at the end of their sequence numbers", renewals);
  figure("SOAK", "memory grown in the last three quarters", static_cast<double>(grown_bytes) / 1024, "KiB");
  EXPECT_LT(grown_bytes, 1 << 20);
  EXPECT_GE(cell.truth().time_s, by_night(kDays_s, 0.0));
  EXPECT_FALSE(cell.truth().dropped || cell.truth().slipped);
  EXPECT_EQ(worst_fault(cell), wire::FaultCode::None);
  expect_all_wrapped(cell);
  EXPECT_EQ(requests_wrapped, (std::set{1, 2}));
  EXPECT_GT(renewals, 0);
  for (const int number : {1, 2, 3}) {
    const core::Counters& counters = cell.world().find(number)->firmware().counters;
    EXPECT_EQ(counters.bad_frames, 0U);
    EXPECT_EQ(counters.frames_not_sent, 0U);
  }
}

/// What an outsider could tell of a cell: states, facts, what is held and pressed, traffic.
struct Seen {
  std::vector<wire::State> states;
  std::vector<double> squeezes_n;
  std::vector<int> holders;
  wire::FaultCode fault = wire::FaultCode::None;
  std::uint64_t frames = 0;
};

Seen look_at(TestCell& cell) {
  Seen seen;
  for (const int number : {1, 2, 3}) {
    seen.states.push_back(cell.world().find(number)->firmware().id);
    seen.squeezes_n.push_back(cell.truth_of(number).squeeze_n);
  }
  seen.holders = cell.truth().holders;
  seen.fault = worst_fault(cell);
  seen.frames = cell.bus().load().frames;
  return seen;
}

TEST(Soak, ten_milliseconds_of_an_idle_cell_in_one_step_come_to_what_ten_steps_do) {
  Seen seen[2];
  for (const bool long_steps : {false, true}) {
    TestCell cell(arm_pedestal_pallet());
    ASSERT_TRUE(cell.commission());
    ASSERT_TRUE(cell.load(1));
    ASSERT_TRUE(cell.hand_over(1, 2));
    cell.run_ms(1000);
    const std::uint64_t before = cell.bus().load().frames;
    for (int ms = 0; ms < 20000; ms += long_steps ? kIdle_ms : 1) cell.advance(long_steps ? kIdle_ms : 1);
    seen[long_steps] = look_at(cell);
    seen[long_steps].frames -= before;
    EXPECT_TRUE(cell.hand_over(2, 1)) << "and the next handoff works";
  }
  EXPECT_EQ(seen[0].states, seen[1].states);
  EXPECT_EQ(seen[0].holders, seen[1].holders);
  EXPECT_EQ(seen[0].fault, seen[1].fault);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(seen[0].squeezes_n[i], seen[1].squeezes_n[i], 0.1);
  const double traffic = static_cast<double>(seen[1].frames) / static_cast<double>(seen[0].frames);
  figure("SOAK", "frames of long steps, of those of short ones", traffic, "share");
  EXPECT_NEAR(traffic, 1.0, 0.02);
}

}  // namespace
}  // namespace pinjaw::test
