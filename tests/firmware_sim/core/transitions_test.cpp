// Promises: T-TABLE, R1, R5, R6, R7, R8, R10, I6.
#include "firmware_sim/core/transitions.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <string>

#include "firmware_sim/core/custody.hpp"
#include "protocol/wire/names.hpp"
#include "tests/firmware_sim/core/made_state.hpp"

/// Every event in every state: what it leaves behind, and that it leaves all else alone.
namespace pinjaw::core::test {
namespace {

using enum wire::State;
using wire::FaultCode;

/// All that an event may change, by name.
using Seen = std::map<std::string, std::int64_t>;

Seen seen(State state) {
  const NvmRecord& record = state.store.record;
  const ForceControl& control = state.control;
  Seen all{{"id", static_cast<int>(state.id)},
           {"armed", state.gate.armed()},
           {"ignored", state.counters.events_ignored},
           {"refused", state.counters.events_refused},
           {"opening wanted", state.opening_wanted},
           {"frozen", state.frozen},
           {"hold proven", state.hold_proven},
           {"answer seen", state.answer_seen},
           {"readable", state.store.readable},
           {"record waits", state.store.record_waits},
           {"layout waits", state.store.layout_waits},
           {"permit", state.permit_dn},
           {"set", state.force_set_dn},
           {"reference", state.reference_10um},
           {"giver", state.receiving.giver},
           {"token", state.receiving.token},
           {"pair", state.receiving.pair},
           {"retained", state.receiving.retained},
           {"flow", static_cast<int>(control.flow)},
           {"control reference", control.reference_dn},
           {"integral", control.integral_ubar},
           {"blocked", control.blocked_ms},
           {"starved", control.starved_ms},
           {"refilling", control.refilling},
           {"asked", control.asked_ms},
           {"push", control.push_mdn},
           {"state time", state.timers.state.left_ms()},
           {"stable time", state.timers.stable.left_ms()},
           {"peer time", state.timers.peer_good.left_ms()},
           {"challenge time", state.timers.challenge.left_ms()},
           {"custody", static_cast<int>(record.custody)},
           {"record peer", record.peer},
           {"record token", record.token},
           {"record pair", record.pair},
           {"handoffs", record.handoff_number},
           {"record set", record.force_set_dn},
           {"record permit", record.permit_dn},
           {"givers", record.seen_givers}};
  for (std::size_t i = 0; i < record.last_token.size(); ++i) {
    all["last token " + std::to_string(i)] = record.last_token[i];
  }
  for (std::size_t i = 0; i < record.outcomes.size(); ++i) {
    const Outcome& outcome = record.outcomes[i];
    all["outcome " + std::to_string(i)] =
        (((std::int64_t{outcome.retained} << 8 | outcome.peer) << 16) | outcome.token) << 16 | outcome.pair;
  }
  for (const FaultCode code : wire::kFaultCodes) {
    const std::string name = wire::to_string(code);
    all["fault " + name] = state.faults.active(code);
    all["report " + name] = 0;
  }
  for (FaultCode code = state.faults.take_report(); code != FaultCode::None;
       code = state.faults.take_report()) {
    all["report " + std::string(wire::to_string(code))] = 1;
  }
  return all;
}

/// What the specification makes of `before`. Rules are named by what they are for; the order is free.
struct Specified {
  const State& before;
  Event event;
  Seen left = seen(before);

