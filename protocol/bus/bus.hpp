#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <tl/expected.hpp>

#include "protocol/wire/frame.hpp"

/// One end of a CAN bus, whatever the bus is.
namespace pinjaw::bus {

/// Why a bus cannot be used: what went wrong, and a sentence that a person can act on.
enum class FailureKind : std::uint8_t {
  Unavailable,  ///< no such interface, or no CAN on this machine
  Down,         ///< the interface went down or away
  Overflow,     ///< the frame was not taken: too many are waiting
  System,       ///< anything else the operating system said
};

struct Failure {
  FailureKind kind = FailureKind::System;
  std::string message;
};

template <class T>
using Expected = tl::expected<T, Failure>;

/// Who sent a received frame.
enum class Origin : std::uint8_t {
  Elsewhere,
  SameMachine,  ///< another program of this computer
  Self,         ///< the echo of an own frame: it has been sent
};

struct Received {
  wire::Frame frame;
  std::int64_t time_us = 0;  ///< when its last bit came; since 1970, or since the start of virtual time
  Origin origin = Origin::Elsewhere;
};

struct Statistics {
  std::uint64_t sent = 0;
  std::uint64_t received = 0;
  std::uint64_t lost_receiving = 0;  ///< came, and were dropped for want of room
  std::uint64_t lost_sending = 0;    ///< given to send() and never sent
  std::uint64_t error_frames = 0;
  std::uint64_t stalls = 0;          ///< times a frame found the driver's queue full, and waited
  std::uint64_t overruns = 0;        ///< times the CAN controller itself had no room for a frame
  std::uint64_t unacknowledged = 0;  ///< times nobody acknowledged a frame
  std::uint64_t passive = 0;         ///< times the controller became error-passive
  std::uint64_t bus_off = 0;         ///< times it took itself off the bus
  std::uint64_t restarts = 0;        ///< times it came back from there
  std::uint64_t outages = 0;         ///< times the interface went down or away

  Statistics& operator+=(const Statistics& other);
};

/// What the CAN controller of an end says of itself.
struct Health {
  bool off = false;            ///< bus-off: nothing is sent or received
  bool passive = false;        ///< error-passive
  std::uint32_t overruns = 0;  ///< receive overruns since it was opened, of a frame or more each
};

/// Frames with (id & mask) == (filter id & mask) pass; standard frames only.
struct Filter {
  std::uint32_t id = 0;
  std::uint32_t mask = 0;
};

/// Sends and receives frames without ever waiting. Not for several threads at once.
class Bus {
 public:
  Bus() = default;
  Bus(const Bus&) = delete;
  Bus& operator=(const Bus&) = delete;
  Bus(Bus&&) = delete;
  Bus& operator=(Bus&&) = delete;
  virtual ~Bus() = default;

  /// Queues a frame; frames of one id leave in the order of sending.
  virtual Expected<void> send(const wire::Frame& frame) = 0;
  /// The next received frame, nothing where none waits. Error frames come here too.
  virtual Expected<std::optional<Received>> receive() = 0;
  [[nodiscard]] virtual Statistics statistics() const = 0;
  /// A bus without CAN controllers of its own is always well.
  [[nodiscard]] virtual Health health() const { return {}; }
  /// Lets a controller that is bus-off come back.
  virtual void restart() {}
};

}  // namespace pinjaw::bus
