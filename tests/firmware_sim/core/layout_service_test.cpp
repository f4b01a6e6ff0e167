// Promises: TRANSFER, I8.
#include <gtest/gtest.h>

#include <deque>

#include "protocol/wire/identification.hpp"
#include "protocol/wire/transfer.hpp"
#include "tests/firmware_sim/core/bench.hpp"

namespace pinjaw::core::test {
namespace {

using wire::TransferStatus;

using Bytes = std::vector<std::uint8_t>;

/// A host's end of the layout transfer.
struct LayoutService : testing::Test {
  LayoutService() { bench.run(300); }

  /// Sends a request and gives the answer's bytes; empty where none came.
  Bytes ask(const Bytes& request) {
    wire::TransferSender sender;
    wire::TransferReceiver receiver;
    sender.start(request);
    for (int ms = 0; ms < 2000; ++ms) {
      if (const auto segment = sender.advance(1)) inject(*segment);
      bench.run(1);
      receiver.advance(1);
      for (const wire::Frame& frame : bench.heard) {
        const auto segment = wire::parse_segment(frame);
        if (!segment || segment->identifier.node != kArm) continue;
        if (wire::kind_of(segment->data) == wire::SegmentKind::FlowControl) {
          sender.accept(segment->data);
        } else if (const auto flow = receiver.accept(segment->data)) {
          inject(*flow);
        }
      }
      if (const auto answer = receiver.take()) return {answer->begin(), answer->end()};
    }
    return {};
  }
  void inject(const wire::Payload& data) {
    bench.inject(wire::pack_segment({{wire::MessageType::TransferRequest, kArm}, data}));
  }
  TransferStatus write(const wire::Layout& layout) {
    const wire::EncodedLayout encoded = wire::encode(layout);
    Bytes request{0x21, 1};
    request.insert(request.end(), encoded.bytes.begin(),
                   encoded.bytes.begin() + static_cast<long>(encoded.size));
    return status(ask(request));
  }
  TransferStatus commit(std::uint32_t crc) {
    return status(ask({0x22, 2, static_cast<std::uint8_t>(crc), static_cast<std::uint8_t>(crc >> 8),
                       static_cast<std::uint8_t>(crc >> 16), static_cast<std::uint8_t>(crc >> 24)}));
  }
  static TransferStatus status(const Bytes& answer) {
    return answer.size() < 3 ? TransferStatus::UnknownService : static_cast<TransferStatus>(answer[2]);
  }
  Bench bench;
};

TEST_F(LayoutService, takes_a_layout_and_is_loaded) {
  ASSERT_EQ(bench.arm().id(), StateId::Unconfigured);
  const wire::Layout layout = layout_for(kArm);
  ASSERT_EQ(write(layout), TransferStatus::Ok);
  EXPECT_EQ(bench.arm().id(), StateId::Unconfigured);
  ASSERT_EQ(commit(wire::layout_crc_of(layout)), TransferStatus::Ok);
  EXPECT_EQ(bench.arm().id(), StateId::Loaded);
  EXPECT_EQ(bench.arm().core.layouts.layout, layout);
  bench.arm().power_on_again();
  bench.run(5);
  EXPECT_EQ(bench.arm().id(), StateId::Loaded) << "it was stored";
}

TEST_F(LayoutService, gives_back_what_was_committed) {
  const wire::Layout layout = layout_for(kArm);
  EXPECT_EQ(status(ask({0x23, 9})), TransferStatus::NothingStaged);
  write(layout);
  commit(wire::layout_crc_of(layout));
  const Bytes answer = ask({0x23, 9});
  const wire::EncodedLayout encoded = wire::encode(layout);
  ASSERT_EQ(answer.size(), encoded.size + 3);
  EXPECT_TRUE(std::equal(answer.begin() + 3, answer.end(), encoded.bytes.begin()));
}

TEST_F(LayoutService, tells_what_it_is) {
  const Bytes answer = ask({0x24, 1});
  const auto told = wire::Identification::read(std::span(answer).subspan(3));
  ASSERT_TRUE(told.has_value());
  EXPECT_EQ(told->node, kArm);
  EXPECT_EQ(told->f_hardware_dn, 1400);
  EXPECT_EQ(told->f_uncertainty_dn, 120);
}

TEST_F(LayoutService, refuses_at_commit_what_leaves_no_force_that_is_surely_right) {
  wire::Layout layout = layout_for(kArm, 1161);
  layout.peer_count = 0;
  ASSERT_EQ(write(layout), TransferStatus::Ok);
  EXPECT_EQ(commit(wire::layout_crc_of(layout)), TransferStatus::ForceWindow);
  EXPECT_EQ(bench.arm().id(), StateId::Unconfigured);
  layout.f_required_dn = 1160;
  ASSERT_EQ(write(layout), TransferStatus::Ok);
  EXPECT_EQ(commit(wire::layout_crc_of(layout)), TransferStatus::Ok);
}

TEST_F(LayoutService, refuses_at_commit_a_limit_over_the_hardwares) {
  wire::Layout layout = layout_for(kArm);
  layout.peer_count = 0;
  layout.f_limit_dn = 1401;
  ASSERT_EQ(write(layout), TransferStatus::Ok);
  EXPECT_EQ(commit(wire::layout_crc_of(layout)), TransferStatus::ForceOverHardware);
}

TEST_F(LayoutService, refuses_what_was_made_for_another_kit_or_kind) {
  wire::Layout layout = layout_for(kArm);
  layout.peer_count = 0;
  layout.kit_id = 1;
  write(layout);
  EXPECT_EQ(commit(wire::layout_crc_of(layout)), TransferStatus::Kit);
  wire::Layout pallet = layout_for(kPallet);
  pallet.peer_count = 0;
  write(pallet);
  EXPECT_EQ(commit(wire::layout_crc_of(pallet)), TransferStatus::NodeClass);
}

TEST_F(LayoutService, refuses_a_commit_of_another_checksum_and_of_nothing) {
  EXPECT_EQ(commit(1), TransferStatus::NothingStaged);
  write(layout_for(kArm));
  EXPECT_EQ(commit(1), TransferStatus::CommitDiffers);
}

TEST_F(LayoutService, answers_a_repeated_commit_alike) {
  const wire::Layout layout = layout_for(kArm);
  write(layout);
  EXPECT_EQ(commit(wire::layout_crc_of(layout)), TransferStatus::Ok);
  EXPECT_EQ(commit(wire::layout_crc_of(layout)), TransferStatus::Ok);
}

TEST_F(LayoutService, refuses_to_write_while_a_part_is_held) {
  bench.load_all();
  bench.load_gripper(kArm);
  EXPECT_EQ(write(layout_for(kArm)), TransferStatus::WrongState);
  EXPECT_EQ(bench.arm().id(), StateId::Hold);
}

TEST_F(LayoutService, ends_the_session_with_any_write) {
  bench.load_all();
  bench.arm_session(kArm);
  ASSERT_EQ(bench.arm().id(), StateId::Ready);
  write(layout_for(kArm));
  EXPECT_EQ(bench.arm().id(), StateId::Loaded);
  EXPECT_FALSE(bench.arm().core.gate.armed());
}

TEST_F(LayoutService, says_when_the_layout_could_not_be_stored) {
  const wire::Layout layout = layout_for(kArm);
  write(layout);
  bench.arm().memory_fails = true;
  EXPECT_EQ(commit(wire::layout_crc_of(layout)), TransferStatus::Memory);
}

TEST_F(LayoutService, refuses_a_service_that_is_none) {
  EXPECT_EQ(status(ask({0x3F, 1})), TransferStatus::UnknownService);
}

TEST_F(LayoutService, counts_for_the_log) {
  wire::Frame broken = wire::pack(wire::GlobalHold{}, {.node = 0, .counter = 0});
  broken.data[0] ^= 1U;
  bench.inject(broken);
  bench.run(1);
  const Bytes answer = ask({0x25, 1});
  ASSERT_EQ(answer.size(), 23U);
  EXPECT_EQ(answer[3], 1);
}

}  // namespace
}  // namespace pinjaw::core::test
