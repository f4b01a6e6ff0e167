#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>

#include "protocol/wire/cmac.hpp"
#include "protocol/wire/codec.hpp"
#include "protocol/wire/timing.hpp"

/// CAN FD between those who share a key (docs/authentication.md): the classic frame's 8 bytes, then the low 8
/// bits of its freshness and 24 bits of a CMAC over id, bytes and the whole freshness. Ids and messages are
/// those of the table; whoever is behind a SecuredLink sees classic frames only.
namespace pinjaw::wire {

/// Counts the frames of one sender: 48 bits, never the same twice, resets and restarts included.
using FrameNumber = std::uint64_t;

inline constexpr std::uint32_t kSynchronisationId = 0x0E0;  ///< + source; no message of the table
inline constexpr std::uint8_t kEveryone = 15;

/// A link-layer frame by which a receiver learns a sender's freshness: the question says the asker's, the
/// answer is bound to that very question. So neither can be said again later.
struct Synchronisation {
  std::uint8_t source = 0;            ///< 0: a host
  std::uint8_t receiver = kEveryone;  ///< whose question is answered; everyone: this is a question
  FrameNumber number = 0;             ///< the sender's newest
};

namespace detail {

using Tail = std::array<std::uint8_t, 4>;

constexpr Tail tail_of(const Key& key, std::span<const std::uint8_t> message, FrameNumber number) {
  const AesBlock mac = cmac(key, message);
  return {static_cast<std::uint8_t>(number & 0xFFU), mac[0], mac[1], mac[2]};
}

constexpr Tail frame_tail(const Key& key, std::uint32_t id, const Payload& data, FrameNumber number) {
  std::array<std::uint8_t, 16> message{};
  ByteWriter out(message);
  out.put(static_cast<unsigned>(MacOf::Frame) | (id >> 8 & 7U), 1);
  out.put(id & 0xFFU, 1);
  for (const std::uint8_t byte : data) out.put(byte, 1);
  out.put(number, 6);
  return tail_of(key, message, number);
}

/// `asked`: the number in the question that is answered; of a question 0.
constexpr Tail synchronisation_tail(const Key& key, const Synchronisation& said, FrameNumber asked) {
  std::array<std::uint8_t, 15> message{};
  ByteWriter out(message);
  out.put(static_cast<std::uint8_t>(MacOf::Synchronisation), 1);
  out.put(said.source, 1);
  out.put(said.receiver, 1);
  out.put(said.number, 6);
  out.put(asked, 6);
  return tail_of(key, message, said.number);
}

constexpr Frame synchronisation_frame(const Key& key, const Synchronisation& said, FrameNumber asked) {
  Frame frame{.id = kSynchronisationId + said.source, .kind = FrameKind::Fd, .length = kFdLength};
  frame.data = to_payload(std::uint64_t{said.receiver} | said.number << 16);
  frame.tail = synchronisation_tail(key, said, asked);
  return frame;
}

constexpr std::optional<Synchronisation> synchronisation_of(const Frame& frame) {
  if (frame.id < kSynchronisationId || frame.id > kSynchronisationId + kLastNode) return std::nullopt;
  const std::uint64_t word = to_word(frame.data);
  return Synchronisation{.source = static_cast<std::uint8_t>(frame.id - kSynchronisationId),
                         .receiver = static_cast<std::uint8_t>(word & 0xFFU),
                         .number = word >> 16};
}

/// Whose frame it says it is: 0 for a host's. By itself, not by the table, which a controller need not keep.
/// What a host says to all has node 0 in its id.
constexpr std::uint8_t sender_of(const Identifier& identifier) {
  const bool to_node =
      identifier.type == MessageType::Command || identifier.type == MessageType::TransferRequest;
  return to_node ? kHostNode : identifier.node;
}
static_assert([] {
  for (const MessageSpec& spec : kMessages) {
    const bool host = spec.direction == Direction::HostToAll || spec.direction == Direction::HostToNode;
    const std::uint8_t node = spec.per_node ? 7 : 0;
    if (sender_of({spec.type, node}) != (host ? kHostNode : node)) return false;
  }
  return true;
}());

/// HOLD and GLOBAL_HOLD are obeyed from anyone.
constexpr bool asks_to_hold(const Frame& frame) {
  if (parse<GlobalHold>(frame)) return true;
  const auto command = parse<Command>(frame);
  return command && command->message.op == Op::Hold;
}

}  // namespace detail

/// Seals what one node, or a host, says and opens what it hears of up to kSenders others.
template <std::size_t kSenders>
class SecuredLink {
 public:
  static constexpr std::uint16_t kAsk_ms = 100;  ///< between two questions: a node more, so that none collide
  static constexpr unsigned kWindow = 32;
  static constexpr std::uint8_t kMisses = 3;  ///< wrong MACs of a sender after which it must be asked anew

