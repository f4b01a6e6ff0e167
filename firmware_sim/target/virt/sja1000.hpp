#pragma once

#include <array>
#include <cstdint>

#include "protocol/wire/frame.hpp"

/// NXP's SJA1000 CAN controller in PeliCAN mode, by its registers (data sheet, 2000 Jan 04, section 6.4).
namespace pinjaw::virt {

class Sja1000 {
 public:
  /// `registers`: where its 32 byte-wide registers are.
  constexpr explicit Sja1000(std::uintptr_t registers) : registers_(registers) {}

  /// 500 kbit/s from 16 MHz, every identifier accepted, an interrupt for each received frame.
  void start() const {
    set(kMode, kReset);
    set(kClockDivider, 0x80);  // PeliCAN
    set(kBusTiming0, 0x00);
    set(kBusTiming1, 0x1C);
    for (std::uint8_t i = 0; i < 4; ++i) {
      set(static_cast<std::uint8_t>(kBuffer + i), 0x00);      // acceptance code
      set(static_cast<std::uint8_t>(kBuffer + 4 + i), 0xFF);  // acceptance mask: nothing must match
    }
    set(kOutputControl, 0x1A);
    set(kInterruptEnable, 0x01);
    set(kMode, 0);  // two filters; a single one loses identifiers on the emulated part
  }

  [[nodiscard]] bool has_frame() const { return (get(kStatus) & 0x01U) != 0; }
  [[nodiscard]] bool overrun() const { return (get(kStatus) & 0x02U) != 0; }
  [[nodiscard]] bool can_send() const { return (get(kStatus) & 0x04U) != 0; }
  [[nodiscard]] bool passive() const { return (get(kStatus) & 0x40U) != 0; }
  [[nodiscard]] bool bus_off() const { return (get(kStatus) & 0x80U) != 0; }
  void clear_overrun() const { set(kCommand, 0x08); }
  /// Leaves bus-off: the controller then waits for 128 times 11 recessive bits by itself.
  void restart() const { set(kMode, 0); }

  /// Precondition: has_frame().
  [[nodiscard]] wire::Frame take() const {
    const std::uint8_t info = get(kBuffer);
    wire::Frame frame;
    frame.extended = (info & 0x80U) != 0;
    frame.kind = (info & 0x40U) != 0 ? wire::FrameKind::Remote : wire::FrameKind::Data;
    frame.length = info & 0x0FU;
    if (frame.length > 8) frame.length = 8;
    const std::uint8_t id_bytes = frame.extended ? 4 : 2;
    for (std::uint8_t i = 0; i < id_bytes; ++i) {
      frame.id = frame.id << 8 | get(static_cast<std::uint8_t>(kBuffer + 1 + i));
    }
    frame.id >>= frame.extended ? 3 : 5;
    for (std::uint8_t i = 0; i < frame.length; ++i) {
      frame.data[i] = get(static_cast<std::uint8_t>(kBuffer + 1 + id_bytes + i));
    }
    set(kCommand, 0x04);  // release the buffer
    (void)get(kInterrupts);
    return frame;
  }

  /// Precondition: can_send(), a data frame with an 11-bit id.
  void send(const wire::Frame& frame) const {
    set(kBuffer, frame.length);
    set(kBuffer + 1, static_cast<std::uint8_t>(frame.id >> 3));
    set(kBuffer + 2, static_cast<std::uint8_t>(frame.id << 5));
    for (std::uint8_t i = 0; i < frame.length; ++i)
      set(static_cast<std::uint8_t>(kBuffer + 3 + i), frame.data[i]);
    set(kCommand, 0x01);
  }

 private:
  enum : std::uint8_t {
    kMode = 0,
    kCommand = 1,
    kStatus = 2,
    kInterrupts = 3,
    kInterruptEnable = 4,
    kBusTiming0 = 6,
    kBusTiming1 = 7,
    kOutputControl = 8,
    kBuffer = 16,
    kClockDivider = 31,
    kReset = 1,
  };
  [[nodiscard]] volatile std::uint8_t& at(std::uint8_t number) const {
    return *reinterpret_cast<volatile std::uint8_t*>(registers_ + number);
  }
  [[nodiscard]] std::uint8_t get(std::uint8_t number) const { return at(number); }
  void set(std::uint8_t number, std::uint8_t value) const { at(number) = value; }

  std::uintptr_t registers_;
};

}  // namespace pinjaw::virt
