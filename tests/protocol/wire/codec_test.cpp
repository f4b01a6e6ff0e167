// Promises: CODEC.
#include "protocol/wire/codec.hpp"

#include <gtest/gtest.h>

#include <set>
#include <string>

#include "protocol/wire/dispatch.hpp"
#include "tests/protocol/wire/sample_messages.hpp"

namespace pinjaw::wire {
namespace {

using testing::Engine;
using testing::random_label;
using testing::random_message;

static_assert(parse<NodeState>(pack(NodeState{}, {.node = 3, .counter = 7}))->label == Label{3, 7},
              "the codec works at compile time");

template <class Message>
class EveryMessage : public ::testing::Test {};

using Messages = ::testing::Types<GlobalHold, FaultReport, Custody, NodeState, Force, HostHeartbeat, HostTime,
                                  Command, Acknowledge, Pneumatics, LayoutStatus, Identity>;

class MessageName {
 public:
  template <class Message>
  static std::string GetName(int) {
    return spec_of(Message::kType).name;
  }
};
TYPED_TEST_SUITE(EveryMessage, Messages, MessageName);

/// Makes the checksum right again after tampering with the payload.
Frame reseal(Frame frame) {
  frame.data[0] = detail::checksum(*identify(frame), frame.data);
  return frame;
}

/// The names of the rows that a message's members stand for.
struct Collect {
  std::set<std::string> seen;
  template <class T>
  void operator()(const FieldSpec& field, const T& /*member*/) {
    seen.insert(field.name);
  }
};

Frame flipped(Frame frame, unsigned bit) {
  frame.data[bit / 8] = static_cast<std::uint8_t>(frame.data[bit / 8] ^ (1U << bit % 8));
  return frame;
}

TYPED_TEST(EveryMessage, comes_back_as_it_was_sent) {
  Engine engine(1);
  for (int i = 0; i < 2000; ++i) {
    const auto message = random_message<TypeParam>(engine);
    const Label label = random_label<TypeParam>(engine);
    const auto back = parse<TypeParam>(pack(message, label));
    ASSERT_TRUE(back.has_value());
    EXPECT_EQ(back->message, message);
    EXPECT_EQ(back->label, label);
  }
}

TYPED_TEST(EveryMessage, loses_no_bit_flip_of_one_or_two_bits) {
  Engine engine(2);
  for (int i = 0; i < 8; ++i) {
    const Frame frame = pack(random_message<TypeParam>(engine), random_label<TypeParam>(engine));
    for (unsigned a = 0; a < 64; ++a) {
      ASSERT_EQ(parse<TypeParam>(flipped(frame, a)).error(), FrameError::Checksum);
      for (unsigned b = 0; b < a; ++b) {
        ASSERT_EQ(parse<TypeParam>(flipped(flipped(frame, a), b)).error(), FrameError::Checksum);
      }
    }
  }
}

TYPED_TEST(EveryMessage, loses_no_bit_flip_of_three_bits) {
  Engine engine(3);
  const Frame frame = pack(random_message<TypeParam>(engine), random_label<TypeParam>(engine));
  for (unsigned a = 0; a < 64; ++a) {
    for (unsigned b = 0; b < a; ++b) {
      for (unsigned c = 0; c < b; ++c) {
        ASSERT_FALSE(parse<TypeParam>(flipped(flipped(flipped(frame, a), b), c)).has_value());
      }
    }
  }
}

TYPED_TEST(EveryMessage, is_not_taken_for_another_nodes_or_messages) {
  Engine engine(4);
  const Frame frame = pack(random_message<TypeParam>(engine), random_label<TypeParam>(engine));
  for (std::uint32_t id = 0; id < 0x800; ++id) {
    if (id == frame.id) continue;
    Frame moved = frame;
    moved.id = id;
    EXPECT_TRUE(dispatch(moved,
                         [](const auto& received) {
                           // Segments of a transfer carry no checksum of their own.
                           static_cast<void>(received);
                         })
                    .has_value() ||
                parse_segment(moved).has_value())
        << id;
  }
}

TYPED_TEST(EveryMessage, of_any_other_length_is_dropped) {
  Engine engine(5);
  Frame frame = pack(random_message<TypeParam>(engine), random_label<TypeParam>(engine));
  for (const unsigned length : {0U, 1U, 2U, 3U, 4U, 5U, 6U, 7U, 9U, 15U, 64U, 255U}) {
    frame.length = static_cast<std::uint8_t>(length);
    EXPECT_EQ(parse<TypeParam>(frame).error(), FrameError::Length);
  }
}

TYPED_TEST(EveryMessage, as_remote_error_or_extended_frame_is_dropped) {
  Engine engine(6);
  const Frame good = pack(random_message<TypeParam>(engine), random_label<TypeParam>(engine));
  Frame frame = good;
  frame.kind = FrameKind::Remote;
  EXPECT_EQ(parse<TypeParam>(frame).error(), FrameError::NotData);
  frame.kind = FrameKind::Error;
  EXPECT_EQ(parse<TypeParam>(frame).error(), FrameError::NotData);
  frame = good;
  frame.extended = true;
  EXPECT_EQ(parse<TypeParam>(frame).error(), FrameError::Extended);
}

TYPED_TEST(EveryMessage, with_a_reserved_bit_set_is_dropped) {
  Engine engine(7);
  for (int i = 0; i < 50; ++i) {
    const auto message = random_message<TypeParam>(engine);
    const Frame frame = pack(message, random_label<TypeParam>(engine));
    detail::Reader reader{.word = 0, .seen = detail::header_mask(spec_of(TypeParam::kType).protection)};
    TypeParam scratch = message;
    reader.word = to_word(frame.data);
    TypeParam::fields(scratch, reader);
    for (unsigned bit = 8; bit < 64; ++bit) {
      if ((reader.seen >> bit & 1U) != 0) continue;
      EXPECT_EQ(parse<TypeParam>(reseal(flipped(frame, bit))).error(), FrameError::Reserved) << bit;
    }
  }
}

TYPED_TEST(EveryMessage, with_a_number_that_means_nothing_is_dropped) {
  Engine engine(8);
  for (const FieldSpec& field : spec_of(TypeParam::kType).fields) {
    if (field.presence == Presence::Selected || field.name == std::string("VER")) continue;
    for (std::uint64_t raw = 0; raw <= std::min<std::uint64_t>(ones(field.length), 0xFFFF); ++raw) {
      if (field.admits(raw) || field.start == 0) continue;
      Frame frame = pack(random_message<TypeParam>(engine), random_label<TypeParam>(engine));
      frame.data = to_payload((to_word(frame.data) & ~field.mask()) | raw << field.start);
      const FrameError wanted = field.name == std::string("CTR") ? FrameError::Counter : FrameError::Value;
      const auto message = parse<TypeParam>(reseal(frame));
      ASSERT_FALSE(message.has_value()) << field.name << ' ' << raw;
      EXPECT_EQ(message.error(), wanted) << field.name << ' ' << raw;
    }
  }
}

TYPED_TEST(EveryMessage, has_a_member_for_every_row_of_the_table) {
  Collect collect;
  TypeParam message;
  if constexpr (TypeParam::kType == MessageType::Identity) {
    for (int page = 0; page < 5; ++page) {
      message.page = static_cast<IdentityPage>(page);
      TypeParam::fields(message, collect);
    }
  } else {
    TypeParam::fields(message, collect);
  }
  const MessageSpec& spec = spec_of(TypeParam::kType);
  const std::size_t header = spec.protection == Protection::Counter ? 3 : 1;
  for (std::size_t i = header; i < spec.fields.size(); ++i) {
    EXPECT_TRUE(collect.seen.contains(spec.fields[i].name)) << spec.fields[i].name;
  }
  EXPECT_EQ(collect.seen.size() + header, spec.fields.size());
}

TEST(Codec, refuses_counter_15_and_other_versions) {
  Frame frame = pack(Force{}, {.node = 2, .counter = 14});
  frame.data[1] = static_cast<std::uint8_t>(frame.data[1] | 0x0F);
  EXPECT_EQ(parse<Force>(reseal(frame)).error(), FrameError::Counter);
  frame = pack(Force{}, {.node = 2, .counter = 14});
  frame.data[1] = 0x2E;
  EXPECT_EQ(parse<Force>(reseal(frame)).error(), FrameError::Version);
}

TEST(Codec, says_a_quantity_past_its_field_as_the_largest_it_can) {
  const Force told{
      .f_high_dn = 5000, .f_set_dn = 4095, .f_limit_effective_dn = 4094, .f_measured_dn = std::nullopt};
  const auto back = parse<Force>(pack(told, {.node = 1}));
  ASSERT_TRUE(back.has_value());
  EXPECT_EQ(back->message.f_high_dn, 4094);
  EXPECT_EQ(back->message.f_set_dn, 4094);
  EXPECT_EQ(back->message.f_limit_effective_dn, 4094);
  EXPECT_FALSE(back->message.f_measured_dn.has_value());
}

TEST(Codec, keeps_custody_unknown_apart_from_every_fact) {
  for (const Fact fact :
       {Fact::Empty, Fact::Sole, Fact::Offer, Fact::Take, Fact::Released, Fact::Retain, Fact::Unknown}) {
    EXPECT_EQ(parse<NodeState>(pack(NodeState{.custody = fact}, {.node = 1}))->message.custody, fact);
    EXPECT_EQ(parse<Custody>(pack(Custody{.fact = fact}, {.node = 1}))->message.fact, fact);
  }
}

/// One frame of STATE computed by hand from the catalogue: bit positions are a promise to other tools.
TEST(Codec, puts_state_where_the_catalogue_says) {
  const NodeState state{.state = State::Hold,
                        .armed = true,
                        .layout_ok = true,
                        .host_alive = false,
                        .part = true,
                        .hold_stable = true,
                        .custody = Fact::Sole,
                        .f_low_dn = 771,
                        .separation_50um = 624,
                        .fault = FaultCode::HoldLost};
  const Frame frame = pack(state, {.node = 2, .counter = 5});
  EXPECT_EQ(frame.id, 0x062U);
  EXPECT_EQ(frame.data[1], 0x15);
  EXPECT_EQ(frame.data[2], 9 | 0x20 | 0x40);
  EXPECT_EQ(frame.data[3], 0x01 | 0x02 | 1 << 5);
  EXPECT_EQ(frame.data[4], 771 & 0xFF);
  EXPECT_EQ(frame.data[5], (771 >> 8) | (624 & 0xF) << 4);
  EXPECT_EQ(frame.data[6], 624 >> 4);
  EXPECT_EQ(frame.data[7], index_of(FaultCode::HoldLost));
}

TEST(Codec, takes_no_message_from_random_streams_but_by_chance) {
  Engine engine(9);
  int taken = 0;
  constexpr int kFrames = 400'000;
  for (int i = 0; i < kFrames; ++i) {
    Frame frame;
    frame.id = static_cast<std::uint32_t>(engine() % 0x260);
    frame.data = to_payload(engine());
    frame.length = engine() % 8 == 0 ? static_cast<std::uint8_t>(engine() % 16) : std::uint8_t{8};
    taken += dispatch(frame, [](const auto&) {}).has_value() ? 0 : 1;
  }
  EXPECT_LT(taken, kFrames / 256);
}

}  // namespace
}  // namespace pinjaw::wire
