/// Promises: I7.
///
/// The custody record and the layout in memory: what was stored comes back, damage is told, and a power cut
/// after any byte of any store of a handoff leaves the old value or the new one, and a controller that comes
/// up as one that holds.
#include "firmware_sim/core/record.hpp"

#include <gtest/gtest.h>

#include <random>

#include "tests/firmware_sim/core/bench.hpp"
#include "tests/support/figures.hpp"

namespace pinjaw::core::test {
namespace {

using RecordEngine = std::mt19937_64;

std::uint16_t any_u16(RecordEngine& engine) {
  return static_cast<std::uint16_t>(engine());
}

NvmRecord some_record(RecordEngine& engine) {
  NvmRecord record{.custody = static_cast<Custody>(engine() % 7),
                   .peer = static_cast<std::uint8_t>(engine() % 16),
                   .token = any_u16(engine),
                   .pair = any_u16(engine),
                   .handoff_number = any_u16(engine),
                   .force_set_dn = any_u16(engine),
                   .permit_dn = any_u16(engine),
                   .session_block = static_cast<std::uint32_t>(engine()),
                   .frame_block = static_cast<std::uint32_t>(engine()),
                   .boot_count = any_u16(engine),
                   .seen_givers = any_u16(engine)};
  for (auto& token : record.last_token) token = any_u16(engine);
  for (Outcome& outcome : record.outcomes) {
    outcome = {engine() % 2 == 0, static_cast<std::uint8_t>(engine() % 16), any_u16(engine), any_u16(engine)};
  }
  return record;
}

LayoutBlob some_blob(RecordEngine& engine) {
  LayoutBlob blob;
  for (auto& byte : blob.bytes) byte = static_cast<std::uint8_t>(engine());
  blob.size = static_cast<std::uint16_t>(1 + engine() % blob.bytes.size());
  return blob;
}

/// `request` written up to `bytes` bytes.
Memory written(Memory memory, const NvmWrite& request, std::size_t bytes) {
  const MemoryUpdate update(memory, request);
  for (std::size_t i = 0; i < bytes; ++i) update.put(i, memory);
  return memory;
}

Memory stored(const Memory& memory, const NvmWrite& request) {
  return written(memory, request, MemoryUpdate(memory, request).size());
}

NvmWrite one(const NvmRecord& record) {
  return {.sequence = 1, .record = record, .layout = std::nullopt};
}

NvmWrite both(const NvmRecord& record, const LayoutBlob& layout) {
  return {.sequence = 1, .record = record, .layout = layout};
}

TEST(RecordMemory, blank_holds_nothing_and_is_readable) {
  const NvmImage image = image_of(Memory{});
  EXPECT_FALSE(image.record);
  EXPECT_TRUE(image.readable);
  EXPECT_EQ(image.layout.size, 0);
}

TEST(RecordMemory, gives_back_the_last_of_many_stores) {
  RecordEngine engine(1);
  Memory memory;
  for (int i = 0; i < 200; ++i) {
    const NvmRecord record = some_record(engine);
    const LayoutBlob blob = some_blob(engine);
    memory = stored(memory, both(record, blob));
    EXPECT_EQ(image_of(memory).record, record);
    EXPECT_EQ(image_of(memory).layout, blob);
  }
}

TEST(RecordMemory, goes_on_where_the_sequence_wraps) {
  RecordEngine engine(2);
  Memory memory;
  const NvmRecord first = some_record(engine);
  memory.records[0] = encode(Stored<NvmRecord>{0xFFFFFFFF, first});
  const NvmRecord next = some_record(engine);
  const Memory torn = written(memory, one(next), RecordSlot{}.size());
  EXPECT_EQ(image_of(torn).record, next) << "0 comes after 0xFFFFFFFF";
}

TEST(RecordMemory, cut_after_any_byte_of_a_store_holds_the_old_or_the_new) {
  RecordEngine engine(3);
  Memory memory;
  for (int round = 0; round < 6; ++round) {
    const NvmImage before = image_of(memory);
    const NvmRecord record = some_record(engine);
    const LayoutBlob blob = some_blob(engine);
    const NvmWrite request = both(record, blob);
    const std::size_t size = MemoryUpdate(memory, request).size();
    for (std::size_t bytes = 0; bytes <= size; ++bytes) {
      const NvmImage after = image_of(written(memory, request, bytes));
      EXPECT_TRUE(after.readable) << bytes;
      // Whole as soon as its first slot is; the last bytes of that may happen to be right already.
      const bool is_new = after.record == std::optional(record);
      EXPECT_TRUE(is_new || after.record == before.record) << bytes;
      EXPECT_TRUE(is_new || bytes < RecordSlot{}.size()) << bytes;
      EXPECT_TRUE(after.layout == blob || after.layout == before.layout) << bytes;
      EXPECT_TRUE(after.layout == blob || bytes < size - LayoutSlot{}.size()) << bytes;
    }
    // The next store begins on a memory that was cut short in either slot, and is cut short again.
    memory = written(memory, request, engine() % size);
  }
}

TEST(RecordMemory, cut_in_store_after_store_never_loses_both_slots) {
  RecordEngine engine(4);
  Memory memory;
  std::optional<NvmRecord> last;
  for (int i = 0; i < 5000; ++i) {
    const NvmRecord record = some_record(engine);
    const NvmWrite request = one(record);
    memory = written(memory, request, engine() % (MemoryUpdate(memory, request).size() + 1));
    const NvmImage image = image_of(memory);
    ASSERT_TRUE(image.readable) << i;
    ASSERT_TRUE(image.record == last || image.record == std::optional(record)) << i;
    last = image.record;
  }
}

TEST(RecordMemory, survives_the_decay_of_either_slot_and_says_when_both_are_gone) {
  RecordEngine engine(5);
  const NvmRecord old = some_record(engine);
  const NvmRecord record = some_record(engine);
  Memory memory = stored(Memory{}, one(old));
  memory = stored(memory, one(record));
  for (std::size_t bit = 0; bit < 8 * RecordSlot{}.size(); ++bit) {
    for (const std::size_t slot : {0U, 1U}) {
      Memory decayed = memory;
      decayed.records[slot][bit / 8] ^= static_cast<std::uint8_t>(1U << bit % 8);
      EXPECT_EQ(image_of(decayed).record, record);
      decayed.records[1 - slot][bit / 8] ^= static_cast<std::uint8_t>(1U << bit % 8);
      EXPECT_FALSE(image_of(decayed).record);
      EXPECT_FALSE(image_of(decayed).readable);
    }
  }
}

TEST(RecordMemory, takes_no_slot_with_one_or_two_bits_flipped_or_of_another_length) {
  RecordEngine engine(6);
  const RecordSlot good = encode(Stored<NvmRecord>{7, some_record(engine)});
  ASSERT_TRUE(decode_record(good));
  for (std::size_t a = 0; a < 8 * good.size(); ++a) {
    RecordSlot bad = good;
    bad[a / 8] ^= static_cast<std::uint8_t>(1U << a % 8);
    ASSERT_FALSE(decode_record(bad));
    for (std::size_t b = 0; b < a; ++b) {
      RecordSlot worse = bad;
      worse[b / 8] ^= static_cast<std::uint8_t>(1U << b % 8);
      ASSERT_FALSE(decode_record(worse));
    }
  }
  for (std::size_t size = 0; size < good.size(); ++size) {
    EXPECT_FALSE(decode_record(std::span(good).first(size)));
  }
}

TEST(RecordMemory, takes_no_number_that_means_nothing_even_under_a_right_checksum) {
  NvmRecord record{.custody = static_cast<Custody>(7)};
  EXPECT_FALSE(decode_record(encode(Stored<NvmRecord>{0, record})));
  record = {.peer = 16};
  EXPECT_FALSE(decode_record(encode(Stored<NvmRecord>{0, record})));
  record = {};
  record.outcomes[3].peer = 16;
  EXPECT_FALSE(decode_record(encode(Stored<NvmRecord>{0, record})));
  LayoutBlob blob;
  blob.size = 257;
  EXPECT_FALSE(decode_layout_slot(encode(Stored<LayoutBlob>{0, blob})));
}

/// Cuts the power of a station after every byte of every store it asks for, and looks at what comes up.
class EveryCut {
 public:
  explicit EveryCut(Bench& bench) : bench_(bench) {
    bench.after_step = [this] {
      for (const std::uint8_t node : {kArm, kPedestal, kPallet}) look_at(bench_.at(node));
    };
  }
  [[nodiscard]] std::int64_t cuts() const { return cuts_; }

