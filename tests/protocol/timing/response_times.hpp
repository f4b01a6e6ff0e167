#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "protocol/wire/codec.hpp"
#include "protocol/wire/table.hpp"

/// Worst-case response times of a CAN bus that carries pinjaw's messages, by the analysis of Davis, Burns,
/// Bril and Lukkien, "Controller Area Network (CAN) schedulability analysis: Refuted, revisited and revised",
/// Real-Time Systems 35 (2007).
namespace pinjaw::timing {

/// One id, sent at least `period_us` apart but for a jitter of its release.
struct Stream {
  wire::MessageType type = wire::MessageType::State;
  std::uint8_t node = 0;
  std::int64_t period_us = 0;
  std::int64_t jitter_us = 0;
  [[nodiscard]] std::uint32_t id() const { return wire::id_of({type, node}); }
};

struct Traffic {
  int nodes = 3;
  std::int64_t bit_rate = 500'000;
  std::vector<Stream> streams;  ///< ascending by id
};

/// What a cell of so many nodes sends at most, all of it from the message table: every periodic message, a
/// handoff everywhere, a fault of each node, a command to each every 20 ms, GLOBAL_HOLD every 5 ms, and one
/// layout transfer that never ends. Controllers and hosts step each millisecond: that is the jitter.
Traffic worst_traffic(int nodes, std::int64_t bit_rate);

/// Bits of a standard frame of 8 bytes with the most stuff bits there can be, its pause included (Davis 2007,
/// section 3.1, whose 132 bits end before the pause of 3).
inline constexpr std::int64_t kLongestFrame_bits = 135;
std::int64_t frame_ns(std::int64_t bit_rate);

/// From when a frame of `stream` should have been handed to its CAN controller to its last bit, at worst
/// (equations 5 to 11 there); nothing where the bus is overloaded. Precondition: one of the traffic's.
std::optional<std::int64_t> response_ns(const Traffic& traffic, const Stream& stream);
/// The worst of all nodes' frames of that type.
std::optional<std::int64_t> response_ns(const Traffic& traffic, wire::MessageType type);

/// Share of time that the bus is busy, 1 or more: overloaded.
double load(const Traffic& traffic);

/// More frames than the analysis counts that may come before STATE within a peer's freshness, three periods
/// after the last good one; negative where not even the counted ones may.
std::int64_t spare_frames(const Traffic& traffic);

/// The table of docs/timing.md.
std::string table();

}  // namespace pinjaw::timing