  constexpr SecuredLink() = default;
  /// `first`: a number that this sender has never used, nor any after it.
  constexpr SecuredLink(std::uint8_t self, FrameNumber first) : number_(first), self_(self) {}

  /// Whom it hears: a bit for each source, kSenders at most. One more takes the first's place.
  constexpr void follow(std::uint16_t sources) { sources_ = sources; }

  /// The next number to be used.
  [[nodiscard]] constexpr FrameNumber next_number() const { return number_; }

  constexpr Frame seal(const Key& key, const Frame& frame) {
    Frame sealed = frame;
    sealed.kind = FrameKind::Fd;
    sealed.length = kFdLength;
    sealed.tail = detail::frame_tail(key, frame.id, frame.data, number_++);
    return sealed;
  }

  /// The classic frame in `frame`, where it is authentic and fresh, or asks to hold.
  constexpr std::optional<Frame> open(const Key& key, const Frame& frame) {
    Frame classic = frame;
    classic.kind = frame.kind == FrameKind::Fd ? FrameKind::Data : frame.kind;
    classic.length = frame.kind == FrameKind::Fd && frame.length == kFdLength ? 8 : frame.length;
    classic.tail = {};
    if (detail::asks_to_hold(classic)) return classic;
    if (frame.kind != FrameKind::Fd || frame.length != kFdLength || frame.extended) return refuse();
    if (const auto said = detail::synchronisation_of(frame)) {
      synchronise(key, *said, frame.tail);
      return std::nullopt;
    }
    const auto identifier = identify(classic);
    if (!identifier) return refuse();
    const std::uint8_t source = detail::sender_of(*identifier);
    if (!follows(source)) return std::nullopt;
    if (!is_fresh(key, place_of(source), frame)) return refuse();
    return classic;
  }

  /// What the link itself has to say, to be asked for once a step after frames were opened.
  constexpr std::optional<Frame> speak(const Key& key, std::uint16_t elapsed_ms) {
    pause_.advance(elapsed_ms);
    if (asker_ != kNobody) {
      const Synchronisation answer{.source = self_, .receiver = asker_, .number = number_ - 1};
      asker_ = kNobody;
      return detail::synchronisation_frame(key, answer, question_);
    }
    if (!strangers_ || pause_.running()) return std::nullopt;
    strangers_ = false;
    pause_.start(static_cast<std::uint16_t>(kAsk_ms + self_));
    asked_ = number_++;
    for (Sender& sender : senders_) sender.answers = 0;
    return detail::synchronisation_frame(key, {.source = self_, .number = asked_}, 0);
  }

  /// A sender became unknown by wrong MACs since this was asked last.
  constexpr bool take_alarm() { return std::exchange(alarm_, false); }
  /// Frames that were not authentic.
  [[nodiscard]] constexpr std::uint32_t refused() const { return refused_; }
  /// `source` has answered, and its frames have been authentic since.
  [[nodiscard]] constexpr bool knows(std::uint8_t source) const {
    for (const Sender& sender : senders_) {
      if (sender.source == source) return sender.known;
    }
    return false;
  }

 private:
  static constexpr std::uint8_t kNobody = 0xFF;

  /// A sender's newest number, in parts (no padding), and which of the 32 up to it were taken: an urgent
  /// frame overtakes others of its sender on the bus.
  struct Sender {
    std::uint32_t high = 0;
    std::uint32_t taken = 0;  ///< bit i: the number i below the newest
    std::uint16_t low = 0;
    std::uint8_t source = kNobody;
    bool known : 1 = false;
    std::uint8_t misses : 3 = 0;
    std::uint8_t answers : 3 = 0;  ///< looked at since the last question

