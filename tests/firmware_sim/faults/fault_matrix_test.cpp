// Promises: E2E-MATRIX, I5, I6.
//
// Every fault of communication that AUTOSAR E2E names, on every message of the table, in every state of a
// controller: 11 x 14 x 16 cells, each with the effect it may have; the same on CAN FD under a key, and in
// every state of a passive station's handoff.
#include <gtest/gtest.h>

#include "protocol/wire/names.hpp"
#include "protocol/wire/timing.hpp"
#include "tests/firmware_sim/faults/by_hold.hpp"
#include "tests/firmware_sim/faults/disturbed_scene.hpp"
#include "tests/support/figures.hpp"

namespace pinjaw::core::test {
namespace {

using pinjaw::test::by_hold;
using wire::MessageType;

enum class Effect : std::uint8_t {
  None,      ///< nothing that the controller does changes
  Answer,    ///< only that a request is answered once more
  Hold,      ///< as a genuine GLOBAL_HOLD: the safe direction is open to everyone
  HostLost,  ///< as of a host that fell silent
  PeerLost,  ///< as of a peer that fell silent
};

constexpr int kWatched_ms = 100;  // none of the scenes changes by the bus before
constexpr int kMargin_ms = 2;     // I5: the limit and a step, and the bench's own millisecond

/// Whether that fault is a frame that is taken as genuine: of GLOBAL_HOLD no counter is asked, and anyone may
/// send it.
constexpr bool is_well_formed(Fault fault) {
  return fault == Fault::Repetition || fault == Fault::Delay || fault == Fault::Insertion ||
         fault == Fault::Addressing || fault == Fault::Sequence;
}

/// The specification of a cell whose message is not said besides.
Effect expected(Fault fault, MessageType message, Framing framing) {
  if (is_silence_fault(fault)) {
    if (message == MessageType::HostHeartbeat) return Effect::HostLost;
    const bool of_peer = message == MessageType::Custody || message == MessageType::State;
    return of_peer ? Effect::PeerLost : Effect::None;
  }
  if (message == MessageType::GlobalHold && is_well_formed(fault)) return Effect::Hold;
  if (message == MessageType::TransferRequest && framing != Framing::CanFd) return Effect::Answer;
  return Effect::None;
}

/// Where a message is said three times: which of them is the first that counts. What comes after it changes
/// nothing.
std::size_t first_that_counts(Fault fault) {
  switch (fault) {
    case Fault::Loss:
    case Fault::Asymmetric:
      return 2;
    case Fault::Delay:
    case Fault::Corruption:
      return 1;
    default:
      return 0;
  }
}

/// Messages that are not said of themselves: Scene::besides has them.
bool is_said_on_occasion(MessageType message) {
  return message == MessageType::GlobalHold || message == MessageType::Command ||
         message == MessageType::TransferRequest;
}

/// A fault that takes away or holds up what comes, and adds nothing.
bool only_takes(Fault fault) {
  return fault == Fault::Loss || is_silence_fault(fault);
}

/// What a state becomes once its host is silent; itself where it goes on as it would.
StateId without_host(StateId state) {
  switch (state) {
    case StateId::Ready:
      return StateId::Loaded;
    case StateId::Squeezing:
      return StateId::Seated;
    case StateId::Offered:
      return StateId::Hold;
    default:
      return state;
  }
}

/// What a state becomes once the peer that it watches is silent.
StateId without_peer(StateId state) {
  return state == StateId::Relax ? StateId::Resqueeze : state;
}

/// What a state becomes by the command of told_in().
StateId by_command(const Scene& scene) {
  const bool armed = scene.station.core.gate.armed();
  switch (scene.state) {
    case StateId::Loaded:
      return StateId::Ready;
    case StateId::Ready:  // a passive station has the part already
      return scene.station.config.passive ? StateId::Seated : StateId::Seating;
    case StateId::Seating:
      return StateId::Ready;
    case StateId::Seated:
      return StateId::Squeezing;
    case StateId::Hold:
      return StateId::Offered;
    case StateId::Offered:
      return StateId::Hold;
    case StateId::Relax:
      return StateId::Resqueeze;
    case StateId::FaultEmpty:
      return armed ? StateId::Ready : StateId::FaultEmpty;
    default:
      return scene.state;
  }
}

/// Nothing, or where two runs begin to differ; frames count where `frames` says so.
std::optional<std::string> first_difference(const std::vector<Moment>& clean, std::vector<Moment> other,
                                            std::size_t until_ms, bool frames) {
  for (std::size_t ms = 0; ms < until_ms; ++ms) {
    if (!frames) other[ms].said = clean[ms].said;
    if (const auto differs = difference(clean[ms], other[ms])) {
      return "at " + std::to_string(ms) + " ms " + *differs;
    }
  }
  return std::nullopt;
}

/// No valve opens that would not have opened without the fault.
bool opens_nothing(const std::vector<Moment>& clean, const std::vector<Moment>& other) {
  for (std::size_t ms = 0; ms < other.size(); ++ms) {
    if (other[ms].valves.spool == Spool::Open && clean[ms].valves.spool != Spool::Open) return false;
  }
  return true;
}

/// The scene with `frame` at `at_ms`, and without any fault.
std::vector<Moment> with(const Scene& scene, const wire::Frame& frame, int at_ms) {
  return play(scene, kWatched_ms, [&](int ms, std::vector<wire::Frame>& frames) {
    if (ms == at_ms) frames.push_back(frame);
  });
}

/// Silence from its last frame on leads to where `after` says from the state of that time, within `limit_ms`,
/// and to nothing before.
void expect_silence(const DisturbedScene& cell, const std::vector<Moment>& clean,
                    const std::vector<Moment>& other, const Scene& scene, StateId (*after)(StateId),
                    int limit_ms) {
  ASSERT_TRUE(cell.last_heard_ms()) << cell.name();
  const auto lost_ms = static_cast<std::size_t>(*cell.last_heard_ms() + limit_ms);
  EXPECT_EQ(first_difference(clean, other, lost_ms - 1, true), std::nullopt) << cell.name() << ", too early";
  EXPECT_TRUE(opens_nothing(clean, other)) << cell.name();
  const std::size_t late_ms = lost_ms + kMargin_ms;
  EXPECT_EQ(other[late_ms].state, after(clean[late_ms].state)) << cell.name();
  // what a passive station squeezes it has before it knows of a silent host
  const bool at_once = scene.station.config.passive && scene.state == StateId::Squeezing;
  if (after(scene.state) == scene.state || at_once) return;
  EXPECT_EQ(clean[late_ms].state, scene.state) << cell.name() << ": it is over before it proves anything";
}

/// The states in which a peer's silence is told as a fault: those that wait for a giver's word.
bool waits_for_giver(StateId state) {
  return state == StateId::Seating || state == StateId::Seated || state == StateId::Squeezing ||
         state == StateId::Taken;
}

bool tells(const std::vector<Moment>& moments, std::size_t until_ms, wire::FaultCode code) {
  for (std::size_t ms = 0; ms < until_ms; ++ms) {
    for (const wire::Frame& frame : moments[ms].said) {
      const auto fault = wire::parse<wire::FaultReport>(frame);
      if (fault && fault->message.code == code && fault->message.active) return true;
    }
  }
  return false;
}

void check_hold(const Scene& scene, const DisturbedScene& cell, const std::vector<Moment>& clean,
                const std::vector<Moment>& other) {
  const int at_ms = strike_ms(scene);
  const auto genuine = with(scene, wire::pack(wire::GlobalHold{}, {.node = scene.peer}), at_ms);
  EXPECT_EQ(first_difference(genuine, other, kWatched_ms, true), std::nullopt) << cell.name();
  EXPECT_TRUE(opens_nothing(clean, other)) << cell.name();
  const auto at = static_cast<std::size_t>(at_ms);
  EXPECT_EQ(other[at].state, by_hold(clean[scene.is_brief() ? at : at - 1].state)) << cell.name();
}

/// As if the first frame that counts were the only one.
void check_said(const Scene& scene, MessageType message, Fault fault, const std::vector<Moment>& clean) {
  DisturbedScene cell(scene, message, fault, true);
  const std::vector<Moment> other = cell.run();
  EXPECT_GT(cell.hits(), 0) << cell.name() << " strikes nothing";
  const std::size_t which = first_that_counts(fault);
  const int at_ms = said_ms(scene)[which];
  const auto genuine = with(scene, scene.besides.at(message)[which], at_ms);
  const bool frames = message != MessageType::TransferRequest;
  // a HOLD that comes once the jaws are open is another one
  const bool twice = fault == Fault::Delay && scene.state == StateId::Opening;
  const int until_ms = twice ? said_ms(scene)[0] + kLate_ms : kWatched_ms;
  EXPECT_EQ(first_difference(genuine, other, static_cast<std::size_t>(until_ms), frames), std::nullopt)
      << cell.name();
  if (message == MessageType::Command) {
    const StateId now = other[static_cast<std::size_t>(at_ms)].state;
    EXPECT_TRUE(scene.is_brief() || now == by_command(scene)) << cell.name() << ": " << wire::to_string(now);
    return;
  }
  EXPECT_TRUE(opens_nothing(clean, other)) << cell.name();
  const StateId was = clean[static_cast<std::size_t>(at_ms)].state;
  EXPECT_EQ(other[static_cast<std::size_t>(at_ms)].state,
            message == MessageType::GlobalHold ? by_hold(was) : was)
      << cell.name();
}

void check_host_lost(const Scene& scene, const DisturbedScene& cell, const std::vector<Moment>& clean,
                     const std::vector<Moment>& other) {
  if (scene.state != StateId::Boot) {
    return expect_silence(cell, clean, other, scene, without_host, wire::kHostFresh_ms);
  }
  EXPECT_TRUE(opens_nothing(clean, other)) << cell.name();  // it has never believed in a host
  EXPECT_EQ(other.back().state, clean.back().state) << cell.name();
}

void check_peer_lost(const Scene& scene, MessageType message, const DisturbedScene& cell,
                     const std::vector<Moment>& clean, const std::vector<Moment>& other) {
  EXPECT_TRUE(opens_nothing(clean, other)) << cell.name();
  if (scene.state == StateId::Relax) {
    return expect_silence(cell, clean, other, scene, without_peer, wire::kPeerFresh_ms);
  }
  EXPECT_EQ(first_difference(clean, other, kWatched_ms, false), std::nullopt) << cell.name();
  const bool told = message == MessageType::Custody && waits_for_giver(scene.state);
  const auto late_ms =
      static_cast<std::size_t>(cell.last_heard_ms().value_or(0) + wire::kPeerFresh_ms + kMargin_ms);
  EXPECT_EQ(tells(other, late_ms, wire::FaultCode::PeerLost), told) << cell.name();
}

void check_unsaid(const Scene& scene, MessageType message, Fault fault, const std::vector<Moment>& clean) {
  DisturbedScene cell(scene, message, fault, false);
  const std::vector<Moment> other = cell.run();
  EXPECT_GT(cell.hits(), 0) << cell.name() << " strikes nothing";
  switch (expected(fault, message, scene.framing)) {
    case Effect::None:
      EXPECT_EQ(first_difference(clean, other, kWatched_ms, true), std::nullopt) << cell.name();
      return;
    case Effect::Answer:
      EXPECT_EQ(first_difference(clean, other, kWatched_ms, false), std::nullopt) << cell.name();
      return;
    case Effect::Hold:
      return check_hold(scene, cell, clean, other);
    case Effect::HostLost:
      return check_host_lost(scene, cell, clean, other);
    case Effect::PeerLost:
      return check_peer_lost(scene, message, cell, clean, other);
  }
}

/// Of what is said on occasion, both: a fault where it is said, and where it is not.
void check(const Scene& scene, MessageType message, Fault fault, const std::vector<Moment>& clean) {
  const bool on_occasion = is_said_on_occasion(message);
  if (on_occasion) check_said(scene, message, fault, clean);
  if (!on_occasion || !only_takes(fault)) check_unsaid(scene, message, fault, clean);
}

/// Every cell; tells how many.
std::int64_t check_all(const std::vector<Scene>& scenes) {
  std::int64_t cells = 0;
  for (const Scene& scene : scenes) {
    const std::vector<Moment> clean = play(scene, kSceneLength_ms);
    const StateId struck = clean[static_cast<std::size_t>(strike_ms(scene))].state;
    EXPECT_TRUE(scene.is_brief() || struck == scene.state) << wire::to_string(scene.state) << " is over";
    for (const wire::MessageSpec& spec : wire::kMessages) {
      for (const Fault fault : kFaults) {
        check(scene, spec.type, fault, clean);
        ++cells;
      }
    }
  }
  return cells;
}

TEST(FaultMatrix, each_fault_of_each_message_in_each_state_has_its_effect_and_no_other) {
  const std::int64_t cells = check_all(scenes());
  EXPECT_EQ(cells, 16 * 14 * 11);
  pinjaw::test::figure("E2E-MATRIX", "faults x messages x states, each with its own effect", cells, "cells");
}

TEST(FaultMatrix, each_has_the_same_effect_where_every_frame_is_sealed) {
  const std::int64_t cells = check_all(scenes(Framing::CanFd));
  EXPECT_EQ(cells, 16 * 14 * 11);
  pinjaw::test::figure("E2E-MATRIX", "the same on CAN FD under a key", cells, "cells");
}

TEST(FaultMatrix, each_has_the_same_effect_at_a_passive_station) {
  const std::int64_t cells = check_all(passive_scenes());
  EXPECT_EQ(cells, 10 * 14 * 11);
  pinjaw::test::figure("E2E-MATRIX", "the same at a passive station, in the states of its handoffs", cells,
                       "cells");
}

TEST(FaultMatrix, a_channel_that_is_blocked_for_everything_opens_nothing) {
  std::vector<Scene> all = scenes();
  for (const auto& more : {scenes(Framing::CanFd), passive_scenes()})
    all.insert(all.end(), more.begin(), more.end());
  for (const Scene& scene : all) {
    const std::vector<Moment> clean = play(scene, kSceneLength_ms);
    const auto silent =
        play(scene, kSceneLength_ms, [](int, std::vector<wire::Frame>& frames) { frames.clear(); });
    EXPECT_TRUE(opens_nothing(clean, silent)) << wire::to_string(scene.state);
    if (grips(scene.state)) {
      EXPECT_TRUE(grips(silent.back().state)) << wire::to_string(scene.state);
    }
  }
}

}  // namespace
}  // namespace pinjaw::core::test
