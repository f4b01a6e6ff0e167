#include "protocol/bus/frame_bits.hpp"

#include <algorithm>
#include <cstdint>

namespace pinjaw::bus {

namespace {

constexpr int kTrailer = 1 + 1 + 1 + 7;  // CRC delimiter, acknowledge slot and delimiter, end of frame
constexpr int kPause = 3;

/// Counts bits as they leave: five equal ones are followed by a stuff bit; and their CRC-15 (ISO
/// 11898-1 10.4.2.6).
class Stuffer {
 public:
  void put(std::uint32_t value, int bits, bool into_crc = true) {
    for (int i = bits - 1; i >= 0; --i) put_bit((value >> i) & 1U, into_crc);
  }
  void put_crc() { put(crc_, 15, false); }
  [[nodiscard]] int count() const { return count_; }

 private:
  void put_bit(std::uint32_t bit, bool into_crc) {
    ++count_;
    if (into_crc) {
      const bool invert = bit != (crc_ >> 14 & 1U);
      crc_ = crc_ << 1 & 0x7FFFU;
      if (invert) crc_ ^= 0x4599U;
    }
    run_ = bit == last_ ? run_ + 1 : 1;
    last_ = bit;
    if (run_ == 5) {
      ++count_;
      last_ ^= 1U;
      run_ = 1;
    }
  }
  std::uint32_t crc_ = 0;
  std::uint32_t last_ = 2;
  int run_ = 0;
  int count_ = 0;
};

/// Of a frame of 12 bytes with a 17-bit checksum (ISO 11898-1:2015, 10.4.2).
int fd_bits_on_bus(const wire::Frame& frame) {
  constexpr int kSlowTrailer = 1 + 1 + 1 + 7;  // CRC delimiter, acknowledge slot and delimiter, end of frame
  constexpr int kStuffCount = 4;
  constexpr int kChecksum = 17;
  constexpr int kFixedStuff = 1 + (kStuffCount + kChecksum) / 4;  // one before, one after every four
  constexpr int kFaster = 4;
  Stuffer bits;
  bits.put(0, 1);  // start of frame
  bits.put(frame.id & 0x7FFU, 11);
  bits.put(0b00101, 5);  // remote substitution, extension, FD format, reserved, bit rate switch
  const int slow = bits.count();
  bits.put(0, 1);       // error state
  bits.put(0b1001, 4);  // 12 bytes
  for (const std::uint8_t byte : frame.data) bits.put(byte, 8);
  for (const std::uint8_t byte : frame.tail) bits.put(byte, 8);
  const int fast = bits.count() - slow + kStuffCount + kChecksum + kFixedStuff;
  return slow + (fast + kFaster - 1) / kFaster + kSlowTrailer + kPause;
}

}  // namespace

int bits_on_bus(const wire::Frame& frame) {
  if (frame.kind == wire::FrameKind::Error) return 0;
  if (frame.kind == wire::FrameKind::Fd) return fd_bits_on_bus(frame);
  const bool remote = frame.kind == wire::FrameKind::Remote;
  const int length = std::min<int>(frame.length, 8);
  Stuffer bits;
  bits.put(0, 1);  // start of frame
  if (frame.extended) {
    bits.put(frame.id >> 18 & 0x7FFU, 11);
    bits.put(0b11, 2);  // substitute remote request, extension
    bits.put(frame.id & 0x3FFFFU, 18);
    bits.put(remote ? 1 : 0, 1);
    bits.put(0, 2);  // reserved
  } else {
    bits.put(frame.id & 0x7FFU, 11);
    bits.put(remote ? 1 : 0, 1);
    bits.put(0, 2);  // extension, reserved
  }
  bits.put(static_cast<std::uint32_t>(length), 4);
  for (int i = 0; i < length && !remote; ++i) bits.put(frame.data[static_cast<std::size_t>(i)], 8);
  bits.put_crc();
  return bits.count() + kTrailer + kPause;
}

}  // namespace pinjaw::bus
