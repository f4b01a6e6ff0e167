// Promises: E2E-MATRIX, I5, I6.
//
// Every fault of communication that AUTOSAR E2E names, on every message of the table, in every state of a
// controller: 11 x 14 x 16 cells, each with the effect it may have.
#include <gtest/gtest.h>

#include <map>

#include "protocol/wire/names.hpp"
#include "protocol/wire/timing.hpp"
#include "tests/firmware_sim/faults/scenes.hpp"
#include "tests/support/figures.hpp"

namespace pinjaw::core::test {
namespace {

using wire::MessageType;

/// AUTOSAR FO, E2E protocol specification: faults of communication.
enum class Fault : std::uint8_t {
  Repetition,
  Loss,
  Delay,
  Insertion,
  Masquerade,
  Addressing,
  Sequence,
  Corruption,
  Asymmetric,  ///< this receiver alone gets other content
  Subset,      ///< this receiver alone gets nothing any more
  Blocked,     ///< nobody gets the message any more, whoever sends it
};
constexpr std::array kFaults = {Fault::Repetition, Fault::Loss,       Fault::Delay,    Fault::Insertion,
                                Fault::Masquerade, Fault::Addressing, Fault::Sequence, Fault::Corruption,
                                Fault::Asymmetric, Fault::Subset,     Fault::Blocked};
constexpr std::array kNames = {"repetition", "loss",       "delay",    "insertion",
                               "masquerade", "addressing", "sequence", "corruption",
                               "asymmetric", "subset",     "blocked"};

enum class Effect : std::uint8_t {
  None,      ///< nothing that the controller does changes
  Answer,    ///< only that a request is answered once more
  Hold,      ///< as a genuine GLOBAL_HOLD: the safe direction is open to everyone
  HostLost,  ///< as of a host that fell silent
  PeerLost,  ///< as of a peer that fell silent
};

constexpr int kFault_ms = 30;     // when something is inserted
constexpr int kWatched_ms = 100;  // none of the scenes changes by the bus before
constexpr int kMargin_ms = 2;     // I5: the limit and a step, and the bench's own millisecond

/// Whether that fault is a frame that is taken as genuine: of GLOBAL_HOLD no counter is asked, and anyone may
/// send it.
constexpr bool is_well_formed(Fault fault) {
  return fault == Fault::Repetition || fault == Fault::Delay || fault == Fault::Insertion ||
         fault == Fault::Addressing || fault == Fault::Sequence;
}

constexpr bool is_silence_fault(Fault fault) {
  return fault == Fault::Subset || fault == Fault::Blocked;
}

/// The specification of a cell.
Effect expected(Fault fault, MessageType message) {
  if (is_silence_fault(fault)) {
    if (message == MessageType::HostHeartbeat) return Effect::HostLost;
    const bool of_peer = message == MessageType::Custody || message == MessageType::State;
    return of_peer ? Effect::PeerLost : Effect::None;
  }
  if (message == MessageType::GlobalHold && is_well_formed(fault)) return Effect::Hold;
  if (message == MessageType::TransferRequest) return Effect::Answer;
  return Effect::None;
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

/// What a state becomes by HOLD.
StateId by_hold(StateId state) {
  switch (state) {
    case StateId::Squeezing:
      return StateId::Seated;
    case StateId::Offered:
      return StateId::Hold;
    case StateId::Relax:
      return StateId::Resqueeze;
    default:
      return state;
  }
}

/// The message's frames that concern a scene's controller.
std::uint32_t id_in(const Scene& scene, MessageType message) {
  const wire::MessageSpec& spec = wire::spec_of(message);
  if (!spec.per_node) return spec.base_id;
  return std::uint32_t{spec.base_id} +
         (spec.direction == wire::Direction::HostToNode ? scene.node : scene.peer);
}

bool is_of_type(const wire::Frame& frame, MessageType message) {
  const auto identifier = wire::identify(frame);
  return identifier && identifier->type == message;
}

std::uint8_t third_node(const Scene& scene) {
  return static_cast<std::uint8_t>(kArm + kPedestal + kPallet - scene.node - scene.peer);
}

/// One cell of the matrix.
class Cell {
 public:
  Cell(const Scene& scene, MessageType message, Fault fault)
      : scene_(scene), message_(message), fault_(fault), id_(id_in(scene, message)), latest_(latest()) {}

  [[nodiscard]] std::string name() const {
    return std::string(kNames[static_cast<std::size_t>(fault_)]) + " of " + wire::spec_of(message_).name +
           " in " + wire::to_string(scene_.state);
  }

  std::vector<Moment> disturbed(int ms) {
    return play(scene_, ms, [this](int at, std::vector<wire::Frame>& frames) { disturb(at, frames); });
  }

  /// When the last frame of a silence fault came; nothing where none came.
  [[nodiscard]] std::optional<int> last_heard_ms() const { return last_heard_ms_; }

 private:
  [[nodiscard]] wire::Frame latest() const {
    std::optional<wire::Frame> last;
    const auto look = [&](const std::vector<wire::Frame>& frames) {
      for (const wire::Frame& frame : frames) {
        if (frame.id == id_) last = frame;
      }
    };
    look(scene_.history);
    for (int ms = 0; ms < kFault_ms; ++ms) look(scene_.heard[static_cast<std::size_t>(ms)]);
    EXPECT_TRUE(last) << name();
    return last.value_or(wire::Frame{.id = id_});
  }

  [[nodiscard]] wire::Frame oldest() const {
    for (const wire::Frame& frame : scene_.history) {
      if (frame.id == id_) return frame;
    }
    return latest_;
  }

  /// Other content under a right checksum, not next in its row: of another session, another token.
  [[nodiscard]] wire::Frame foreign() const {
    const auto odd = static_cast<std::uint8_t>((latest_.data[1] + 7U) % wire::kCounterModulus);
    switch (message_) {
      case MessageType::Custody:
        return wire::pack(wire::Custody{.fact = wire::Fact::Retain, .peer = scene_.node, .token = 0xBAD},
                          {.node = scene_.peer, .counter = odd});
      case MessageType::State:
        return wire::pack(wire::NodeState{.state = StateId::FaultHold},
                          {.node = scene_.peer, .counter = odd});
      case MessageType::Fault:
        return wire::pack(
            wire::FaultReport{
                .code = wire::FaultCode::OverForce, .severity = wire::Severity::Hold, .active = true},
            {.node = scene_.peer, .counter = static_cast<std::uint8_t>(latest_.data[1] & 0xFU)});
      case MessageType::HostHeartbeat:
        return wire::pack(wire::HostHeartbeat{.permit = 0, .epoch = 77}, {.node = 0, .counter = odd});
      case MessageType::Command:
        return wire::pack(wire::Command{.sequence = 200, .op = wire::Op::Abort, .session = 0xBAD},
                          {.node = scene_.node});
      case MessageType::TransferRequest:
      case MessageType::TransferResponse: {
        wire::Frame segment = latest_;
        segment.data = {0x25, 1, 2, 3, 4, 5, 6, 7};  // goes on with what was never begun
        return segment;
      }
      default:
        return has_counter(latest_) ? with_counter(latest_, odd) : latest_;
    }
  }

  /// As foreign(), in what it says the latest.
  [[nodiscard]] wire::Frame out_of_sequence() const {
    if (message_ == MessageType::Command) {
      wire::Frame frame = latest_;
      frame.data[1] = static_cast<std::uint8_t>(frame.data[1] - 1U);
      return sealed(frame);
    }
    if (!has_counter(latest_)) return foreign();
    return with_counter(latest_,
                        static_cast<std::uint8_t>((latest_.data[1] % 16U + 7U) % wire::kCounterModulus));
  }

  /// A frame of the third node, or the other message of the host, as it is or under this id.
  [[nodiscard]] wire::Frame of_another() const {
    const wire::MessageSpec& spec = wire::spec_of(message_);
    if (!spec.per_node) {
      wire::Frame frame = latest_;
      frame.id = message_ == MessageType::Time ? 0x0F0 : 0x0F8;
      return frame;
    }
    for (const auto& frame : scene_.history) {
      if (frame.id == spec.base_id + std::uint32_t{third_node(scene_)}) return frame;
    }
    ADD_FAILURE() << name() << ": the third node never said it";
    return latest_;
  }

  [[nodiscard]] wire::Frame changed(wire::Frame frame, bool much) const {
    if (wire::spec_of(message_).protection == wire::Protection::None) {
      frame.data[0] = static_cast<std::uint8_t>(frame.data[0] ^ 0x40U);  // a kind that there is not
      return frame;
    }
    frame.data[4] = static_cast<std::uint8_t>(frame.data[4] ^ 0x10U);
    if (much) {
      frame.data[2] = static_cast<std::uint8_t>(~frame.data[2]);
      frame.data[5] = static_cast<std::uint8_t>(frame.data[5] ^ 0x5AU);
    }
    EXPECT_NE(frame.data[0], sealed(frame).data[0]) << name() << ": choose another error";
    return frame;
  }

  void disturb(int at, std::vector<wire::Frame>& frames) {
    const bool now = at == kFault_ms;
    switch (fault_) {
      case Fault::Repetition:
        if (now) frames.push_back(latest_);
        return;
      case Fault::Loss:
        std::erase_if(frames, [this](const wire::Frame& frame) { return frame.id == id_ && ++hit_ <= 2; });
        return;
      case Fault::Delay:
        return delay(at, frames);
      case Fault::Insertion:
        if (now) frames.push_back(foreign());
        return;
      case Fault::Masquerade:
        if (now) {
          wire::Frame frame = of_another();
          frame.id = id_;
          frames.push_back(frame);
        }
        return;
      case Fault::Addressing:
        if (now) frames.push_back(of_another());
        return;
      case Fault::Sequence:
        if (now) frames.push_back(out_of_sequence());
        return;
      case Fault::Corruption:
        return change(now, frames, false);
      case Fault::Asymmetric:
        return change(now, frames, true);
      case Fault::Subset:
      case Fault::Blocked:
        return silence(at, frames);
    }
  }

  /// The first one comes 45 ms late; where none comes at all, the oldest comes once more.
  void delay(int at, std::vector<wire::Frame>& frames) {
    constexpr int kLate_ms = 45;
    if (!delayed_) {
      const auto found = std::find_if(frames.begin(), frames.end(),
                                      [this](const wire::Frame& frame) { return frame.id == id_; });
      if (found != frames.end()) {
        delayed_ = *found;
        due_ms_ = at + kLate_ms;
        frames.erase(found);
      } else if (at == kFault_ms) {
        delayed_ = oldest();
        due_ms_ = at;
      }
    }
    if (delayed_ && at == due_ms_) frames.push_back(*delayed_);
  }

  /// The first one or two of the message come changed; where none came, a changed one comes besides.
  void change(bool now, std::vector<wire::Frame>& frames, bool much) {
    for (wire::Frame& frame : frames) {
      if (frame.id == id_ && hit_ < (much ? 2 : 1)) {
        frame = changed(frame, much);
        ++hit_;
      }
    }
    if (now && hit_ == 0) frames.push_back(changed(latest_, much));
  }

  /// After the first one, so that it is known when the last was heard.
  void silence(int at, std::vector<wire::Frame>& frames) {
    std::erase_if(frames, [&](const wire::Frame& frame) {
      const bool mine = fault_ == Fault::Subset ? frame.id == id_ : is_of_type(frame, message_);
      if (mine && !last_heard_ms_ && frame.id == id_) {
        last_heard_ms_ = at;
        return false;
      }
      return mine && last_heard_ms_.has_value();
    });
  }

  const Scene& scene_;
  MessageType message_;
  Fault fault_;
  std::uint32_t id_;
  wire::Frame latest_;
  int hit_ = 0;
  std::optional<wire::Frame> delayed_;
  int due_ms_ = 0;
  std::optional<int> last_heard_ms_;
};

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

std::vector<Moment> with_genuine_hold(const Scene& scene, int at_ms) {
  return play(scene, kWatched_ms, [&](int ms, std::vector<wire::Frame>& frames) {
    if (ms == at_ms) frames.push_back(wire::pack(wire::GlobalHold{}, {.node = scene.peer}));
  });
}

/// Silence from its last frame on leads to where `after` says from the state of that time, within `limit_ms`,
/// and to nothing before.
void expect_silence(const Cell& cell, const std::vector<Moment>& clean, const std::vector<Moment>& other,
                    StateId from, StateId (*after)(StateId), int limit_ms) {
  ASSERT_TRUE(cell.last_heard_ms()) << cell.name();
  const auto lost_ms = static_cast<std::size_t>(*cell.last_heard_ms() + limit_ms);
  EXPECT_EQ(first_difference(clean, other, lost_ms - 1, true), std::nullopt) << cell.name() << ", too early";
  EXPECT_TRUE(opens_nothing(clean, other)) << cell.name();
  const std::size_t late_ms = lost_ms + kMargin_ms;
  EXPECT_EQ(other[late_ms].state, after(clean[late_ms].state)) << cell.name();
  if (after(from) == from) return;
  EXPECT_EQ(clean[late_ms].state, from) << cell.name() << ": the scene is over before it proves anything";
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

void check(const Scene& scene, MessageType message, Fault fault, const std::vector<Moment>& clean) {
  Cell cell(scene, message, fault);
  const std::vector<Moment> other = cell.disturbed(kSceneLength_ms);
  switch (expected(fault, message)) {
    case Effect::None:
      EXPECT_EQ(first_difference(clean, other, kWatched_ms, true), std::nullopt) << cell.name();
      return;
    case Effect::Answer:
      EXPECT_EQ(first_difference(clean, other, kWatched_ms, false), std::nullopt) << cell.name();
      return;
    case Effect::Hold: {
      const auto genuine = with_genuine_hold(scene, kFault_ms);
      EXPECT_EQ(first_difference(genuine, other, kWatched_ms, true), std::nullopt) << cell.name();
      EXPECT_TRUE(opens_nothing(clean, other)) << cell.name();
      const StateId before = clean[kFault_ms - 1].state;
      EXPECT_EQ(other[kFault_ms].state, by_hold(before)) << cell.name();
      return;
    }
    case Effect::HostLost:
      if (scene.state == StateId::Boot) {  // it has never believed in a host
        EXPECT_TRUE(opens_nothing(clean, other)) << cell.name();
        EXPECT_EQ(other.back().state, clean.back().state) << cell.name();
        return;
      }
      return expect_silence(cell, clean, other, scene.state, without_host, wire::kHostFresh_ms);
    case Effect::PeerLost: {
      EXPECT_TRUE(opens_nothing(clean, other)) << cell.name();
      if (scene.state == StateId::Relax) {
        return expect_silence(cell, clean, other, scene.state, without_peer, wire::kPeerFresh_ms);
      }
      EXPECT_EQ(first_difference(clean, other, kWatched_ms, false), std::nullopt) << cell.name();
      const bool told = message == MessageType::Custody && waits_for_giver(scene.state);
      const auto late_ms =
          static_cast<std::size_t>(cell.last_heard_ms().value_or(0) + wire::kPeerFresh_ms + kMargin_ms);
      EXPECT_EQ(tells(other, late_ms, wire::FaultCode::PeerLost), told) << cell.name();
      return;
    }
  }
}

TEST(FaultMatrix, each_fault_of_each_message_in_each_state_has_its_effect_and_no_other) {
  std::int64_t cells = 0;
  for (const Scene& scene : scenes()) {
    const std::vector<Moment> clean = play(scene, kSceneLength_ms);
    for (const wire::MessageSpec& spec : wire::kMessages) {
      for (const Fault fault : kFaults) {
        check(scene, spec.type, fault, clean);
        ++cells;
      }
    }
  }
  EXPECT_EQ(cells, 16 * 14 * 11);
  pinjaw::test::figure("E2E-MATRIX", "faults x messages x states, each with its own effect", cells, "cells");
}

TEST(FaultMatrix, a_channel_that_is_blocked_for_everything_opens_nothing) {
  for (const Scene& scene : scenes()) {
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
