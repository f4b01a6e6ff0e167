// Promises: CODEC.
#include <gtest/gtest.h>

#include <map>

#include "protocol/wire/codec.hpp"
#include "protocol/wire/commands.hpp"
#include "protocol/wire/dispatch.hpp"
#include "protocol/wire/names.hpp"

namespace pinjaw::wire {
namespace {

/// The catalogue of docs/reliability.md 2.3: every id there is, and whose it is.
std::map<std::uint32_t, Identifier> catalogue() {
  std::map<std::uint32_t, Identifier> ids = {{0x0F0, {MessageType::HostHeartbeat, 0}},
                                             {0x0F8, {MessageType::Time, 0}}};
  for (std::uint8_t node = 0; node < 16; ++node) ids[0x010U + node] = {MessageType::GlobalHold, node};
  const std::map<std::uint32_t, MessageType> per_node = {
      {0x020, MessageType::Fault},           {0x040, MessageType::Custody},
      {0x060, MessageType::State},           {0x0A0, MessageType::Force},
      {0x100, MessageType::Command},         {0x140, MessageType::Acknowledge},
      {0x200, MessageType::Pneumatics},      {0x220, MessageType::LayoutStatus},
      {0x240, MessageType::Identity},        {0x600, MessageType::TransferRequest},
      {0x680, MessageType::TransferResponse}};
  for (const auto& [base, type] : per_node) {
    for (std::uint8_t node = 1; node <= 14; ++node) ids[base + node] = {type, node};
  }
  return ids;
}

TEST(Addressing, knows_the_ids_of_the_catalogue_and_no_other) {
  const auto ids = catalogue();
  for (std::uint32_t id = 0; id < 0x900; ++id) {
    const auto found = identify(id);
    const auto wanted = ids.find(id);
    ASSERT_EQ(found.has_value(), wanted != ids.end()) << std::hex << id;
    if (!found) continue;
    EXPECT_EQ(*found, wanted->second) << std::hex << id;
    EXPECT_EQ(id_of(*found), id);
  }
  EXPECT_FALSE(identify(0xFFFFFFFFU).has_value());
}

TEST(Addressing, calls_what_it_does_not_know_an_unknown_id) {
  EXPECT_EQ(identify(Frame{.id = 0x7FF}).error(), FrameError::UnknownId);
  EXPECT_EQ(identify(Frame{.id = 0x061, .kind = FrameKind::Error}).error(), FrameError::NotData);
  EXPECT_EQ(identify(Frame{.id = 0x061, .extended = true}).error(), FrameError::Extended);
}

TEST(Addressing, parses_no_message_from_another_ones_frame) {
  const Frame frame = pack(Force{.f_high_dn = 3}, {.node = 4, .counter = 2});
  EXPECT_EQ(parse<NodeState>(frame).error(), FrameError::UnknownId);
  EXPECT_EQ(parse<Force>(frame)->label, (Label{4, 2}));
  EXPECT_FALSE(parse_segment(frame).has_value());
  EXPECT_EQ(parse_segment(frame).error(), FrameError::UnknownId);
}

TEST(Addressing, of_a_frame_that_no_one_filled_is_node_0_and_eight_empty_bytes_of_data) {
  const Frame frame;
  EXPECT_EQ(frame.id, 0U);
  EXPECT_EQ(frame.kind, FrameKind::Data);
  EXPECT_FALSE(frame.extended);
  EXPECT_EQ(frame.length, 8);
  EXPECT_EQ(Label{}, (Label{0, 0}));
  EXPECT_EQ(Identifier{}.node, 0);
}

/// What a handler was given, by the type of the message.
struct Heard {
  std::map<MessageType, int>& times;
  template <class Message>
  void operator()(const Received<Message>&) const {
    ++times[Message::kType];
  }
  void operator()(const Segment& segment) const { ++times[segment.identifier.type]; }
};

TEST(Dispatch, takes_each_message_to_its_own_handler) {
  const std::map<MessageType, Frame> said = {
      {MessageType::GlobalHold, pack(GlobalHold{}, {.node = 15})},
      {MessageType::Fault, pack(FaultReport{}, {.node = 1})},
      {MessageType::Custody, pack(Custody{}, {.node = 1})},
      {MessageType::State, pack(NodeState{}, {.node = 1})},
      {MessageType::Force, pack(Force{}, {.node = 1})},
      {MessageType::HostHeartbeat, pack(HostHeartbeat{}, {})},
      {MessageType::Time, pack(HostTime{}, {})},
      {MessageType::Command, pack(Command{}, {.node = 1})},
      {MessageType::Acknowledge, pack(Acknowledge{}, {.node = 1})},
      {MessageType::Pneumatics, pack(Pneumatics{}, {.node = 1})},
      {MessageType::LayoutStatus, pack(LayoutStatus{}, {.node = 1})},
      {MessageType::Identity, pack(Identity{}, {.node = 1})},
      {MessageType::TransferRequest, pack_segment({{MessageType::TransferRequest, 1}, {}})},
      {MessageType::TransferResponse, pack_segment({{MessageType::TransferResponse, 1}, {}})}};
  EXPECT_EQ(said.size(), kMessages.size());
  for (const auto& [type, frame] : said) {
    std::map<MessageType, int> times;
    EXPECT_FALSE(dispatch(frame, Heard{times}).has_value());
    EXPECT_EQ(times, (std::map<MessageType, int>{{type, 1}})) << spec_of(type).name;
  }
}

TEST(Dispatch, says_what_was_wrong_and_calls_no_one) {
  std::map<MessageType, int> times;
  Frame frame = pack(NodeState{}, {.node = 1});
  frame.data[7] ^= 1U;
  EXPECT_EQ(dispatch(frame, Heard{times}), FrameError::Checksum);
  EXPECT_EQ(dispatch(Frame{.id = 0x7FF}, Heard{times}), FrameError::UnknownId);
  Frame segment = pack_segment({{MessageType::TransferRequest, 1}, {}});
  segment.length = 7;
  EXPECT_EQ(dispatch(segment, Heard{times}), FrameError::Length);
  EXPECT_TRUE(times.empty());
}

/// Reads nothing but NodeState.
struct Sparing {
  std::map<MessageType, int>& read;
  std::map<MessageType, int>& unread;
  void operator()(const Received<NodeState>&) const { ++read[MessageType::State]; }
  void operator()(const Segment&) const {}
  void operator()(const Unread& other) const { ++unread[other.identifier.type]; }
};

TEST(Dispatch, leaves_the_fields_alone_of_what_its_handler_does_not_read_but_not_the_checksum) {
  std::map<MessageType, int> read;
  std::map<MessageType, int> unread;
  const Sparing sparing{read, unread};
  EXPECT_FALSE(dispatch(pack(NodeState{}, {.node = 1}), sparing));
  EXPECT_FALSE(dispatch(pack(Force{}, {.node = 1}), sparing));
  EXPECT_FALSE(dispatch(pack(Identity{}, {.node = 1}), sparing));
  Frame frame = pack(Force{}, {.node = 1});
  frame.data[7] ^= 1U;
  EXPECT_EQ(dispatch(frame, sparing), FrameError::Checksum);
  EXPECT_EQ(read, (std::map<MessageType, int>{{MessageType::State, 1}}));
  EXPECT_EQ(unread, (std::map<MessageType, int>{{MessageType::Force, 1}, {MessageType::Identity, 1}}));
}

TEST(Segments, come_back_as_they_were_sent) {
  const Segment sent{{MessageType::TransferResponse, 9}, {1, 2, 3, 4, 5, 6, 7, 8}};
  const Frame frame = pack_segment(sent);
  EXPECT_EQ(frame.id, 0x689U);
  const auto back = parse_segment(frame);
  ASSERT_TRUE(back.has_value());
  EXPECT_EQ(back->identifier, sent.identifier);
  EXPECT_EQ(back->data, sent.data);
  EXPECT_EQ(parse_segment(Frame{.id = 0x689, .extended = true}).error(), FrameError::Extended);
}

TEST(Messages, that_say_nothing_are_empty_behind_their_header) {
  EXPECT_EQ(to_word(pack(GlobalHold{}, {.node = 1}).data) >> 16, 0U);
  EXPECT_EQ(to_word(pack(FaultReport{}, {.node = 1}).data) >> 16, 0U);
  EXPECT_EQ(to_word(pack(HostHeartbeat{}, {}).data) >> 16, 0U);
  EXPECT_EQ(to_word(pack(HostTime{}, {}).data) >> 16, 0U);
  EXPECT_EQ(to_word(pack(Command{}, {.node = 1}).data) >> 8, 0U);
  EXPECT_EQ(to_word(pack(Acknowledge{}, {.node = 1}).data) >> 8, 0U);
  EXPECT_EQ(to_word(pack(LayoutStatus{}, {.node = 1}).data) >> 16, 0U);
  EXPECT_EQ(to_word(pack(Custody{}, {.node = 1}).data) >> 16, 0xFF000000000FU) << "unknown: fact and force";
  EXPECT_EQ(to_word(pack(NodeState{}, {.node = 1}).data) >> 16, 0x00FFFFFFE000U);
  EXPECT_EQ(to_word(pack(Force{}, {.node = 1}).data) >> 16, 0xFFFFFFFFFFFFU);
  EXPECT_EQ(to_word(pack(Pneumatics{}, {.node = 1}).data) >> 16, 0xFC0FFFFFFFFFU);
  EXPECT_EQ(Identity{}.page, IdentityPage::Product);
  for (std::uint8_t page = 0; page < 16; ++page) {  // from 5 on there is none, and nothing to say of it
    const Frame frame = pack(Identity{.page = static_cast<IdentityPage>(page)}, {.node = 1});
    EXPECT_EQ(to_word(frame.data) >> 16, page);
  }
}

TEST(Messages, permit_each_node_by_its_own_bit) {
  for (std::uint8_t node = 1; node <= 14; ++node) {
    const HostHeartbeat heartbeat{.permit = static_cast<std::uint16_t>(1U << (node - 1))};
    for (std::uint8_t other = 0; other < 20; ++other) {
      EXPECT_EQ(heartbeat.permits(other), other == node) << int{node} << ' ' << int{other};
    }
  }
  const HostHeartbeat all{.permit = 0xFFFF};
  EXPECT_FALSE(all.permits(0));
  EXPECT_TRUE(all.permits(1));
  EXPECT_TRUE(all.permits(14));
  EXPECT_FALSE(all.permits(15));
}

TEST(Messages, of_custody_are_past_only_as_an_outcome_without_a_force) {
  for (const Fact fact :
       {Fact::Empty, Fact::Sole, Fact::Offer, Fact::Take, Fact::Released, Fact::Retain, Fact::Unknown}) {
    const bool outcome = fact == Fact::Released || fact == Fact::Retain;
    EXPECT_EQ((Custody{.fact = fact}.past()), outcome);
    EXPECT_FALSE((Custody{.fact = fact, .f_low_n = 0}.past()));
  }
}

TEST(Commands, say_their_operation_and_nothing_else) {
  EXPECT_EQ(hold_command(), Command{});
  EXPECT_EQ(hold_command().op, Op::Hold);
  EXPECT_EQ(arm_command(0xFFABCDEF, 9), (Command{.op = Op::Arm, .session = 9, .a = 0xDEF, .b = 0xABC}));
  EXPECT_EQ(crc24(0xFFABCDEF), 0xABCDEFU);
  EXPECT_EQ(armed_crc24({.a = 0xDEF, .b = 0xABC}), 0xABCDEFU);
  EXPECT_EQ(squeeze_command({11, 22}), (Command{.op = Op::Squeeze, .a = 11, .b = 22}));
  EXPECT_EQ(offer_command(3), (Command{.op = Op::Offer, .argument = 3}));
  EXPECT_EQ(accept_command(4), (Command{.op = Op::Accept, .argument = 4}));
  EXPECT_EQ(plain_command(Op::Abort), (Command{.op = Op::Abort}));
  EXPECT_EQ(manual_release_ask(), (Command{.op = Op::ManualRelease, .argument = 1}));
  EXPECT_EQ(manual_release_answer(5), (Command{.op = Op::ManualRelease, .argument = 2, .b = 5}));
  EXPECT_EQ(SqueezeForces{}.set_dn, 0);
  EXPECT_EQ(SqueezeForces{}.permit_dn, 0);
}

TEST(Codes, that_name_no_fault_have_index_0) {
  EXPECT_EQ(index_of(static_cast<FaultCode>(0x1234)), 0);
  EXPECT_EQ(index_of(FaultCode::None), 0);
  EXPECT_EQ(index_of(FaultCode::SupplyVoltage), 1);
  EXPECT_EQ(fault_at(1), FaultCode::SupplyVoltage);
}

TEST(Codes, are_written_out_in_state_by_index_and_in_fault_whole) {
  for (const FaultCode code : kFaultCodes) {
    const Frame state = pack(NodeState{.fault = code}, {.node = 1});
    EXPECT_EQ(state.data[7], index_of(code));
    EXPECT_EQ(parse<NodeState>(state)->message.fault, code);
    const Frame fault = pack(FaultReport{.code = code}, {.node = 1});
    EXPECT_EQ(fault.data[2] | fault.data[3] << 8, static_cast<int>(code));
    EXPECT_EQ(parse<FaultReport>(fault)->message.code, code);
  }
}

template <std::size_t N, class Enum>
void expect_named(const ValueName (&names)[N], Enum) {
  for (const ValueName& name : names) EXPECT_STREQ(to_string(static_cast<Enum>(name.value)), name.name);
  EXPECT_STREQ(to_string(static_cast<Enum>(200)), "?");
}

TEST(Codes, have_the_names_of_the_table) {
  expect_named(kStateNames, State{});
  expect_named(kOpNames, Op{});
  expect_named(kReasonNames, Reason{});
  expect_named(kResultNames, CommandResult{});
}

}  // namespace
}  // namespace pinjaw::wire
