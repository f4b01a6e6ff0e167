// Promises: I7.
#include <gtest/gtest.h>

#include <optional>
#include <vector>

#include "firmware_sim/core/record.hpp"

/// The bytes of non-volatile memory: what a controller of today writes, one of tomorrow must read.
namespace pinjaw::core::test {
namespace {

using Bytes = std::vector<std::uint8_t>;

/// CRC-32 of IEEE 802.3, bit by bit.
std::uint32_t crc32_of(const Bytes& bytes) {
  std::uint32_t crc = 0xFFFFFFFF;
  for (const std::uint8_t byte : bytes) {
    crc ^= byte;
    for (int bit = 0; bit < 8; ++bit) crc = crc >> 1 ^ ((crc & 1U) != 0 ? 0xEDB88320U : 0U);
  }
  return ~crc;
}

void append(Bytes& bytes, std::uint64_t value, int count) {
  for (int i = 0; i < count; ++i) bytes.push_back(static_cast<std::uint8_t>(value >> 8 * i));
}

Bytes sealed(Bytes bytes) {
  append(bytes, crc32_of(bytes), 4);
  return bytes;
}

template <class Slot>
Bytes bytes_of(const Slot& slot) {
  return {slot.begin(), slot.end()};
}

/// No two members alike.
NvmRecord distinct_record() {
  NvmRecord record{.custody = Custody::Latched,
                   .peer = 0x0B,
                   .token = 0x2221,
                   .pair = 0x2423,
                   .handoff_number = 0x2625,
                   .force_set_dn = 0x2827,
                   .permit_dn = 0x2A29,
                   .session_block = 0x2E2D2C2B,
                   .frame_block = 0x3231302F,
                   .boot_count = 0x3433,
                   .seen_givers = 0x3635};
  for (unsigned i = 0; i < 16; ++i) record.last_token[i] = static_cast<std::uint16_t>(0x4140 + 0x0202 * i);
  for (unsigned i = 0; i < 4; ++i) {
    record.outcomes[i] = {.retained = i % 2 == 1,
                          .peer = static_cast<std::uint8_t>(i + 1),
                          .token = static_cast<std::uint16_t>(0x7170 + i),
                          .pair = static_cast<std::uint16_t>(0x8180 + i)};
  }
  return record;
}

Bytes distinct_record_bytes() {
  Bytes bytes{'P', 'J', 'R', '1', 0x04, 0x03, 0x02, 0x01, 3, 0x0B};
  for (std::uint8_t byte = 0x21; byte <= 0x36; ++byte) bytes.push_back(byte);
  for (std::uint8_t byte = 0x40; byte < 0x60; ++byte) bytes.push_back(byte);
  for (std::uint8_t i = 0; i < 4; ++i) {
    for (const unsigned byte : {i % 2U, i + 1U, 0x70U + i, 0x71U, 0x80U + i, 0x81U})
      bytes.push_back(static_cast<std::uint8_t>(byte));
  }
  return sealed(bytes);
}

LayoutBlob distinct_blob(std::uint16_t size) {
  LayoutBlob blob{.bytes = {}, .size = size};
  for (std::size_t i = 0; i < blob.bytes.size(); ++i) blob.bytes[i] = static_cast<std::uint8_t>(7 * i + 1);
  return blob;
}

TEST(RecordBytes, are_magic_sequence_members_in_order_and_a_checksum) {
  EXPECT_EQ(bytes_of(encode(Stored<NvmRecord>{0x01020304, distinct_record()})), distinct_record_bytes());
  Bytes bytes{'P', 'J', 'B', '1', 0x08, 0x07, 0x06, 0x05, 0x00, 0x01};
  for (unsigned i = 0; i < 256; ++i) bytes.push_back(static_cast<std::uint8_t>(7 * i + 1));
  EXPECT_EQ(bytes_of(encode(Stored<LayoutBlob>{0x05060708, distinct_blob(256)})), sealed(bytes));
}

TEST(RecordBytes, each_counts_for_itself_or_makes_the_slot_worthless_though_its_checksum_is_right) {
  Bytes record = distinct_record_bytes();
  record.resize(record.size() - 4);
  const auto legal = [](std::size_t at, unsigned value) {
    if (at < 4) return false;         // another format
    if (at == 8) return value <= 6;   // custody
    if (at == 9) return value <= 15;  // a node, or the operator
    const bool outcome = at >= 64;    // six bytes each
    if (outcome && (at - 64) % 6 == 0) return value <= 1;
    return !outcome || (at - 64) % 6 != 1 || value <= 15;
  };
  for (std::size_t at = 0; at < record.size(); ++at) {
    for (const unsigned value : {0U, 1U, 2U, 6U, 7U, 15U, 16U, 0x7FU, 0x80U, 0xFFU}) {
      Bytes changed = record;
      if (changed[at] == value) continue;
      changed[at] = static_cast<std::uint8_t>(value);
      changed = sealed(changed);
      const auto read = decode_record(changed);
      ASSERT_EQ(read.has_value(), legal(at, value)) << at << ": " << value;
      if (!read) continue;
      ASSERT_EQ(bytes_of(encode(*read)), changed) << at << ": " << value;
    }
  }
}

TEST(RecordBytes, of_a_layout_have_a_size_of_256_at_most) {
  for (const int bytes : {0, 1, 255, 256, 257, 0x200, 0xFFFF}) {
    const auto size = static_cast<std::uint16_t>(bytes);
    const LayoutSlot slot = encode(Stored<LayoutBlob>{9, distinct_blob(size)});
    const auto read = decode_layout_slot(slot);
    ASSERT_EQ(read.has_value(), size <= 256) << size;
    if (!read) continue;
    EXPECT_EQ(read->sequence, 9U);
    EXPECT_EQ(read->value, distinct_blob(size));
  }
}

TEST(RecordBytes, are_none_where_one_is_another_or_the_slot_is_too_long_or_short) {
  const Bytes record = distinct_record_bytes();
  const Bytes layout = bytes_of(encode(Stored<LayoutBlob>{1, distinct_blob(200)}));
  for (const Bytes& good : {record, layout}) {
    const bool is_record = good.size() == record.size();
    const auto readable = [&](const Bytes& bytes) {
      return is_record ? decode_record(bytes).has_value() : decode_layout_slot(bytes).has_value();
    };
    EXPECT_TRUE(readable(good));
    for (std::size_t at = 0; at < good.size(); ++at) {
      Bytes changed = good;
      changed[at] ^= 0x10U;
      EXPECT_FALSE(readable(changed)) << at;
      EXPECT_FALSE(readable(Bytes(good.begin(), good.begin() + static_cast<long>(at)))) << at;
    }
    Bytes longer = good;
    longer.push_back(0);
    EXPECT_FALSE(readable(longer));
    Bytes stretched(good.begin(), good.end() - 4);
    stretched.push_back(0);
    EXPECT_FALSE(readable(sealed(stretched))) << "a whole slot, but of another size";
  }
  for (std::size_t at = 0; at < 4; ++at) {
    Bytes changed(layout.begin(), layout.end() - 4);
    changed[at] ^= 1U;
    EXPECT_FALSE(decode_layout_slot(sealed(changed)).has_value()) << "another format";
  }
  EXPECT_FALSE(decode_record(layout).has_value());
  EXPECT_FALSE(decode_layout_slot(record).has_value());
}

/// A memory whose slots hold `value_of(slot)` under these sequences; without one, noise.
struct TwoSlots {
  std::optional<std::uint32_t> first;
  std::optional<std::uint32_t> second;
};

NvmRecord record_of(std::size_t slot) {
  return {.custody = Custody::Sole, .token = static_cast<std::uint16_t>(100 + slot)};
}
LayoutBlob blob_of(std::size_t slot) {
  return distinct_blob(static_cast<std::uint16_t>(100 + slot));
}

Memory memory_of(const TwoSlots& sequences) {
  Memory memory;
  for (std::size_t slot = 0; slot < 2; ++slot) {
    memory.records[slot].fill(0x5A);
    memory.layouts[slot].fill(0x5A);
    const auto& sequence = slot == 0 ? sequences.first : sequences.second;
    if (!sequence) continue;
    memory.records[slot] = encode(Stored<NvmRecord>{*sequence, record_of(slot)});
    memory.layouts[slot] = encode(Stored<LayoutBlob>{*sequence, blob_of(slot)});
  }
  return memory;
}

struct OrderCase {
  TwoSlots sequences;
  std::size_t present;      ///< slot with the value that counts
  std::uint32_t next;       ///< sequence of the next store
  std::size_t overwritten;  ///< slot that the next store writes first
};

TEST(TwoSlotsOrder, the_later_counts_in_a_half_window_and_the_next_store_spares_it_longest) {
  const std::vector<OrderCase> cases = {{{5, 6}, 1, 7, 0},
                                        {{6, 5}, 0, 7, 1},
                                        {{5, 5}, 0, 6, 1},
                                        {{0, 0x7FFFFFFF}, 1, 0x80000000, 0},
                                        {{0, 0x80000000}, 0, 1, 1},
                                        {{0x80000000, 0}, 0, 0x80000001, 1},
                                        {{0x80000001, 0}, 1, 1, 0},
                                        {{0xFFFFFFFF, 0}, 1, 1, 0},
                                        {{0, 0xFFFFFFFF}, 0, 1, 1},
                                        {{0x7FFFFFFF, 0x7FFFFFFE}, 0, 0x80000000, 1},
                                        {{9, std::nullopt}, 0, 10, 1},
                                        {{0x80000001, std::nullopt}, 0, 0x80000002, 1},
                                        {{std::nullopt, 9}, 1, 10, 0},
                                        {{std::nullopt, 0xFFFFFFFF}, 1, 0, 0}};
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const OrderCase& one = cases[i];
    const Memory before = memory_of(one.sequences);
    EXPECT_EQ(image_of(before).record, record_of(one.present)) << "case " << i;
    EXPECT_EQ(image_of(before).layout, blob_of(one.present)) << "case " << i;
    EXPECT_TRUE(image_of(before).readable);

    const NvmRecord record{.custody = Custody::Sole, .token = 300};
    const LayoutBlob layout = distinct_blob(30);
    const MemoryUpdate update(before, {.sequence = 1, .record = record, .layout = layout});
    Memory after = before;
    for (std::size_t at = 0; at < RecordSlot{}.size(); ++at) update.put(at, after);
    EXPECT_EQ(after.records[one.overwritten], encode(Stored<NvmRecord>{one.next, record})) << "case " << i;
    EXPECT_EQ(after.records[1 - one.overwritten], before.records[1 - one.overwritten]) << "case " << i;
    EXPECT_EQ(after.layouts, before.layouts);
    for (std::size_t at = RecordSlot{}.size(); at < 2 * RecordSlot{}.size() + LayoutSlot{}.size(); ++at)
      update.put(at, after);
    EXPECT_EQ(after.records[0], after.records[1]);
    EXPECT_EQ(after.layouts[one.overwritten], encode(Stored<LayoutBlob>{one.next, layout})) << "case " << i;
    EXPECT_EQ(after.layouts[1 - one.overwritten], before.layouts[1 - one.overwritten]) << "case " << i;
  }
}

TEST(TwoSlotsOrder, begins_with_sequence_0_in_the_first_slot) {
  for (const Memory& before : {Memory{}, memory_of({})}) {
    const MemoryUpdate update(before, {.sequence = 1, .record = record_of(0), .layout = blob_of(0)});
    EXPECT_EQ(update.size(), 2 * RecordSlot{}.size() + 2 * LayoutSlot{}.size());
    Memory after = before;
    for (std::size_t at = 0; at < RecordSlot{}.size(); ++at) update.put(at, after);
    EXPECT_EQ(after.records[0], encode(Stored<NvmRecord>{0, record_of(0)}));
    EXPECT_EQ(after.records[1], before.records[1]);
    for (std::size_t at = RecordSlot{}.size(); at < update.size(); ++at) update.put(at, after);
    EXPECT_EQ(after.records[1], after.records[0]);
    EXPECT_EQ(after.layouts[1], after.layouts[0]);
    EXPECT_EQ(after.layouts[0], encode(Stored<LayoutBlob>{0, blob_of(0)}));
  }
}

TEST(TwoSlotsOrder, a_store_of_one_part_leaves_the_other_and_ends_where_it_says) {
  const Memory before = memory_of({3, 4});
  const auto stored = [&](const NvmWrite& request) {
    const MemoryUpdate update(before, request);
    Memory after = before;
    for (std::size_t at = 0; at < update.size(); ++at) update.put(at, after);
    const Memory whole = after;
    for (std::size_t more = 0; more < 3; ++more) update.put(update.size() + more, after);
    EXPECT_EQ(after, whole) << "past its end there is nothing to write";
    return after;
  };
  EXPECT_EQ(MemoryUpdate(before, {}).size(), 0U);
  EXPECT_EQ(stored({}), before);
  const Memory record_only = stored({.sequence = 1, .record = record_of(7), .layout = std::nullopt});
  EXPECT_EQ(record_only.layouts, before.layouts);
  EXPECT_EQ(record_only.records[0], encode(Stored<NvmRecord>{5, record_of(7)}));
  EXPECT_EQ(record_only.records[1], record_only.records[0]);
  const Memory layout_only = stored({.sequence = 1, .record = std::nullopt, .layout = blob_of(7)});
  EXPECT_EQ(layout_only.records, before.records);
  EXPECT_EQ(layout_only.layouts[0], encode(Stored<LayoutBlob>{5, blob_of(7)}));
  EXPECT_EQ(layout_only.layouts[1], layout_only.layouts[0]);
}

TEST(BlankSlots, are_all_0xFF_and_tell_a_memory_that_was_never_written_from_one_that_is_lost) {
  const Memory fresh;
  for (const std::uint8_t byte : fresh.records[0]) EXPECT_EQ(byte, 0xFF);
  for (const std::uint8_t byte : fresh.layouts[1]) EXPECT_EQ(byte, 0xFF);
  const Memory lost = memory_of({});
  for (const std::size_t blank : {std::size_t{0}, std::size_t{1}}) {
    Memory half = lost;
    half.records[blank] = Memory{}.records[blank];
    EXPECT_TRUE(image_of(half).readable) << blank;
    for (const std::size_t at : {std::size_t{0}, std::size_t{50}, half.records[blank].size() - 1}) {
      Memory decayed = half;
      decayed.records[blank][at] = 0xFE;
      EXPECT_FALSE(image_of(decayed).readable) << at;
    }
  }
  EXPECT_FALSE(image_of(lost).readable);
  EXPECT_FALSE(image_of(lost).record.has_value());
  EXPECT_EQ(image_of(lost).layout, LayoutBlob{});
}

}  // namespace
}  // namespace pinjaw::core::test
