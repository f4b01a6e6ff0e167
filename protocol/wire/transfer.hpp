#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "protocol/wire/bits.hpp"
#include "protocol/wire/timing.hpp"

/// ISO-TP (ISO 15765-2, normal addressing, classic CAN) as two machines that are stepped; they own no clock
/// and no bus. Segments always fill 8 bytes. Whatever a segment says is checked before it is believed, never
/// by an assert.
namespace pinjaw::wire {

inline constexpr std::size_t kMaxTransferBytes = 256;
inline constexpr std::uint16_t kTransferTimeout_ms = 200;  ///< N_Bs and N_Cr
inline constexpr std::uint8_t kSegmentGap_ms = 5;          ///< STmin that we ask for and keep at least
/// STmin runs from a segment's last bit, our count from when it is queued: its own 0.27 ms of bus, rounded
/// up.
inline constexpr std::uint8_t kSegmentOnBus_ms = 1;
inline constexpr std::uint8_t kBlockSize = 8;
inline constexpr std::uint8_t kMaxWaits = 3;
inline constexpr std::uint8_t kPadding = 0xCC;

enum class SegmentKind : std::uint8_t { Single, First, Consecutive, FlowControl, Unknown };
enum class FlowStatus : std::uint8_t { Continue = 0, Wait = 1, Overflow = 2 };

constexpr SegmentKind kind_of(const Payload& segment) {
  return std::min(static_cast<SegmentKind>(segment[0] >> 4), SegmentKind::Unknown);
}

enum class TransferEnd : std::uint8_t {
  None,
  Done,
  Silence,  ///< the other side said nothing for 200 ms
  Refused,  ///< the other side has no room
  TooManyWaits,
  BadFlow,  ///< a flow status that means nothing
  OutOfOrder,
  Replaced,  ///< the other side began anew
};

/// Receives one message at a time.
class TransferReceiver {
 public:
  /// Takes a segment other than flow control; gives the flow control to send at once, if any.
  constexpr std::optional<Payload> accept(const Payload& segment) {
    switch (kind_of(segment)) {
      case SegmentKind::Single:
        return accept_single(segment), std::nullopt;
      case SegmentKind::First:
        return accept_first(segment);
      case SegmentKind::Consecutive:
        return accept_consecutive(segment);
      default:
        ++ignored_;
        return std::nullopt;
    }
  }

  constexpr void advance(std::uint16_t elapsed_ms) {
    silence_.advance(elapsed_ms);
    if (busy_ && !silence_.running()) abandon(TransferEnd::Silence);
  }

  /// A whole message, once; valid until the next accept().
  constexpr std::optional<std::span<const std::uint8_t>> take() {
    if (!complete_) return std::nullopt;
    complete_ = false;
    return std::span<const std::uint8_t>(message_).first(expected_);
  }

  [[nodiscard]] constexpr bool busy() const { return busy_; }
  /// How the last transfer ended that did.
  [[nodiscard]] constexpr TransferEnd last_end() const { return end_; }
  /// Segments that were dropped because they made no sense where they came.
  [[nodiscard]] constexpr std::uint32_t ignored() const { return ignored_; }

 private:
  static constexpr Payload flow_control(FlowStatus status) {
    Payload flow{};
    flow.fill(kPadding);
    flow[0] = static_cast<std::uint8_t>(0x30U | static_cast<unsigned>(status));
    flow[1] = kBlockSize;
    flow[2] = kSegmentGap_ms;
    return flow;
  }

  constexpr void begin(std::size_t length) {
    if (busy_) abandon(TransferEnd::Replaced);
    complete_ = false;
    expected_ = static_cast<std::uint16_t>(length);
    received_ = 0;
  }

  constexpr void abandon(TransferEnd end) {
    busy_ = false;
    end_ = end;
  }

  constexpr void store(const Payload& segment, std::size_t from) {
    for (std::size_t i = from; i < segment.size() && received_ < expected_; ++i)
      message_[received_++] = segment[i];
    if (received_ == expected_) {
      abandon(TransferEnd::Done);
      complete_ = true;
    }
  }

  constexpr void accept_single(const Payload& segment) {
    const std::size_t length = segment[0] & 0xFU;
    if (length < 1 || length > 7) {
      ++ignored_;
      return;
    }
    begin(length);
    store(segment, 1);
  }

  constexpr std::optional<Payload> accept_first(const Payload& segment) {
    const std::size_t length = (segment[0] & 0xFU) << 8 | segment[1];
    if (length < 8) {  // 0 would announce a 32-bit length
      ++ignored_;
      return std::nullopt;
    }
    if (length > kMaxTransferBytes) {
      ++ignored_;
      return flow_control(FlowStatus::Overflow);
    }
    begin(length);
    busy_ = true;
    next_number_ = 1;
    block_left_ = kBlockSize;
    silence_.start(kTransferTimeout_ms);
    store(segment, 2);
    return flow_control(FlowStatus::Continue);
  }

  constexpr std::optional<Payload> accept_consecutive(const Payload& segment) {
    if (!busy_) {
      ++ignored_;
      return std::nullopt;
    }
    if ((segment[0] & 0xFU) != next_number_) {
      ++ignored_;
      abandon(TransferEnd::OutOfOrder);
      return std::nullopt;
    }
    next_number_ = (next_number_ + 1U) & 0xFU;
    silence_.start(kTransferTimeout_ms);
    store(segment, 1);
    if (!busy_ || --block_left_ > 0) return std::nullopt;
    block_left_ = kBlockSize;
    return flow_control(FlowStatus::Continue);
  }