  void raise(FaultCode code) {
    const std::string name = wire::to_string(code);
    if (!before.faults.active(code)) left["report " + name] = 1;
    left["fault " + name] = 1;
    if (severity_of(code) >= wire::Severity::Hold) left["armed"] = 0;
  }
  void clear(FaultCode code) {
    const std::string name = wire::to_string(code);
    if (before.faults.active(code)) left["report " + name] = 1;
    left["fault " + name] = 0;
  }
  void clear_all() {
    for (const FaultCode code : wire::kFaultCodes) clear(code);
  }
  void no_force() { left["permit"] = left["set"] = 0; }
  void no_control() {
    for (const char* part :
         {"flow", "control reference", "integral", "blocked", "starved", "refilling", "asked", "push"})
      left[part] = 0;
  }
  void receive(std::uint8_t giver, std::uint16_t token, std::uint16_t pair) {
    left["giver"] = giver;
    left["token"] = token;
    left["pair"] = pair;
    left["retained"] = 0;
  }
  void note_handoff(std::uint8_t peer, std::uint16_t token, std::uint16_t pair) {
    left["record peer"] = peer;
    left["record token"] = token;
    left["record pair"] = pair;
  }
  /// Together with the forces that hold now.
  void record(Custody custody) {
    left["custody"] = static_cast<int>(custody);
    left["record set"] = left["set"];
    left["record permit"] = left["permit"];
    left["record waits"] = 1;
    const bool over = custody == Custody::Released || custody == Custody::Retained;
    if (!over || left["record peer"] == wire::kOperatorPeer) return;
    for (int i = 3; i > 0; --i)
      left["outcome " + std::to_string(i)] = left["outcome " + std::to_string(i - 1)];
    left["outcome 0"] =
        ((static_cast<std::int64_t>(custody == Custody::Retained) << 8 | left["record peer"]) << 16 |
         left["record token"])
            << 16 |
        left["record pair"];
  }
  void grip_here() {
    left["reference"] = before.measurement.separation_10um;
    left["stable time"] = 150;
  }
  /// F_set of the record, but at least F_req + u of the layout; a passive station has none.
  void force_of_record() {
    left["permit"] = before.store.record.permit_dn;
    left["set"] = before.config.passive ? 0 : std::max<std::int64_t>(before.store.record.force_set_dn, 520);
    no_control();
  }
  /// 0.5 s and the way at 30 mm/s.
  void time_to(std::int32_t separation_10um) {
    const std::int32_t way_10um = separation_10um - before.measurement.separation_10um;
    left["state time"] = 500 + (way_10um < 0 ? -way_10um : way_10um) / 3;
  }

  void fault() {
    switch (event) {
      case Event::BootBad:
      case Event::RecordNone:
      case Event::StoreFault:
        return raise(FaultCode::CustodyMemory);
      case Event::NoPart:
        return raise(FaultCode::NoPart);
      case Event::Misseated:
        return raise(FaultCode::MisSeated);
      case Event::OverForce:
        return raise(FaultCode::OverForce);
      case Event::SqueezeTimeout:
      case Event::HoldLost:
        return raise(FaultCode::HoldLost);
      case Event::Slip:
        return raise(FaultCode::Slip);
      case Event::OpenTimeout:
        return raise(FaultCode::ValveStuck);
      case Event::SensorFault:
        return raise(FaultCode::Position);
      case Event::PeerLost:
        return raise(FaultCode::PeerLost);
      case Event::PeerSilent:
        return raise(FaultCode::InDoubt);
      case Event::CmdManualRelease:
        return raise(FaultCode::ManualRelease);
      default:
        return;
    }
  }

  void come_to(StateId to) {  // NOLINT(readability-function-size): a case for each state
    const Receiving& receiving = before.receiving;
    const NvmRecord& found = before.store.record;
    left["id"] = static_cast<int>(to);
    switch (to) {
      case Loaded:
        left["armed"] = left["opening wanted"] = 0;
        no_force();
        if (event != Event::CmdClearEmpty) return;
        clear_all();
        left["readable"] = 1;
        receive(0, 0, 0);
        note_handoff(0, 0, 0);
        return record(Custody::Empty);
      case Ready:
        no_force();
        left["opening wanted"] = !before.config.passive && event != Event::CmdArmReady;
        if (event == Event::CmdAbort) clear_all();
        if (event == Event::Opened) record(Custody::Released);
        return;
      case Seating:
        left["opening wanted"] = 0;
        no_control();
        time_to(3000);
        note_handoff(receiving.giver, receiving.token, receiving.pair);
        left["custody"] = static_cast<int>(Custody::Empty);
        left["record waits"] = 1;
        if (receiving.giver == wire::kOperatorPeer) return;
        left["last token " + std::to_string(receiving.giver)] = receiving.token;
        left["givers"] = found.seen_givers | 1 << receiving.giver;
        return;
      case Seated:
        no_force();
        if (event == Event::CmdHold) {
          left["frozen"] = 1;
          left["armed"] = 0;
        }
        if (before.id != Taken) return;
        clear(FaultCode::InDoubt);
        left["retained"] = 1;
        return record(Custody::Empty);
      case Squeezing:
        left["state time"] = 2000;
        no_control();
        left["control reference"] = std::min<std::int32_t>(before.measurement.squeeze.measured_dn, 700);
        return grip_here();
      case Taken:
        left["state time"] = 2000;
        left["hold proven"] = before.id == Squeezing;
        if (before.id == Squeezing) {
          note_handoff(receiving.giver, receiving.token, receiving.pair);
          return record(Custody::Latched);
        }
        receive(found.peer, found.token, found.pair);
        force_of_record();
        return grip_here();
      case Hold:
        return come_to_hold();
      case Offered:
        left["handoffs"] = found.handoff_number + 1;
        note_handoff(found.peer, static_cast<std::uint16_t>(found.handoff_number + 1),
                     before.layouts.layout.peer(found.peer)->pair_crc);
        left["answer seen"] = 0;
        left["state time"] = 30'000;
        left["peer time"] = 60;
        return record(Custody::Offered);
      case Relax:
        left["state time"] = 200;
        return;
      case Resqueeze:
        if (before.id == Recover) force_of_record();
        return grip_here();
      case Opening:
        time_to(5000);
        if (event == Event::RecordDecided) return;
        if (event == Event::CmdManualRelease) left["record peer"] = wire::kOperatorPeer;
        return record(Custody::Decided);
      case FaultEmpty:
        left["opening wanted"] = 0;
        return;
      default:
        return;
    }
  }

