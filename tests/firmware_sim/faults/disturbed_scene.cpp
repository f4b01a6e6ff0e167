#include "tests/firmware_sim/faults/disturbed_scene.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "protocol/wire/names.hpp"

namespace pinjaw::core::test {
namespace {

using wire::MessageType;

constexpr std::array kNames = {"repetition", "loss",       "delay",    "insertion",
                               "masquerade", "addressing", "sequence", "corruption",
                               "asymmetric", "subset",     "blocked"};
constexpr std::array kFramings = {"", ", commands sealed", ", on CAN FD"};

constexpr int kStrike_ms = 30;
constexpr int kAgain_ms = 5;
constexpr int kStrikeOpening_ms = kAgain_ms;  // the bench's jaws are open after 14
constexpr int kLost = 2;                      // so many a counter allows

/// The message's frames that concern a scene's controller.
std::uint32_t id_in(const Scene& scene, MessageType message) {
  const wire::MessageSpec& spec = wire::spec_of(message);
  if (!spec.per_node) return spec.base_id;
  return std::uint32_t{spec.base_id} +
         (spec.direction == wire::Direction::HostToNode ? scene.node : scene.peer);
}

std::uint8_t third_node(const Scene& scene) {
  return static_cast<std::uint8_t>(kArm + kPedestal + kPallet - scene.node - scene.peer);
}

}  // namespace

int strike_ms(const Scene& scene) {
  if (scene.is_brief()) return 0;
  return scene.state == StateId::Opening ? kStrikeOpening_ms : kStrike_ms;
}

std::array<int, 3> said_ms(const Scene& scene) {
  const int first_ms = std::max(0, strike_ms(scene) - 2 * kAgain_ms);
  return {first_ms, first_ms + kAgain_ms, first_ms + 2 * kAgain_ms};
}

DisturbedScene::DisturbedScene(const Scene& scene, MessageType message, Fault fault, bool said)
    : scene_(scene), message_(message), fault_(fault), id_(id_in(scene, message)) {
  if (said) said_ = scene.besides.at(message);
  latest_ = latest();
}

std::string DisturbedScene::name() const {
  return std::string(kNames[static_cast<std::size_t>(fault_)]) + " of " + wire::spec_of(message_).name +
         (said_.empty() ? "" : ", which is said,") + " in " + wire::to_string(scene_.state) + " of node " +
         std::to_string(scene_.node) + kFramings[static_cast<std::size_t>(scene_.framing)];
}

std::vector<Moment> DisturbedScene::run() {
  const std::array<int, 3> at_ms = said_ms(scene_);
  return play(scene_, kSceneLength_ms, [&](int at, std::vector<wire::Frame>& frames) {
    for (std::size_t i = 0; i < said_.size(); ++i) {
      if (at == at_ms[i]) frames.push_back(said_[i]);
    }
    disturb(at, frames);
  });
}

wire::Frame DisturbedScene::latest() const {
  if (!said_.empty()) return strike_ms(scene_) < kStrike_ms ? said_[0] : said_[1];
  std::optional<wire::Frame> last;
  const auto look = [&](const std::vector<wire::Frame>& frames) {
    for (const wire::Frame& frame : frames) {
      if (frame.id == id_) last = frame;
    }
  };
  look(scene_.history);
  for (int ms = 0; ms < strike_ms(scene_); ++ms) look(scene_.heard[static_cast<std::size_t>(ms)]);
  EXPECT_TRUE(last) << name();
  return last.value_or(wire::Frame{.id = id_});
}

wire::Frame DisturbedScene::oldest() const {
  for (const wire::Frame& frame : scene_.history) {
    if (frame.id == id_) return frame;
  }
  return latest_;
}

/// foreign_content() by somebody who has no key.
wire::Frame DisturbedScene::foreign() const {
  wire::Frame frame = foreign_content();
  frame.kind = latest_.kind;
  frame.length = latest_.length;
  frame.tail = latest_.tail;
  return frame;
}

/// Other content under a right checksum, not next in its row: of another session, another token.
wire::Frame DisturbedScene::foreign_content() const {
  const auto odd = static_cast<std::uint8_t>((latest_.data[1] + 7U) % wire::kCounterModulus);
  switch (message_) {
    case MessageType::Custody:
      return wire::pack(wire::Custody{.fact = wire::Fact::Retain, .peer = scene_.node, .token = 0xBAD},
                        {.node = scene_.peer, .counter = odd});
    case MessageType::State:
      return wire::pack(wire::NodeState{.state = StateId::FaultHold}, {.node = scene_.peer, .counter = odd});
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
wire::Frame DisturbedScene::out_of_sequence() const {
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
wire::Frame DisturbedScene::of_another() const {
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

wire::Frame DisturbedScene::changed(wire::Frame frame, bool much) const {
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

void DisturbedScene::disturb(int at, std::vector<wire::Frame>& frames) {
  const bool now = at == strike_ms(scene_);
  switch (fault_) {
    case Fault::Repetition:
      if (now) insert(frames, latest_);
      return;
    case Fault::Loss:
      return lose(frames);
    case Fault::Delay:
      return delay(at, frames);
    case Fault::Insertion:
      if (now) insert(frames, foreign());
      return;
    case Fault::Masquerade:
      if (now) {
        wire::Frame frame = of_another();
        frame.id = id_;
        insert(frames, frame);
      }
      return;
    case Fault::Addressing:
      if (now) insert(frames, of_another());
      return;
    case Fault::Sequence:
      if (now) insert(frames, out_of_sequence());
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

void DisturbedScene::insert(std::vector<wire::Frame>& frames, const wire::Frame& frame) {
  frames.push_back(frame);
  ++hits_;
}

void DisturbedScene::lose(std::vector<wire::Frame>& frames) {
  std::erase_if(frames, [this](const wire::Frame& frame) {
    const bool lost = frame.id == id_ && hits_ < kLost;
    hits_ += lost ? 1 : 0;
    return lost;
  });
}

/// The first one comes late; where none comes at all, the oldest comes once more.
void DisturbedScene::delay(int at, std::vector<wire::Frame>& frames) {
  if (!delayed_) {
    const auto found = std::find_if(frames.begin(), frames.end(),
                                    [this](const wire::Frame& frame) { return frame.id == id_; });
    if (found != frames.end()) {
      delayed_ = *found;
      due_ms_ = at + kLate_ms;
      frames.erase(found);
    } else if (at == strike_ms(scene_)) {
      delayed_ = oldest();
      due_ms_ = at;
    }
  }
  if (delayed_ && at == due_ms_) insert(frames, *delayed_);
}

/// The first one or two of the message come changed; where none came, a changed one comes besides.
void DisturbedScene::change(bool now, std::vector<wire::Frame>& frames, bool much) {
  for (wire::Frame& frame : frames) {
    if (frame.id == id_ && hits_ < (much ? 2 : 1)) {
      frame = changed(frame, much);
      ++hits_;
    }
  }
  if (now && hits_ == 0) insert(frames, changed(latest_, much));
}

/// After the first one, so that it is known when the last was heard.
void DisturbedScene::silence(int at, std::vector<wire::Frame>& frames) {
  std::erase_if(frames, [&](const wire::Frame& frame) {
    const bool mine = fault_ == Fault::Subset ? frame.id == id_ : type_of(frame) == message_;
    if (mine && !last_heard_ms_ && frame.id == id_) {
      last_heard_ms_ = at;
      return false;
    }
    const bool taken = mine && last_heard_ms_.has_value();
    hits_ += taken ? 1 : 0;
    return taken;
  });
}

}  // namespace pinjaw::core::test
