#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "firmware_sim/core/core.hpp"

/// Inputs of a controller and what it made of them, as bytes: recorded where the tests run, played to an
/// image on another processor, and compared byte for byte. Little-endian; structures as they lie in memory,
/// padding 0.
///
///     inputs   mask of the state's bytes, then 'P' configuration, memory | 'S' elapsed time, sensors ...,
///     number of frames, frames | 'E' outputs  for each 'S': valves, 'N' write to memory, 'F' frame ..., 'B'
///     bus restart, '.' digest of the state
///
/// `Sink` takes bytes by `put(std::span<const std::uint8_t>)`.
namespace pinjaw::trace {

inline constexpr std::uint8_t kPowerOn = 'P';
inline constexpr std::uint8_t kStep = 'S';
inline constexpr std::uint8_t kEnd = 'E';

/// Whatever has no pointer and no size_t lies alike on all machines with 8-bit bytes and natural alignment.
template <class T>
std::span<std::uint8_t> bytes_of(T& value) {
  return {reinterpret_cast<std::uint8_t*>(&value), sizeof(T)};
}
template <class T>
std::span<const std::uint8_t> bytes_of(const T& value) {
  return {reinterpret_cast<const std::uint8_t*>(&value), sizeof(T)};
}

/// The part of a configuration that lies alike everywhere: all before its one pointer, the last member, and
/// the padding before that, which is as long as the pointer likes.
inline constexpr std::size_t kConfigBytes =
    offsetof(core::Config, release_guard_enabled) + sizeof(core::Config::release_guard_enabled);
static_assert(offsetof(core::Config, table) - kConfigBytes < alignof(const core::StateTable*));
/// The part of the inputs that does: all after the frames.
inline std::span<std::uint8_t> tail_of(core::Inputs& inputs) {
  constexpr std::size_t kFrom = offsetof(core::Inputs, sensors);
  constexpr std::size_t kBytes = offsetof(core::Inputs, bus) + sizeof(core::BusHealth) - kFrom;
  return bytes_of(inputs).subspan(kFrom, kBytes);
}

/// Puts numbers and structures into a sink.
template <class Sink>
struct Writer {
  Sink& sink;

  void byte(std::uint8_t value) { sink.put(std::span(&value, 1)); }
  template <class T>
  void raw(const T& value) {  // of a type without padding
    sink.put(bytes_of(value));
  }
  void valves(const core::Valves& valves) {
    byte(static_cast<std::uint8_t>(valves.spool));
    raw(valves.close_set_mbar);
    byte(static_cast<std::uint8_t>((valves.relax ? 1U : 0U) | (valves.pre_vent ? 2U : 0U) |
                                   (valves.supply_cut ? 4U : 0U)));
  }
  void frame(const wire::Frame& frame) {
    raw(frame.id);
    byte(static_cast<std::uint8_t>(frame.kind));
    byte(frame.extended ? 1 : 0);
    byte(frame.length);
    sink.put(frame.data);
  }
  void write(const core::NvmWrite& write) {
    raw(write.sequence);
    byte(write.record ? 1 : 0);
    if (write.record) raw(*write.record);
    byte(write.layout ? 1 : 0);
    if (!write.layout) return;
    raw(write.layout->size);
    sink.put(std::span(write.layout->bytes).first(write.layout->size));
  }
};

/// How many bytes of a state count: all after its configuration.
inline constexpr std::size_t kStateBytes = sizeof(core::State) - offsetof(core::State, id);
/// 0xFF for each of these bytes that is part of a value, 0 for padding.
using StateMask = std::array<std::uint8_t, kStateBytes>;

/// A number that differs where two states do, all but surely (FNV-1a over words).
inline std::uint32_t digest_of(const core::State& state, const StateMask& mask) {
  const std::span<const std::uint8_t> bytes = bytes_of(state).subspan(offsetof(core::State, id));
  std::uint32_t hash = 2166136261U;
  for (std::size_t i = 0; i < kStateBytes; i += 4) {
    std::uint32_t word = 0;
    for (std::size_t k = 0; k < 4 && i + k < kStateBytes; ++k) {
      word |= std::uint32_t{static_cast<std::uint8_t>(bytes[i + k] & mask[i + k])} << (8 * k);
    }
    hash = (hash ^ word) * 16777619U;
  }
  return hash;
}

}  // namespace pinjaw::trace
