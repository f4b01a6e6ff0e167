// Promises: I3, R8, R9, MANUAL.
#include <gtest/gtest.h>

#include <functional>

#include "firmware_sim/core/commands.hpp"
#include "tests/firmware_sim/core/made_state.hpp"

/// What each command needs, and what its refusal says.
namespace pinjaw::core::test {
namespace {

using wire::CommandResult;
using wire::Op;
using wire::Reason;

struct Case {
  Answer answer;
  std::function<void(State&)> change;
};

void expect_cases(const State& good, const wire::Command& command, Event event,
                  const std::vector<Case>& cases) {
  const Decision decision = decide(good, command);
  EXPECT_EQ(decision.answer, Answer{}) << static_cast<int>(decision.answer.reason);
  EXPECT_EQ(decision.event, event);
  for (std::size_t i = 0; i < cases.size(); ++i) {
    State changed = good;
    cases[i].change(changed);
    const Answer answer = decide(changed, command).answer;
    EXPECT_EQ(answer, cases[i].answer) << "case " << i << ": " << static_cast<int>(answer.reason);
  }
}

Answer refusal(Reason reason) {
  return {CommandResult::Refused, reason};
}

void forbid(State& state) {
  state.host.hear({{0, 3}, {.permit = 0, .epoch = 77}}, kArm);
}

const std::vector<Case> kMotion = {
    {{CommandResult::NoPermit, Reason::HostSilent}, [](State& s) { s.host = {}; }},
    {{CommandResult::NoPermit, Reason::NotPermitted}, forbid},
    {{CommandResult::Busy, Reason::None}, [](State& s) { s.store.record_waits = true; }}};

std::vector<Case> with_motion(std::vector<Case> cases) {
  cases.insert(cases.end(), kMotion.begin(), kMotion.end());
  return cases;
}

std::vector<Case> with_handoff(std::vector<Case> cases) {
  cases.push_back({refusal(Reason::FaultActive), [](State& s) { s.faults.raise(wire::FaultCode::Slip); }});
  cases.push_back({refusal(Reason::Degraded), [](State& s) { s.measurement.supply_low = true; }});
  return with_motion(cases);
}

TEST(Deciding, arm) {
  const State state = made(StateId::Loaded);
  const wire::Command arm = wire::arm_command(state.layouts.crc, 77);
  expect_cases(state, arm, Event::CmdArmReady,
               {{refusal(Reason::NoLayout), [](State& s) { s.layouts.committed = false; }},
                {refusal(Reason::LayoutDiffers), [](State& s) { s.layouts.crc ^= 0x800000U; }},
                {refusal(Reason::TwoHosts),
                 [](State& s) {
                   s.host.hear({{0, 0}, {.epoch = 5}}, kArm);
                 }},
                {refusal(Reason::HostSilent), [](State& s) { s.host = {}; }},
                {{CommandResult::BadSession, Reason::WrongSession},
                 [](State& s) {
                   s.host = {};
                   hear_host(s, 78);
                 }},
                {{CommandResult::Busy, Reason::None}, [](State& s) { s.store.record_waits = true; }},
                {Answer{}, [](State& s) { s.layouts.crc ^= 0x1000000U; }}});
  State forbidden = state;
  forbid(forbidden);
  EXPECT_EQ(decide(forbidden, arm).event, Event::CmdArm);
  State faulty = state;
  faulty.faults.raise(wire::FaultCode::Slip);
  EXPECT_EQ(decide(faulty, arm).event, Event::CmdArm);
  EXPECT_EQ(decide(made(StateId::Boot), arm).answer, (Answer{CommandResult::BadState, Reason::WrongState}));
}

State open_and_ready() {
  State state = made(StateId::Ready);
  state.measurement.separation_10um = 5000;
  state.measurement.local_enable = true;
  return state;
}

const std::vector<Case> kClosing = {
    {{CommandResult::Busy, Reason::None}, [](State& s) { s.opening_wanted = true; }},
    {refusal(Reason::PartSuspected), [](State& s) { s.measurement.separation_10um = 3250; }},
    {{CommandResult::BadState, Reason::WrongState}, [](State& s) { s.id = StateId::Hold; }}};

TEST(Deciding, close_light) {
  std::vector<Case> cases = with_handoff(kClosing);
  cases.push_back({refusal(Reason::NoLocalEnable), [](State& s) { s.measurement.local_enable = false; }});
  expect_cases(open_and_ready(), wire::plain_command(Op::CloseLight), Event::CmdCloseLight, cases);
}

TEST(Deciding, accept) {
  State state = open_and_ready();
  state.measurement.local_enable = false;
  const wire::LayoutPeer pedestal = *state.layouts.layout.peer(kPedestal);
  const wire::Custody offer{
      .fact = wire::Fact::Offer, .peer = kArm, .token = 7, .pair = pedestal.pair_crc, .f_low_n = 40};
  const auto says = [](wire::Custody said) {
    return [said](State& s) {
      for (std::uint8_t counter = 3; counter < 6; ++counter) {
        s.peers.hear(wire::Received<wire::Custody>{{kPedestal, counter}, said});
      }
    };
  };
  hear_peer(state, kPedestal, offer);
  wire::Custody take = offer;
  take.fact = wire::Fact::Take;
  wire::Custody other = offer;
  other.peer = kPallet;
  wire::Custody unlike = offer;
  unlike.pair ^= 1U;
  std::vector<Case> cases = with_handoff(kClosing);
  cases.insert(cases.end(),
               {{refusal(Reason::PeerNotInLayout), [](State& s) { s.layouts.layout.peer_count = 0; }},
                {refusal(Reason::PeerNotInLayout), [](State& s) { s.peers = {}; }},
                {refusal(Reason::PeerStale), [](State& s) { s.peers.advance(70); }},
                {refusal(Reason::PeerNotOffering), says(take)},
                {refusal(Reason::PeerNotOffering), says(other)},
                {refusal(Reason::PairDiffers), says(unlike)},
                {refusal(Reason::TokenOld), [](State& s) {
                   s.store.record.seen_givers = 1U << kPedestal;
                   s.store.record.last_token[kPedestal] = 7;
                 }}});
  expect_cases(state, wire::accept_command(kPedestal), Event::CmdAccept, cases);
}

TEST(Deciding, squeeze) {
  State state = made(StateId::Seated);
  state.receiving.giver = wire::kOperatorPeer;
  const Answer over{CommandResult::Limit, Reason::ForceOverPermit};
  const Answer above{CommandResult::Limit, Reason::ForceOverLimit};
  expect_cases(state, wire::squeeze_command({520, 640}), Event::CmdSqueeze, with_handoff({}));
  EXPECT_EQ(decide(state, wire::squeeze_command({520, 639})).answer, over);
  EXPECT_EQ(decide(state, wire::squeeze_command({1280, 1400})).answer, Answer{});
  EXPECT_EQ(decide(state, wire::squeeze_command({1281, 1400})).answer, over);
  EXPECT_EQ(decide(state, wire::squeeze_command({520, 1400})).answer, Answer{});
  EXPECT_EQ(decide(state, wire::squeeze_command({520, 1401})).answer, above);
  EXPECT_EQ(decide(state, wire::squeeze_command({519, 1400})).answer, refusal(Reason::ForceUnderRequired));
  state.layouts.layout.f_limit_dn = 1000;
  EXPECT_EQ(decide(state, wire::squeeze_command({520, 1001})).answer, above);
  state.config.hardware_limit_dn = 900;
  EXPECT_EQ(decide(state, wire::squeeze_command({520, 901})).answer, above);
  EXPECT_EQ(decide(state, wire::squeeze_command({520, 900})).answer, Answer{});
}

TEST(Deciding, squeeze_of_a_passive_station_has_no_force) {
  State state = made(StateId::Seated);
  state.config.passive = true;
  state.receiving.giver = wire::kOperatorPeer;
  EXPECT_EQ(decide(state, wire::squeeze_command({0, 0})).answer, Answer{});
  EXPECT_EQ(decide(state, wire::squeeze_command({1, 0})).answer, refusal(Reason::Passive));
}

TEST(Deciding, squeeze_of_a_receiver_needs_its_givers_offer) {
  State state = made(StateId::Seated);
  state.receiving = {.giver = kPedestal, .token = 7, .pair = 8};
  EXPECT_EQ(decide(state, wire::squeeze_command({520, 1400})).answer, refusal(Reason::PeerStale));
  hear_peer(state, kPedestal,
            {.fact = wire::Fact::Offer, .peer = kArm, .token = 7, .pair = 8, .f_low_n = 40});
  EXPECT_EQ(decide(state, wire::squeeze_command({520, 1400})).answer, Answer{});
}

TEST(Deciding, offer) {
  expect_cases(
      made(StateId::Hold), wire::offer_command(kPedestal), Event::CmdOffer,
      with_handoff(
          {{refusal(Reason::PeerNotInLayout), [](State& s) { s.layouts.layout.peer_count = 0; }},
           {{CommandResult::Busy, Reason::HandoffRunning},
            [](State& s) { s.store.record.custody = Custody::Retained; }},
           {Answer{},
            [](State& s) {
              s.store.record.custody = Custody::Retained;
              s.announced.fact = wire::Fact::Retain;
            }},
           {{CommandResult::BadState, Reason::WrongState}, [](State& s) { s.id = StateId::Loaded; }}}));
}

TEST(Deciding, abort_of_an_offer_needs_nothing) {
  for (const StateId id : {StateId::Offered, StateId::Relax}) {
    State state = made(id);
    state.host = {};
    EXPECT_EQ(decide(state, wire::plain_command(Op::Abort)).answer, Answer{});
  }
}

TEST(Deciding, abort_of_a_seat_needs_somebody_else_who_answers_for_the_part) {
  State by_hand = made(StateId::Seated);
  by_hand.receiving.giver = wire::kOperatorPeer;
  by_hand.measurement.local_enable = true;
  expect_cases(
      by_hand, wire::plain_command(Op::Abort), Event::CmdAbort,
      with_motion({{refusal(Reason::NoLocalEnable), [](State& s) { s.measurement.local_enable = false; }}}));
  State from_giver = made(StateId::Seated);
  from_giver.receiving = {.giver = kPedestal, .token = 7, .pair = 8};
  hear_peer(from_giver, kPedestal,
            {.fact = wire::Fact::Offer, .peer = kArm, .token = 7, .pair = 8, .f_low_n = 40});
  expect_cases(from_giver, wire::plain_command(Op::Abort), Event::CmdAbort,
               with_motion({{refusal(Reason::PeerStale), [](State& s) { s.peers.advance(70); }},
                            {Answer{}, [](State& s) {
                               s.peers.advance(70);
                               s.receiving.retained = true;
                             }}}));
  State nobody = made(StateId::Seated);
  nobody.measurement.separation_10um = 2949;
  expect_cases(nobody, wire::plain_command(Op::Abort), Event::CmdAbort,
               with_motion({{refusal(Reason::PartSuspected),
                             [](State& s) { s.measurement.separation_10um = 2950; }}}));
}

TEST(Deciding, abort_of_a_fault_needs_its_cause_gone_and_no_custody) {
  for (const StateId id : {StateId::FaultEmpty, StateId::FaultHold}) {
    State state = made(id);
    state.receiving.giver = wire::kOperatorPeer;
    state.measurement.local_enable = true;
    expect_cases(state, wire::plain_command(Op::Abort), Event::CmdAbort,
                 {{refusal(Reason::PartHeld), [](State& s) { s.store.record.custody = Custody::Sole; }},
                  {refusal(Reason::CauseRemains), [](State& s) { s.measurement.supply_low = true; }},
                  {refusal(Reason::CauseRemains), [](State& s) { s.store.failed = true; }}});
  }
}

TEST(Deciding, open_empty) {
  State state = made(StateId::Ready);
  state.measurement.separation_10um = 2949;
  expect_cases(
      state, wire::plain_command(Op::OpenEmpty), Event::CmdOpenEmpty,
      with_motion(
          {{refusal(Reason::PartHeld), [](State& s) { s.store.record.custody = Custody::Sole; }},
           {refusal(Reason::PartSuspected), [](State& s) { s.measurement.separation_10um = 2950; }}}));
}

TEST(Deciding, clear_fault_where_there_is_none_is_always_done) {
  State state = made(StateId::Hold);
  state.measurement.trouble = SensorTrouble::Position;
  const Decision decision = decide(state, wire::plain_command(Op::ClearFault));
  EXPECT_EQ(decision.answer, Answer{});
  EXPECT_EQ(decision.event, Event::CmdClearFault);
}

TEST(Deciding, clear_fault_of_empty_jaws) {
  State state = made(StateId::FaultEmpty);
  state.measurement.separation_10um = 2949;
  expect_cases(
      state, wire::plain_command(Op::ClearFault), Event::CmdClearEmpty,
      {{refusal(Reason::CauseRemains), [](State& s) { s.measurement.trouble = SensorTrouble::Position; }},
       {refusal(Reason::CauseRemains), [](State& s) { s.store.failed = true; }},
       {refusal(Reason::PartSuspected), [](State& s) { s.measurement.separation_10um = 2950; }},
       {refusal(Reason::PartHeld), [](State& s) { s.store.record.custody = Custody::Sole; }}});
}

TEST(Deciding, clear_fault_of_a_holder) {
  State state = made(StateId::FaultHold);
  state.store.record.custody = Custody::Sole;
  expect_cases(
      state, wire::plain_command(Op::ClearFault), Event::CmdClearFault,
      {{refusal(Reason::CauseRemains), [](State& s) { s.measurement.trouble = SensorTrouble::Position; }},
       {Answer{}, [](State& s) { s.store.failed = true; }},
       {refusal(Reason::NoLayout), [](State& s) { s.layouts.committed = false; }},
       {refusal(Reason::NoLocalEnable), [](State& s) { s.store.record.custody = Custody::Empty; }},
       {Answer{}, [](State& s) {
          s.store.record.custody = Custody::Empty;
          s.measurement.local_enable = true;
        }}});
  state.store.record.custody = Custody::Released;
  state.measurement.separation_10um = 2949;
  EXPECT_EQ(decide(state, wire::plain_command(Op::ClearFault)).event, Event::CmdClearEmpty);
}

TEST(Deciding, manual_release) {
  State state = made(StateId::Hold);
  state.measurement.local_enable = true;
  expect_cases(state, wire::manual_release_ask(), Event::CmdManualAsk,
               {{refusal(Reason::NoLocalEnable), [](State& s) { s.measurement.local_enable = false; }},
                {{CommandResult::Busy, Reason::HandoffRunning},
                 [](State& s) { s.store.record.custody = Custody::Retained; }}});
  state.challenge = 99;
  state.timers.challenge.start(1);
  expect_cases(state, wire::manual_release_answer(99), Event::CmdManualRelease,
               {{refusal(Reason::NoLocalEnable), [](State& s) { s.measurement.local_enable = false; }},
                {refusal(Reason::ChallengeWrong), [](State& s) { s.timers.challenge.stop(); }},
                {{CommandResult::Busy, Reason::HandoffRunning},
                 [](State& s) { s.store.record.custody = Custody::Retained; }},
                {refusal(Reason::ChallengeWrong), [](State& s) { s.challenge = 98; }}});
  state.store.record.custody = Custody::Retained;
  state.announced.fact = wire::Fact::Retain;
  EXPECT_EQ(decide(state, wire::manual_release_answer(99)).event, Event::CmdManualRelease);
  for (const std::uint8_t step : {std::uint8_t{0}, std::uint8_t{3}}) {
    EXPECT_EQ(decide(state, {.op = Op::ManualRelease, .argument = step}).answer,
              refusal(Reason::BadArgument));
  }
}

TEST(Deciding, hold_and_disarm_need_nothing) {
  EXPECT_EQ(decide(made(StateId::Taken), wire::hold_command()).answer, Answer{});
  EXPECT_EQ(decide(made(StateId::Taken), wire::hold_command()).event, Event::CmdHold);
  EXPECT_EQ(decide(made(StateId::Ready), wire::plain_command(Op::Disarm)).event, Event::CmdDisarm);
}

}  // namespace
}  // namespace pinjaw::core::test
