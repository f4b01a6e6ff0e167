// Promises: CODEC.
#include "protocol/wire/table.hpp"

#include <gtest/gtest.h>

#include <array>
#include <set>
#include <string>

#include "protocol/wire/codec.hpp"
#include "protocol/wire/services.hpp"

namespace pinjaw::wire {
namespace {

TEST(Table, rows_stand_at_the_place_their_type_says) {
  for (const MessageSpec& spec : kMessages) EXPECT_EQ(&spec_of(spec.type), &spec);
}

TEST(Table, no_two_messages_share_an_id) {
  std::array<int, 0x800> users{};
  for (const MessageSpec& spec : kMessages) {
    const std::uint32_t width = spec.per_node ? 16 : 1;
    for (std::uint32_t id = spec.base_id; id < spec.base_id + width; ++id) ++users.at(id);
  }
  for (const int count : users) EXPECT_LE(count, 1);
}

TEST(Table, no_two_fields_of_a_frame_share_a_bit) {
  for (const MessageSpec& spec : kMessages) {
    for (unsigned page = 0; page < 16; ++page) {
      std::uint64_t used = 0;
      for (const FieldSpec& field : spec.fields) {
        if (field.presence == Presence::Selected && field.selector != page) continue;
        EXPECT_LE(field.start + field.length, 64);
        EXPECT_EQ(used & field.mask(), 0U) << spec.name << '.' << field.name;
        used |= field.mask();
      }
    }
  }
}

TEST(Table, names_are_unique_and_fit_a_dbc) {
  std::set<std::string> messages;
  for (const MessageSpec& spec : kMessages) {
    EXPECT_TRUE(messages.insert(spec.name).second);
    std::set<std::string> fields;
    for (const FieldSpec& field : spec.fields) {
      const std::string name = field.name;
      EXPECT_TRUE(fields.insert(name).second) << spec.name << '.' << name;
      EXPECT_EQ(name.find_first_not_of("ABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_"), std::string::npos);
      EXPECT_LE(name.size(), 32U);
    }
    EXPECT_NE(std::string(spec.comment), "");
  }
}

TEST(Table, data_ids_leave_256_different_residues) {
  std::set<unsigned> residues;
  for (unsigned type = 0; type < 16; ++type) {
    for (unsigned node = 0; node < 16; ++node) {
      Crc8 crc;
      crc.add(static_cast<std::uint8_t>(type << 4 | node));
      crc.add(0x5A);
      for (int i = 0; i < 7; ++i) crc.add(0);
      residues.insert(crc.value());
    }
  }
  EXPECT_EQ(residues.size(), 256U);
}

template <std::size_t N>
void expect_dense(const ValueName (&names)[N], std::size_t count) {
  ASSERT_EQ(N, count);
  for (std::size_t i = 0; i < N; ++i) EXPECT_EQ(names[i].value, i);
}

TEST(Table, every_enumerator_has_a_name) {
  expect_dense(kStateNames, kStateCount);
  expect_dense(kOpNames, kOpCount);
  expect_dense(kReasonNames, kReasonCount);
  expect_dense(kTransferStatusNames, kTransferStatusCount);
  ASSERT_EQ(std::size(kFaultNames), kFaultCodes.size());
  for (std::size_t i = 0; i < kFaultCodes.size(); ++i) {
    EXPECT_EQ(kFaultNames[i].value, static_cast<std::uint32_t>(kFaultCodes.at(i)));
  }
}

TEST(Table, fault_index_and_code_lead_to_each_other) {
  for (std::uint8_t i = 0; i < kFaultCodes.size(); ++i) EXPECT_EQ(index_of(*fault_at(i)), i);
  EXPECT_FALSE(fault_at(static_cast<std::uint8_t>(kFaultCodes.size())).has_value());
  EXPECT_FALSE(fault_at(255).has_value());
}

template <class Crc>
auto check_value() {
  Crc crc;
  for (const char c : std::string("123456789")) crc.add(static_cast<std::uint8_t>(c));
  return crc.value();
}

TEST(Checksum, has_the_published_check_values) {
  EXPECT_EQ(check_value<Crc8>(), 0xDF);
  EXPECT_EQ(check_value<Crc16>(), 0xC2B7);
  EXPECT_EQ(check_value<Crc32>(), 0xCBF43926U);
}

/// Bits in the order in which they travel: each byte's highest first.
Frame with_burst(Frame frame, unsigned first, unsigned pattern) {
  for (unsigned i = 0; i < 8; ++i) {
    const unsigned bit = first + i;
    if ((pattern >> i & 1U) != 0) frame.data.at(bit / 8) ^= static_cast<std::uint8_t>(0x80U >> bit % 8);
  }
  return frame;
}

TEST(Checksum, of_a_frame_is_over_its_data_id_and_the_seven_bytes_behind_it) {
  for (std::uint8_t node = 1; node <= 14; ++node) {
    const Frame frame = pack(Force{.f_high_dn = 771}, {.node = node, .counter = 3});
    Crc8 crc;
    crc.add(static_cast<std::uint8_t>(5 * 16 + node));  // FORCE is the catalogue's fifth
    crc.add(0x5A);
    for (std::size_t i = 1; i < 8; ++i) crc.add(frame.data.at(i));
    EXPECT_EQ(frame.data[0], crc.value()) << int{node};
  }
}

TEST(Checksum, of_a_frame_misses_no_burst_of_eight_bits_in_what_it_covers) {
  const Frame frame = pack(Force{.f_high_dn = 771}, {.node = 2, .counter = 3});
  for (unsigned first = 8; first <= 56; ++first) {
    for (unsigned pattern = 1; pattern < 256; ++pattern) {
      ASSERT_EQ(parse<Force>(with_burst(frame, first, pattern)).error(), FrameError::Checksum);
    }
  }
}

TEST(Checksum, of_a_frame_misses_no_burst_over_its_own_edge_but_one_in_256) {
  const Frame frame = pack(Force{.f_high_dn = 771}, {.node = 2, .counter = 3});
  int missed = 0;
  for (unsigned first = 1; first < 8; ++first) {
    for (unsigned pattern = 1; pattern < 256; ++pattern) {
      missed += parse<Force>(with_burst(frame, first, pattern)).has_value() ? 1 : 0;
    }
  }
  EXPECT_LE(missed, 7 * 255 / 256);
}

}  // namespace
}  // namespace pinjaw::wire
