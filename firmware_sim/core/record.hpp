#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "firmware_sim/core/io.hpp"

/// Non-volatile memory as bytes: the custody record and the layout, each in two slots with checksum and
/// sequence (docs/reliability.md, section 2.1, and I7).
///
/// A store writes both slots one after the other, first the one that is no good copy of the present value. So
/// a power cut after any byte leaves the old value or the new one, and once a store is done either slot may
/// decay.
namespace pinjaw::core {

inline constexpr std::size_t kRecordBytes = 80;
inline constexpr std::size_t kSlotOverhead = 12;  ///< magic, sequence, checksum, 4 bytes each
inline constexpr std::size_t kLayoutBytes = 258;  ///< size, then the layout's own bytes
inline constexpr std::uint8_t kBlank = 0xFF;

using RecordSlot = std::array<std::uint8_t, kSlotOverhead + kRecordBytes>;
using LayoutSlot = std::array<std::uint8_t, kSlotOverhead + kLayoutBytes>;

/// The memory as delivered: blank.
struct Memory {
  std::array<RecordSlot, 2> records{};
  std::array<LayoutSlot, 2> layouts{};

  Memory();
  friend bool operator==(const Memory&, const Memory&) = default;
};

/// One value of a slot and its place in the order of stores.
template <class Value>
struct Stored {
  std::uint32_t sequence = 0;
  Value value;
};

RecordSlot encode(const Stored<NvmRecord>& record);
LayoutSlot encode(const Stored<LayoutBlob>& layout);

/// Nothing where the bytes are no whole slot of this format, or the checksum or a number in it is wrong.
std::optional<Stored<NvmRecord>> decode_record(std::span<const std::uint8_t> slot);
std::optional<Stored<LayoutBlob>> decode_layout_slot(std::span<const std::uint8_t> slot);

/// What a controller finds in `memory`. Both record slots damaged: unreadable. A blank one and none good: the
/// first store of all was cut short, so nothing was ever recorded.
NvmImage image_of(const Memory& memory);

/// What is written into both slots of a value, and into which of them first.
template <class Slot>
struct SlotStore {
  Slot bytes;
  std::size_t first;
};

/// A request on its way into memory, byte by byte.
class MemoryUpdate {
 public:
  MemoryUpdate(const Memory& memory, const NvmWrite& request);

  /// How many bytes it writes in all.
  [[nodiscard]] std::size_t size() const;
  /// Writes the byte of that index. Precondition: those before it were written.
  void put(std::size_t index, Memory& memory) const;

 private:
  std::optional<SlotStore<RecordSlot>> record_;
  std::optional<SlotStore<LayoutSlot>> layout_;
};

}  // namespace pinjaw::core