    [[nodiscard]] constexpr FrameNumber newest() const { return FrameNumber{high} << 16 | low; }
    /// The number near the newest that ends in `tail`: up to 31 below it, or up to 224 above.
    [[nodiscard]] constexpr FrameNumber near(std::uint8_t tail) const {
      const auto ahead = static_cast<std::uint8_t>(tail - low);
      constexpr std::uint8_t kOldest = 0x100 - kWindow + 1;
      return ahead >= kOldest ? newest() + ahead - 0x100 : newest() + ahead;
    }
    /// `number` is one that near() gives, and authentic. False where it was taken before.
    constexpr bool take(FrameNumber number) {
      if (number > newest()) {
        const FrameNumber ahead = number - newest();
        taken = ahead >= kWindow ? 1U : taken << ahead | 1U;
        high = static_cast<std::uint32_t>(number >> 16);
        low = static_cast<std::uint16_t>(number & 0xFFFFU);
        return true;
      }
      const std::uint32_t bit = std::uint32_t{1} << (newest() - number);
      if ((taken & bit) != 0) return false;
      taken |= bit;
      return true;
    }
    /// Its newest is `number`, and nothing before it is taken any more.
    constexpr void learn(FrameNumber number) {
      *this = {.high = static_cast<std::uint32_t>(number >> 16),
               .taken = ~std::uint32_t{0},
               .low = static_cast<std::uint16_t>(number & 0xFFFFU),
               .source = source,
               .known = true};
    }
  };
  constexpr std::nullopt_t refuse() {
    ++refused_;
    return std::nullopt;
  }

  [[nodiscard]] constexpr bool follows(std::uint8_t source) const {
    return source != self_ && source <= kLastNode && (sources_ >> source & 1U) != 0;
  }

  /// The place of a source that is followed: its own, else one of somebody who no longer is, else the first.
  constexpr Sender& place_of(std::uint8_t source) {
    Sender* place = &senders_[0];
    for (Sender& sender : senders_) {
      if (sender.source == source) return sender;
      if (!follows(sender.source)) place = &sender;
    }
    *place = Sender{.source = source};
    return *place;
  }

  /// `frame` is authentic and one that its sender had not said before; three that are not authentic make the
  /// sender unknown.
  constexpr bool is_fresh(const Key& key, Sender& sender, const Frame& frame) {
    if (!sender.known) {
      strangers_ = true;
      return false;
    }
    const FrameNumber number = sender.near(frame.tail[0]);
    if (frame.tail == detail::frame_tail(key, frame.id, frame.data, number)) return sender.take(number);
    if (++sender.misses >= kMisses) {
      sender.known = false;
      strangers_ = true;
      alarm_ = true;
    }
    return false;
  }

  constexpr void synchronise(const Key& key, const Synchronisation& said, const detail::Tail& tail) {
    const bool asks = said.receiver == kEveryone;
    if (said.source == self_ || (!asks && (said.receiver != self_ || !follows(said.source)))) return;
    if (!asks) {
      Sender& sender = place_of(said.source);
      if (sender.known || sender.answers >= kMisses || asked_ == 0) return;
      ++sender.answers;
    }
    if (tail != detail::synchronisation_tail(key, said, asks ? 0 : asked_)) {
      ++refused_;
    } else if (!asks) {
      place_of(said.source).learn(said.number);
    } else if (asker_ == kNobody) {
      asker_ = said.source;
      question_ = said.number;
    }
  }

  FrameNumber number_ = 1;
  FrameNumber asked_ = 0;     ///< our number in the last question; 0: none was asked
  FrameNumber question_ = 0;  ///< what `asker_` said
  std::uint32_t refused_ = 0;
  std::uint16_t sources_ = 0xFFFF;
  Countdown pause_;  ///< until the next question
  std::uint8_t self_ = 0;
  std::uint8_t asker_ = kNobody;
  bool strangers_ = true;  ///< somebody spoke whom we do not know, or we know nobody yet
  bool alarm_ = false;
  std::array<Sender, kSenders> senders_{};
};

}  // namespace pinjaw::wire
