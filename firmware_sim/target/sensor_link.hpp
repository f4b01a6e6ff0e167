#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "firmware_sim/core/io.hpp"
#include "protocol/wire/bits.hpp"
#include "protocol/wire/crc.hpp"

/// Sensors and valves of a board whose jaws are simulated elsewhere, over a serial line: to the board what
/// its sensors read, from it what its valves are told. Each packet is a mark, fields in little-endian order,
/// the number of a reading, and a CRC-8. What the valves are told repeats the number of the reading that the
/// board knew, so that who simulates the jaws can tell how old it is.
namespace pinjaw::link {

inline constexpr std::uint8_t kSensorsMark = 0xA5;
inline constexpr std::uint8_t kValvesMark = 0x5A;
inline constexpr std::size_t kSensorsBytes = 28;
inline constexpr std::size_t kValvesBytes = 9;
using SensorsPacket = std::array<std::uint8_t, kSensorsBytes>;
using ValvesPacket = std::array<std::uint8_t, kValvesBytes>;

template <std::size_t kSize>
constexpr void seal(std::array<std::uint8_t, kSize>& packet) {
  packet[kSize - 1] = wire::crc_of<wire::Crc8>(std::span<const std::uint8_t>(packet).first(kSize - 1));
}

/// Of a packet, which reading it is or answers.
template <std::size_t kSize>
constexpr std::uint8_t number_of(const std::array<std::uint8_t, kSize>& packet) {
  return packet[kSize - 2];
}

constexpr SensorsPacket pack(const core::Sensors& sensors, std::uint8_t number) {
  SensorsPacket packet{};
  wire::ByteWriter out(packet);
  out.put(kSensorsMark, 1);
  for (const std::int32_t mbar : sensors.close_mbar) out.put(static_cast<std::uint32_t>(mbar), 4);
  for (const std::int32_t mbar : sensors.open_mbar) out.put(static_cast<std::uint32_t>(mbar), 4);
  out.put(static_cast<std::uint32_t>(sensors.supply_mbar), 4);
  out.put(static_cast<std::uint32_t>(sensors.separation_10um), 4);
  out.put((sensors.seats & 0x7FU) | (sensors.local_enable ? 0x80U : 0U), 1);
  out.put(number, 1);
  seal(packet);
  return packet;
}

constexpr core::Sensors sensors_of(const SensorsPacket& packet) {
  wire::ByteReader in(std::span<const std::uint8_t>(packet).subspan(1));
  const auto number = [&in] { return static_cast<std::int32_t>(in.take(4)); };
  core::Sensors sensors;
  for (std::int32_t& mbar : sensors.close_mbar) mbar = number();
  for (std::int32_t& mbar : sensors.open_mbar) mbar = number();
  sensors.supply_mbar = number();
  sensors.separation_10um = number();
  const std::uint32_t switches = in.take(1);
  sensors.seats = static_cast<std::uint8_t>(switches & 0x7FU);
  sensors.local_enable = (switches & 0x80U) != 0;
  return sensors;
}

constexpr ValvesPacket pack(const core::Valves& valves, std::uint8_t number) {
  ValvesPacket packet{};
  wire::ByteWriter out(packet);
  out.put(kValvesMark, 1);
  out.put(static_cast<std::uint8_t>(valves.spool), 1);
  out.put(static_cast<std::uint32_t>(valves.close_set_mbar), 4);
  out.put((valves.relax ? 1U : 0U) | (valves.pre_vent ? 2U : 0U) | (valves.supply_cut ? 4U : 0U), 1);
  out.put(number, 1);
  seal(packet);
  return packet;
}

/// De-energised valves where the spool's number means nothing.
constexpr core::Valves valves_of(const ValvesPacket& packet) {
  wire::ByteReader in(std::span<const std::uint8_t>(packet).subspan(1));
  const std::uint32_t spool = in.take(1);
  if (spool > static_cast<std::uint32_t>(core::Spool::Open)) return {};
  core::Valves valves{.spool = static_cast<core::Spool>(spool)};
  valves.close_set_mbar = static_cast<std::int32_t>(in.take(4));
  const std::uint32_t flags = in.take(1);
  valves.relax = (flags & 1U) != 0;
  valves.pre_vent = (flags & 2U) != 0;
  valves.supply_cut = (flags & 4U) != 0;
  return valves;
}

/// Finds packets in a stream of bytes; what belongs to none is passed over.
template <std::size_t kSize>
class PacketReader {
 public:
  constexpr explicit PacketReader(std::uint8_t mark) : mark_(mark) {}

  /// The packet that ends with `byte`, if one does.
  constexpr std::optional<std::array<std::uint8_t, kSize>> take(std::uint8_t byte) {
    if (used_ == kSize) drop_first();
    bytes_[used_++] = byte;
    while (used_ > 0 && bytes_[0] != mark_) drop_first();
    if (used_ < kSize) return std::nullopt;
    if (wire::crc_of<wire::Crc8>(std::span<const std::uint8_t>(bytes_).first(kSize - 1)) !=
        bytes_[kSize - 1]) {
      drop_first();
      while (used_ > 0 && bytes_[0] != mark_) drop_first();
      return std::nullopt;
    }
    used_ = 0;
    return bytes_;
  }

 private:
  constexpr void drop_first() {
    for (std::size_t i = 1; i < used_; ++i) bytes_[i - 1] = bytes_[i];
    --used_;
  }
  std::array<std::uint8_t, kSize> bytes_{};
  std::size_t used_ = 0;
  std::uint8_t mark_;
};

}  // namespace pinjaw::link
