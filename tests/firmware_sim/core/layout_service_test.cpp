// Promises: TRANSFER, I8.
#include <gtest/gtest.h>

#include <utility>
#include <vector>

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
    sender.start(request);
    return answer_within(2000);
  }
  Bytes answer_within(int most_ms) {
    for (int ms = 0; ms < most_ms; ++ms) {
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
  static Bytes write_request(const wire::Layout& layout, std::uint8_t transaction = 1) {
    const wire::EncodedLayout encoded = wire::encode(layout);
    Bytes request{0x21, transaction};
    request.insert(request.end(), encoded.span().begin(), encoded.span().end());
    return request;
  }
  /// `head`, then the four bytes of `crc`.
  static Bytes with_crc(Bytes head, std::uint32_t crc) {
    for (unsigned i = 0; i < 4; ++i) head.push_back(static_cast<std::uint8_t>(crc >> 8 * i));
    return head;
  }
  TransferStatus write(const wire::Layout& layout) { return status(ask(write_request(layout))); }
  TransferStatus commit(std::uint32_t crc) { return status(ask(with_crc({0x22, 2}, crc))); }
  static TransferStatus status(const Bytes& answer) {
    return answer.size() < 3 ? TransferStatus::UnknownService : static_cast<TransferStatus>(answer[2]);
  }
  Bench bench;
  wire::TransferSender sender;
  wire::TransferReceiver receiver;
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

TEST_F(LayoutService, commits_nothing_while_armed) {
  bench.load_all();
  const wire::Layout other = layout_for(kArm, 500);
  bench.arm_session(kArm);
  ASSERT_EQ(write(other), TransferStatus::Ok);
  bench.arm_session(kArm);
  ASSERT_EQ(bench.arm().id(), StateId::Ready);
  EXPECT_EQ(ask(with_crc({0x22, 0xB3}, wire::layout_crc_of(other))), (Bytes{0x62, 0xB3, 3}));
  EXPECT_EQ(bench.arm().id(), StateId::Ready);
  EXPECT_EQ(bench.arm().core.layouts.layout, layout_for(kArm));
}

TEST_F(LayoutService, says_when_the_layout_could_not_be_stored) {
  const wire::Layout layout = layout_for(kArm);
  write(layout);
  bench.arm().memory_fails = true;
  EXPECT_EQ(ask(with_crc({0x22, 0xB4}, wire::layout_crc_of(layout))), (Bytes{0x62, 0xB4, 24}));
}

TEST_F(LayoutService, refuses_a_service_that_is_none) {
  EXPECT_EQ(status(ask({0x3F, 1})), TransferStatus::UnknownService);
}

TEST_F(LayoutService, answers_with_the_service_the_transaction_and_what_was_asked_for) {
  const wire::Layout layout = layout_for(kArm);
  const std::uint32_t crc = wire::layout_crc_of(layout);
  EXPECT_EQ(ask({0x3F, 0xA1, 1, 2}), (Bytes{0x7F, 0xA1, 1}));
  EXPECT_EQ(ask({0x23, 0xA2}), (Bytes{0x63, 0xA2, 22}));
  EXPECT_EQ(ask(with_crc({0x22, 0xA3}, 0)), (Bytes{0x62, 0xA3, 22})) << "no layout has no checksum";
  EXPECT_EQ(ask({0x21, 0xA4, 'P', 'J', 'L'}), (Bytes{0x61, 0xA4, 2}));
  EXPECT_EQ(ask(write_request(layout, 0xA5)), with_crc({0x61, 0xA5, 0}, crc));
  EXPECT_EQ(ask(with_crc({0x22, 0xA6}, ~crc)), (Bytes{0x62, 0xA6, 23}));
  EXPECT_EQ(ask(with_crc({0x22, 0xA7}, crc)), with_crc({0x62, 0xA7, 0}, crc));
  EXPECT_EQ(ask(with_crc({0x22, 0xA8}, crc)), with_crc({0x62, 0xA8, 0}, crc));
  EXPECT_EQ(ask(with_crc({0x22, 0xA9}, ~crc)), (Bytes{0x62, 0xA9, 22})) << "nothing waits for it any more";
  const Bytes log = ask({0x25, 0xAA});
  EXPECT_EQ(Bytes(log.begin(), log.begin() + 3), (Bytes{0x65, 0xAA, 0}));
  const Bytes identity = ask({0x24, 0xAB});
  EXPECT_EQ(Bytes(identity.begin(), identity.begin() + 3), (Bytes{0x64, 0xAB, 0}));
  const Bytes readback = ask({0x23, 0xAC});
  EXPECT_EQ(Bytes(readback.begin(), readback.begin() + 3), (Bytes{0x63, 0xAC, 0}));
  EXPECT_EQ(ask({0x21}), Bytes{}) << "a request has a service and a transaction";
}

TEST_F(LayoutService, wants_a_checksum_of_four_bytes) {
  const wire::Layout layout = layout_for(kArm);
  const std::uint32_t crc = wire::layout_crc_of(layout);
  write(layout);
  Bytes request = with_crc({0x22, 2}, crc);
  request.pop_back();
  EXPECT_EQ(status(ask(request)), TransferStatus::Length);
  EXPECT_EQ(status(ask({0x22, 2})), TransferStatus::Length);
  request = with_crc({0x22, 2}, crc);
  request.push_back(0);
  EXPECT_EQ(status(ask(request)), TransferStatus::Length);
  EXPECT_EQ(commit(crc), TransferStatus::Ok);
}

TEST_F(LayoutService, answers_a_commit_only_once_the_layout_is_stored) {
  const wire::Layout layout = layout_for(kArm);
  const std::uint32_t crc = wire::layout_crc_of(layout);
  write(layout);
  const NvmStatus before = bench.arm().stored;
  NvmStatus stored = before;
  bench.after_step = [&] { stored = std::exchange(bench.arm().stored, before); };
  EXPECT_EQ(ask(with_crc({0x22, 0xB1}, crc)), Bytes{});
  bench.after_step = nullptr;
  bench.arm().stored = {.done = static_cast<std::uint16_t>(before.done + 1), .failed = false};
  EXPECT_EQ(answer_within(5), with_crc({0x62, 0xB1, 0}, crc));
}

TEST_F(LayoutService, says_why_a_layout_is_refused_and_that_it_was) {
  wire::Layout layout = layout_for(kArm);
  layout.kit_id = 1;
  write(layout);
  bool told = false;
  bench.after_step = [&] {
    for (const wire::Frame& frame : bench.heard) {
      const auto fault = wire::parse<wire::FaultReport>(frame);
      told = told || (fault && fault->message.code == wire::FaultCode::LayoutRefused);
    }
  };
  EXPECT_EQ(ask(with_crc({0x22, 0xB2}, wire::layout_crc_of(layout))), (Bytes{0x62, 0xB2, 7}));
  bench.run(5);
  EXPECT_TRUE(told);
}

TEST_F(LayoutService, begins_its_pages_of_identity_anew_when_it_is_asked_what_it_is) {
  std::vector<wire::IdentityPage> pages;
  std::vector<int> at_ms;
  const auto listen = [&] {
    for (const wire::Frame& frame : bench.heard) {
      const auto page = wire::parse<wire::Identity>(frame);
      if (!page || page->label.node != kArm) continue;
      pages.push_back(page->message.page);
      at_ms.push_back(bench.now_ms);
    }
  };
  bench.after_step = listen;
  ASSERT_TRUE(bench.run_until(2000, [&] { return pages.size() == 2; })) << "one a second, in turns";
  pages.clear();
  at_ms.clear();
  ask({0x24, 1});
  bench.run(1000);
  using enum wire::IdentityPage;
  const std::vector<wire::IdentityPage> all{Product, Firmware, Image, Serial, Boot};
  ASSERT_GE(pages.size(), all.size());
  pages.resize(all.size());
  EXPECT_EQ(pages, all);
  for (std::size_t i = 1; i < all.size(); ++i) EXPECT_EQ(at_ms[i] - at_ms[i - 1], 20);
}

TEST_F(LayoutService, forgets_a_request_whose_rest_does_not_come_within_200_ms) {
  const Bytes request = write_request(layout_for(kArm));
  for (const int silent_ms : {199, 200}) {
    inject({0x10, 8, 0x3F, 7, 0, 0, 0, 0});
    bench.run(silent_ms);
    inject({0x21, 0, 0, 0, 0, 0, 0, 0});
    EXPECT_EQ(answer_within(20).empty(), silent_ms == 200);
  }
}

TEST_F(LayoutService, takes_up_at_power_on_only_a_layout_that_it_may_use) {
  const auto taken_up = [](const Config& config, const wire::Layout& layout, std::uint16_t size = 0) {
    const wire::EncodedLayout encoded = wire::encode(layout);
    NvmImage image;
    std::copy(encoded.span().begin(), encoded.span().end(), image.layout.bytes.begin());
    image.layout.size = size != 0 ? size : static_cast<std::uint16_t>(encoded.size);
    const State state = power_on(config, image);
    EXPECT_FALSE(state.layouts.is_staged);
    EXPECT_EQ(state.layouts.crc, state.layouts.committed ? wire::layout_crc_of(layout) : 0U);
    return state.layouts.committed;
  };
  const Config arm = bench.arm().config;
  const Config pallet = bench.pallet().config;
  wire::Layout layout = layout_for(kArm);
  EXPECT_TRUE(taken_up(arm, layout));
  EXPECT_TRUE(taken_up(pallet, layout_for(kPallet)));
  EXPECT_FALSE(taken_up(pallet, layout)) << "for a gripper";
  EXPECT_FALSE(taken_up(arm, layout, 256));
  EXPECT_FALSE(taken_up(arm, layout, 257)) << "there are no more bytes";
  EXPECT_FALSE(power_on(arm, NvmImage{}).layouts.committed);
  layout.kit_id = 1;
  EXPECT_FALSE(taken_up(arm, layout)) << "for another kit";
  layout = layout_for(kArm);
  layout.peer_count = 0;
  layout.stable_ms = 0;
  EXPECT_FALSE(taken_up(arm, layout)) << "no layout at all, though its checksums are right";
}

TEST_F(LayoutService, counts_for_the_log) {
  wire::Frame broken = wire::pack(wire::GlobalHold{}, {.node = 0, .counter = 0});
  broken.data[0] ^= 1U;
  bench.inject(broken);
  bench.run(1);
  const Bytes answer = ask({0x25, 1});
  ASSERT_EQ(answer.size(), 35U);
  EXPECT_EQ(answer[3], 1);
}

}  // namespace
}  // namespace pinjaw::core::test
