#include "firmware_sim/core/record.hpp"

#include <algorithm>

#include "protocol/wire/bits.hpp"
#include "protocol/wire/crc.hpp"

namespace pinjaw::core {
namespace {

constexpr std::uint32_t kRecordMagic = 0x31524A50;  // "PJR1"
constexpr std::uint32_t kBlobMagic = 0x31424A50;    // "PJB1"
constexpr std::size_t kChecksumBytes = 4;
constexpr std::uint8_t kLargestPeer = 15;

static_assert(sizeof(NvmRecord) == kRecordBytes, "a member that is added to the record is stored, too");

/// Every member of a record in its stored order.
template <class Record, class Visitor>
void each_member(Record& record, Visitor visit) {
  visit(record.custody);
  visit(record.peer);
  visit(record.token);
  visit(record.pair);
  visit(record.handoff_number);
  visit(record.force_set_dn);
  visit(record.permit_dn);
  visit(record.session_block);
  visit(record.frame_block);
  visit(record.boot_count);
  visit(record.seen_givers);
  for (auto& token : record.last_token) visit(token);
  for (auto& outcome : record.outcomes) {
    visit(outcome.retained);
    visit(outcome.peer);
    visit(outcome.token);
    visit(outcome.pair);
  }
}

struct PutMember {
  wire::ByteWriter& out;
  template <class Member>
  void operator()(const Member& member) const {
    out.put(static_cast<std::uint64_t>(member), sizeof member);
  }
};

struct TakeMember {
  wire::ByteReader& in;
  template <class Member>
  void operator()(Member& member) const {
    member = static_cast<Member>(in.take(sizeof member));
  }
};

bool makes_sense(const NvmRecord& record) {
  const auto peer_makes_sense = [](const Outcome& outcome) { return outcome.peer <= kLargestPeer; };
  return record.custody <= Custody::Retained && record.peer <= kLargestPeer &&
         std::all_of(record.outcomes.begin(), record.outcomes.end(), peer_makes_sense);
}

std::uint32_t checksum_of(std::span<const std::uint8_t> slot) {
  return wire::crc_of<wire::Crc32>(slot.first(slot.size() - kChecksumBytes));
}

void seal(std::span<std::uint8_t> slot) {
  wire::ByteWriter out(slot.last(kChecksumBytes));
  out.put(checksum_of(slot), kChecksumBytes);
}

/// The sequence of a slot that is whole, of that kind and of that size.
std::optional<std::uint32_t> sequence_of(std::span<const std::uint8_t> slot, std::size_t size,
                                         std::uint32_t magic) {
  if (slot.size() != size) return std::nullopt;
  wire::ByteReader in(slot);
  if (in.take(4) != magic) return std::nullopt;
  const std::uint32_t sequence = in.take(4);
  wire::ByteReader end(slot.last(kChecksumBytes));
  if (end.take(kChecksumBytes) != checksum_of(slot)) return std::nullopt;
  return sequence;
}

/// From the value on; the checksum is behind it.
std::span<const std::uint8_t> content_of(std::span<const std::uint8_t> slot) {
  return slot.subspan(8);
}

bool later(std::uint32_t one, std::uint32_t other) {
  const std::uint32_t ahead = one - other;
  return ahead != 0 && ahead < 0x80000000U;
}

/// The two slots of one value: their sequences, where they are good.
struct Pair {
  std::array<bool, 2> good{};
  std::array<std::uint32_t, 2> sequence{};