  std::array<std::uint8_t, kMaxTransferBytes> message_{};
  std::uint16_t expected_ = 0;
  std::uint16_t received_ = 0;
  std::uint8_t next_number_ = 0;
  std::uint8_t block_left_ = 0;
  bool busy_ = false;
  bool complete_ = false;
  Countdown silence_;
  TransferEnd end_ = TransferEnd::None;
  std::uint32_t ignored_ = 0;
};

/// Sends one message at a time.
class TransferSender {
 public:
  /// Begins to send; what was under way is dropped. False where the length is not 1..256.
  constexpr bool start(std::span<const std::uint8_t> message) {
    if (!start(message.size())) return false;
    std::copy(message.begin(), message.end(), message_.begin());
    return true;
  }

  /// Room to write a message into before start(length) sends it; drops what was under way.
  constexpr std::span<std::uint8_t> compose() {
    cancel();
    return message_;
  }
  constexpr bool start(std::size_t length) {
    if (length == 0 || length > kMaxTransferBytes) return false;
    length_ = static_cast<std::uint16_t>(length);
    sent_ = 0;
    waits_ = 0;
    phase_ = Phase::Begin;
    end_ = TransferEnd::None;
    return true;
  }

  /// Takes a flow control segment; any other, or one that nobody waits for, is ignored.
  constexpr void accept(const Payload& segment) {
    if (kind_of(segment) != SegmentKind::FlowControl || phase_ != Phase::Waiting) return;
    switch (segment[0] & 0xFU) {
      case static_cast<unsigned>(FlowStatus::Continue):
        waits_ = 0;
        block_left_ = segment[1];
        gap_ms_ = gap_of(segment[2]);
        timer_.stop();
        phase_ = Phase::Streaming;
        return;
      case static_cast<unsigned>(FlowStatus::Wait):
        if (++waits_ > kMaxWaits) return stop(TransferEnd::TooManyWaits);
        timer_.start(kTransferTimeout_ms);
        return;
      case static_cast<unsigned>(FlowStatus::Overflow):
        return stop(TransferEnd::Refused);
      default:
        return stop(TransferEnd::BadFlow);
    }
  }

  /// Lets time pass; gives the segment that is due, at most one.
  constexpr std::optional<Payload> advance(std::uint16_t elapsed_ms) {
    timer_.advance(elapsed_ms);
    switch (phase_) {
      case Phase::Begin:
        return first();
      case Phase::Streaming:
        return timer_.running() ? std::nullopt : std::optional(consecutive());
      case Phase::Waiting:
        if (!timer_.running()) stop(TransferEnd::Silence);
        return std::nullopt;
      default:
        return std::nullopt;
    }
  }

  [[nodiscard]] constexpr bool busy() const { return phase_ != Phase::Idle; }
  [[nodiscard]] constexpr TransferEnd last_end() const { return end_; }
  constexpr void cancel() { phase_ = Phase::Idle; }

 private:
  enum class Phase : std::uint8_t { Idle, Begin, Waiting, Streaming };

  /// STmin in whole milliseconds: 0xF1..0xF9 are 100 to 900 us, reserved values the longest time (9.6.5.5).
  static constexpr std::uint8_t gap_of(std::uint8_t stmin) {
    if (stmin >= 0xF1 && stmin <= 0xF9) return kSegmentGap_ms;
    return std::clamp<std::uint8_t>(stmin, kSegmentGap_ms, 0x7F);
  }

  constexpr void stop(TransferEnd end) {
    phase_ = Phase::Idle;
    end_ = end;
  }

  constexpr void wait() {
    phase_ = Phase::Waiting;
    timer_.start(kTransferTimeout_ms);
  }

  constexpr void fill(Payload& segment, std::size_t from) {
    for (std::size_t i = from; i < segment.size() && sent_ < length_; ++i) segment[i] = message_[sent_++];
  }

  constexpr Payload first() {
    Payload segment{};
    segment.fill(kPadding);
    if (length_ <= 7) {
      segment[0] = static_cast<std::uint8_t>(length_);
      fill(segment, 1);
      stop(TransferEnd::Done);
      return segment;
    }
    segment[0] = static_cast<std::uint8_t>(0x10U | length_ >> 8);
    segment[1] = static_cast<std::uint8_t>(length_ & 0xFFU);
    fill(segment, 2);
    number_ = 1;
    wait();
    return segment;
  }

  constexpr Payload consecutive() {
    Payload segment{};
    segment.fill(kPadding);
    segment[0] = static_cast<std::uint8_t>(0x20U | number_);
    number_ = (number_ + 1U) & 0xFU;
    fill(segment, 1);
    if (sent_ == length_) {
      stop(TransferEnd::Done);
    } else if (--block_left_ == 0) {
      wait();
    } else {
      timer_.start(static_cast<std::uint16_t>(gap_ms_ + kSegmentOnBus_ms));
    }
    return segment;
  }

  std::array<std::uint8_t, kMaxTransferBytes> message_{};
  std::uint16_t length_ = 0;
  std::uint16_t sent_ = 0;
  std::uint8_t number_ = 0;
  std::uint8_t block_left_ = 0;  ///< from 0, which is no limit, it counts 256: more than a message has
  std::uint8_t gap_ms_ = kSegmentGap_ms;
  std::uint8_t waits_ = 0;
  static_assert(kMaxTransferBytes / 7 < 256);
  Phase phase_ = Phase::Idle;
  Countdown timer_;  ///< meant where the phase is Waiting or Streaming
  TransferEnd end_ = TransferEnd::None;
};

}  // namespace pinjaw::wire