  void come_to_hold() {
    switch (before.id) {
      case Squeezing:
        receive(0, 0, 0);
        note_handoff(wire::kOperatorPeer, 0, 0);
        left["hold proven"] = 1;
        record(Custody::Sole);
        break;
      case Taken:
        receive(0, 0, 0);
        left["hold proven"] = 1;
        clear(FaultCode::InDoubt);
        record(Custody::Sole);
        break;
      case Offered:
      case Resqueeze:
        left["report HANDOFF_ABORTED"] = 1;
        record(Custody::Retained);
        break;
      default:
        force_of_record();
        left["stable time"] = 150;
    }
    left["reference"] = before.measurement.separation_10um;
  }

  void stay() {
    const bool free = !grips(before.id) && before.id != Opening;
    if (event == Event::CmdHold && free) {
      left["opening wanted"] = left["armed"] = 0;
      left["frozen"] = 1;
    }
    if (event == Event::CmdWrite || event == Event::CmdDisarm || event == Event::CmdCommit) left["armed"] = 0;
    if (event == Event::CmdCommit) {
      left["opening wanted"] = 0;
      no_force();
    }
    if (event == Event::CmdOpenEmpty || event == Event::CmdAbort)
      left["opening wanted"] = !before.config.passive;
    if (event == Event::Opened) record(Custody::Released);
    if (event == Event::HoldLost && before.id == Taken && !before.config.passive) {
      const std::int64_t limit_dn = std::min<std::int64_t>(before.layouts.layout.f_limit_dn,
                                                           before.permit_dn == 0 ? 0xFFFF : before.permit_dn);
      left["set"] = std::max(left["set"], limit_dn - before.config.uncertainty_dn);
    }
  }