 private:
  void look_at(const Station& station) {
    Memory& memory = memories_[station.config.node];
    StateId& state_before = states_[station.config.node];
    if (station.outputs.nvm) {
      const std::size_t size = MemoryUpdate(memory, *station.outputs.nvm).size();
      for (std::size_t bytes = 0; bytes <= size; ++bytes) {
        comes_up(station, state_before, written(memory, *station.outputs.nvm, bytes), image_of(memory));
      }
      memory = stored(memory, *station.outputs.nvm);
    }
    state_before = station.id();
  }

  void comes_up(const Station& station, StateId before, const Memory& memory, const NvmImage& old) {
    ++cuts_;
    const NvmImage image = image_of(memory);
    const auto asked = station.outputs.nvm->record;
    EXPECT_TRUE(image.readable);
    EXPECT_TRUE(image.record == old.record || image.record == asked);
    State core = power_on(station.config, image);
    ToyJaw jaw = station.jaw;
    const bool decided = image.record && image.record->custody == Custody::Decided;
    for (int ms = 0; ms < 5; ++ms) {
      const Outputs outputs = step(core, {.sensors = jaw.read(), .nvm = {.done = core.store.requested}});
      EXPECT_TRUE(decided || outputs.valves.spool != Spool::Open) << wire::to_string(before);
      jaw.step(outputs.valves);
    }
    const bool answers_still = image.record == old.record || before == station.id() || holds(station.id());
    if (holds(before) && answers_still && !decided) {
      EXPECT_TRUE(grips(core.id)) << wire::to_string(before) << " came up as " << wire::to_string(core.id);
    }
  }

  Bench& bench_;
  std::array<Memory, 4> memories_{};
  std::array<StateId, 4> states_{};
  std::int64_t cuts_ = 0;
};

TEST(RecordMemory, with_power_cut_after_any_byte_of_a_handoff_who_held_holds) {
  Bench bench;
  bench.load_all();
  EveryCut every(bench);
  bench.load_gripper(kArm);
  ASSERT_TRUE(bench.hand_over(kArm, kPedestal));
  bench.bring_part(kArm, false);
  ASSERT_TRUE(bench.hand_over(kPedestal, kArm));
  EXPECT_GT(every.cuts(), 2000);
  pinjaw::test::figure("I7", "power cuts, after every byte of every store of two handoffs", every.cuts(),
                       "cuts");
}

}  // namespace
}  // namespace pinjaw::core::test