  [[nodiscard]] bool any() const { return good[0] || good[1]; }
  /// The slot with the present value. Precondition: any().
  [[nodiscard]] std::size_t present() const {
    if (!good[0]) return 1;
    return good[1] && later(sequence[1], sequence[0]) ? 1 : 0;
  }
  [[nodiscard]] std::size_t first_to_write() const { return any() ? 1 - present() : 0; }
  [[nodiscard]] std::uint32_t next_sequence() const { return any() ? sequence[present()] + 1 : 0; }
};

template <class Slot, class Decode>
Pair look_at(const std::array<Slot, 2>& slots, Decode decode) {
  Pair pair;
  for (std::size_t i = 0; i < slots.size(); ++i) {
    const auto stored = decode(slots[i]);
    pair.good[i] = stored.has_value();
    if (stored) pair.sequence[i] = stored->sequence;
  }
  return pair;
}

bool is_blank(std::span<const std::uint8_t> slot) {
  return std::all_of(slot.begin(), slot.end(), [](std::uint8_t byte) { return byte == kBlank; });
}

/// The store of `value` into `slots`.
template <class Slot, class Value, class Decode>
SlotStore<Slot> store_of(const std::array<Slot, 2>& slots, const Value& value, Decode decode) {
  const Pair present = look_at(slots, decode);
  return {encode(Stored<Value>{present.next_sequence(), value}), present.first_to_write()};
}

/// Byte `index` of a store into both of `slots`.
template <class Slot>
void put_byte(std::array<Slot, 2>& slots, const SlotStore<Slot>& store, std::size_t index) {
  Slot& target = slots[index < store.bytes.size() ? store.first : 1 - store.first];
  target[index % target.size()] = store.bytes[index % target.size()];
}

}  // namespace

Memory::Memory() {
  for (RecordSlot& slot : records) slot.fill(kBlank);
  for (LayoutSlot& slot : layouts) slot.fill(kBlank);
}

RecordSlot encode(const Stored<NvmRecord>& record) {
  RecordSlot slot{};
  wire::ByteWriter out(slot);
  out.put(kRecordMagic, 4);
  out.put(record.sequence, 4);
  each_member(record.value, PutMember{out});
  seal(slot);
  return slot;
}

LayoutSlot encode(const Stored<LayoutBlob>& layout) {
  LayoutSlot slot{};
  wire::ByteWriter out(slot);
  out.put(kBlobMagic, 4);
  out.put(layout.sequence, 4);
  out.put(layout.value.size, 2);
  for (const std::uint8_t byte : layout.value.bytes) out.put(byte, 1);
  seal(slot);
  return slot;
}

std::optional<Stored<NvmRecord>> decode_record(std::span<const std::uint8_t> slot) {
  const auto sequence = sequence_of(slot, RecordSlot{}.size(), kRecordMagic);
  if (!sequence) return std::nullopt;
  Stored<NvmRecord> record{.sequence = *sequence, .value = {}};
  wire::ByteReader in(content_of(slot));
  each_member(record.value, TakeMember{in});
  const RecordSlot again = encode(record);  // a flag other than 0 or 1 does not come out as it went in
  if (!makes_sense(record.value) || !std::equal(again.begin(), again.end(), slot.begin()))
    return std::nullopt;
  return record;
}

std::optional<Stored<LayoutBlob>> decode_layout_slot(std::span<const std::uint8_t> slot) {
  const auto sequence = sequence_of(slot, LayoutSlot{}.size(), kBlobMagic);
  if (!sequence) return std::nullopt;
  Stored<LayoutBlob> layout{.sequence = *sequence, .value = {}};
  wire::ByteReader in(content_of(slot));
  layout.value.size = static_cast<std::uint16_t>(in.take(2));
  if (layout.value.size > layout.value.bytes.size()) return std::nullopt;
  for (std::uint8_t& byte : layout.value.bytes) byte = static_cast<std::uint8_t>(in.take(1));
  return layout;
}

NvmImage image_of(const Memory& memory) {
  NvmImage image;
  const Pair records = look_at(memory.records, decode_record);
  if (records.any()) {
    image.record = decode_record(memory.records[records.present()])->value;
  } else {
    image.readable = is_blank(memory.records[0]) || is_blank(memory.records[1]);
  }
  const Pair layouts = look_at(memory.layouts, decode_layout_slot);
  if (layouts.any()) image.layout = decode_layout_slot(memory.layouts[layouts.present()])->value;
  return image;
}

MemoryUpdate::MemoryUpdate(const Memory& memory, const NvmWrite& request) {
  if (request.record) record_ = store_of(memory.records, *request.record, decode_record);
  if (request.layout) layout_ = store_of(memory.layouts, *request.layout, decode_layout_slot);
}

std::size_t MemoryUpdate::size() const {
  return (record_ ? 2 * record_->bytes.size() : 0) + (layout_ ? 2 * layout_->bytes.size() : 0);
}

void MemoryUpdate::put(std::size_t index, Memory& memory) const {
  const std::size_t of_record = record_ ? 2 * record_->bytes.size() : 0;
  if (index < of_record) return put_byte(memory.records, *record_, index);
  if (index < size()) put_byte(memory.layouts, *layout_, index - of_record);
}

}  // namespace pinjaw::core