  Seen result() {
    const Reaction what = reaction(kStateTable, before.id, event);
    if (what.kind == ReactionKind::Ignored) ++left["ignored"];
    if (what.kind == ReactionKind::Refused) ++left["refused"];
    if (what.kind == ReactionKind::Ignored || what.kind == ReactionKind::Refused) return left;
    fault();
    if (event == Event::CmdClearFault) clear_all();
    if (what.kind == ReactionKind::Stay) stay();
    if (what.kind == ReactionKind::Go) come_to(what.next);
    return left;
  }
};

/// Nothing in it is as any event leaves it; every flag is `flag`.
State disturbed(StateId id, bool flag) {
  State state = made(id);
  state.gate.open(5);
  state.permit_dn = 900;
  state.force_set_dn = 700;
  state.reference_10um = 2990;
  state.measurement.separation_10um = 3101;
  state.measurement.trouble = SensorTrouble::Position;
  squeeze_with(state, 650);
  state.opening_wanted = state.frozen = state.hold_proven = state.answer_seen = flag;
  state.store.readable = state.store.record_waits = flag;
  state.receiving = {.giver = kPedestal, .token = 17, .pair = 18, .retained = flag};
  state.control = {Flow::Relieving, 111, 222, 33, 44, flag, 55, 66};
  state.timers.state.start(5);
  state.timers.stable.start(6);
  state.timers.peer_good.start(7);
  state.timers.challenge.start(8);
  state.store.record = {.custody = Custody::Latched,
                        .peer = kPallet,
                        .token = 37,
                        .pair = 28,
                        .handoff_number = 26,
                        .force_set_dn = 333,
                        .permit_dn = 444,
                        .seen_givers = 1U << 9};
  for (std::uint16_t i = 0; i < 16; ++i)
    state.store.record.last_token[i] = static_cast<std::uint16_t>(100 + i);
  for (std::uint8_t i = 0; i < 4; ++i) {
    state.store.record.outcomes[i] = {.retained = i == 1,
                                      .peer = static_cast<std::uint8_t>(4 + i),
                                      .token = static_cast<std::uint16_t>(40 + i),
                                      .pair = static_cast<std::uint16_t>(50 + i)};
  }
  return state;
}

void expect_as_specified(const State& before, Event event) {
  Specified specified{before, event};
  const Seen wanted = specified.result();
  State after = before;
  const bool heeded = apply(after, event);
  const ReactionKind kind = reaction(kStateTable, before.id, event).kind;
  EXPECT_EQ(heeded, kind == ReactionKind::Stay || kind == ReactionKind::Go);
  const Seen got = seen(after);
  if (got == wanted) return;
  for (const auto& [what, value] : wanted) {
    EXPECT_EQ(got.at(what), value) << what << ": " << wire::to_string(before.id) << " by event "
                                   << static_cast<int>(event);
  }
}

void expect_everywhere(void (*change)(State&)) {
  for (std::size_t s = 0; s < kStates; ++s) {
    for (std::size_t e = 0; e < kEvents; ++e) {
      for (const bool flag : {false, true}) {
        State before = disturbed(static_cast<StateId>(s), flag);
        change(before);
        expect_as_specified(before, static_cast<Event>(e));
      }
    }
  }
}

TEST(EveryEvent, in_every_state_changes_what_is_specified_and_nothing_else) {
  expect_everywhere([](State&) {});
}

TEST(EveryEvent, clears_and_raises_faults_that_were_there) {
  expect_everywhere([](State& state) {
    for (const FaultCode code : wire::kFaultCodes) state.faults.raise(code);
    while (state.faults.take_report() != FaultCode::None) {
    }
  });
}

TEST(EveryEvent, of_a_passive_station_moves_no_jaws_and_sets_no_force) {
  expect_everywhere([](State& state) { state.config.passive = true; });
}

TEST(EveryEvent, with_the_operator_as_giver_and_peer_remembers_no_token_and_no_outcome) {
  expect_everywhere([](State& state) {
    state.receiving.giver = wire::kOperatorPeer;
    if (state.id != Hold) state.store.record.peer = wire::kOperatorPeer;
  });
}

TEST(EveryEvent, takes_up_a_recorded_force_over_the_least) {
  expect_everywhere([](State& state) { state.store.record.force_set_dn = 800; });
}

TEST(EveryEvent, starts_a_ramp_at_what_presses_now_within_nothing_and_the_set_point) {
  State state = disturbed(Seated, false);
  for (const auto& [measured_dn, reference_dn] :
       {std::pair{-5, 0}, {0, 0}, {650, 650}, {700, 700}, {701, 700}}) {
    squeeze_with(state, measured_dn);
    State after = state;
    apply(after, Event::CmdSqueeze);
    EXPECT_EQ(after.control.reference_dn, reference_dn);
  }
}

TEST(EveryEvent, gives_a_move_a_minute_at_most) {
  State state = disturbed(Ready, false);
  for (const auto& [separation_10um, time_ms] : {std::pair{3000, 500},
                                                 {3003, 501},
                                                 {2997, 501},
                                                 {181'497, 59'999},
                                                 {181'500, 60'000},
                                                 {200'000, 60'000}}) {
    state.measurement.separation_10um = separation_10um;
    State after = state;
    apply(after, Event::CmdAccept);
    EXPECT_EQ(after.timers.state.left_ms(), time_ms) << separation_10um;
  }
}

TEST(EveryEvent, of_bad_sensors_sets_the_fault_of_what_is_bad) {
  State state = disturbed(Hold, false);
  state.measurement.trouble = SensorTrouble::PressureRange;
  apply(state, Event::SensorFault);
  EXPECT_TRUE(state.faults.active(FaultCode::PressureRange));
  EXPECT_FALSE(state.faults.active(FaultCode::Position));
}

TEST(Raising, a_fault_ends_the_session_where_the_node_must_hold) {
  for (const FaultCode code : wire::kFaultCodes) {
    State state = disturbed(Ready, false);
    raise(state, code);
    EXPECT_EQ(state.faults.active(code), code != FaultCode::None);
    EXPECT_EQ(state.gate.armed(), severity_of(code) < wire::Severity::Hold) << wire::to_string(code);
  }
}

}  // namespace
}  // namespace pinjaw::core::test
