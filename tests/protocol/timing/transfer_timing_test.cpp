// Promises: TIME-TRANSFER.
// How long a layout takes from host to controller and back, by the real client, controller and bus in virtual
// time. ISO-TP itself allows no faster: STmin, 5 ms, from a segment's last bit to the next one's first in a
// block, and the frames' own time.
#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "host/jaw_client/client.hpp"
#include "protocol/bus/frame_bits.hpp"
#include "protocol/wire/transfer.hpp"
#include "tests/firmware_sim/support/test_cell.hpp"
#include "tests/support/figures.hpp"

namespace pinjaw::timing {
namespace {

constexpr double kMicrosecondsPerBit = 2;  // 500 kbit/s

/// One segmented message as it crossed the bus.
struct Message {
  std::size_t length = 0;
  std::size_t segments = 0;  ///< consecutive ones
  double begin_us = 0;
  double end_us = 0;
  double frames_us = 0;       ///< of all its segments and their flow control
  double least_gap_us = 1e9;  ///< from a segment's last bit to the first bit of the next of its block

  [[nodiscard]] std::size_t all_segments() const { return (length - 6 + 6) / 7; }
  [[nodiscard]] bool complete() const { return segments == all_segments(); }
  /// Gaps only within a block; the first segment of a block follows its flow control at once.
  [[nodiscard]] double bound_us() const {
    const std::size_t blocks = (all_segments() + wire::kBlockSize - 1) / wire::kBlockSize;
    const auto gaps = static_cast<double>(all_segments() - blocks);
    return gaps * wire::kSegmentGap_ms * 1000 + frames_us;
  }
  [[nodiscard]] double taken_us() const { return end_us - begin_us; }
};

/// Watches the two ids of a node's transfers.
class Watch {
 public:
  void take(const bus::Received& received) {
    const wire::Frame& frame = received.frame;
    const bool request = frame.id == wire::id_of({wire::MessageType::TransferRequest, 1});
    if (!request && frame.id != wire::id_of({wire::MessageType::TransferResponse, 1})) return;
    const double frame_us = bus::bits_on_bus(frame) * kMicrosecondsPerBit;
    const double end_us = static_cast<double>(received.time_us);
    std::optional<Message>& own = request ? to_node_ : to_host_;
    std::optional<Message>& other = request ? to_host_ : to_node_;
    switch (wire::kind_of(frame.data)) {
      case wire::SegmentKind::First:
        own = Message{.length = (frame.data[0] & 0xFU) * 256U + frame.data[1],
                      .begin_us = end_us - frame_us,
                      .end_us = end_us,
                      .frames_us = frame_us};
        return;
      case wire::SegmentKind::Consecutive:
        if (!own) return;
        if (own->segments++ % wire::kBlockSize != 0)
          own->least_gap_us = std::min(own->least_gap_us, end_us - frame_us - own->end_us);
        own->end_us = end_us;
        own->frames_us += frame_us;
        if (own->complete()) messages.push_back(*std::exchange(own, std::nullopt));
        return;
      case wire::SegmentKind::FlowControl:
        if (other) other->frames_us += frame_us;
        return;
      default:
        return;
    }
  }
  std::vector<Message> messages;

 private:
  std::optional<Message> to_node_;
  std::optional<Message> to_host_;
};

/// A cell of one controller whose layout has so many pins and peers, and a client that sends it.
std::vector<Message> send_layout(std::size_t pins, std::size_t peers) {
  const test::TestGrip grip{.node = 1, .separation_mm = 30, .needed_n = 60};
  test::TestCell cell({grip});
  cell.kill_host_at(-1);  // its own host says nothing: the client is the host
  Watch watch;
  cell.bus().on_frame([&watch](const bus::Received& received) { watch.take(received); });
  const auto end = cell.bus().open();
  jaw_client::Client client(*end, {.epoch = 9, .speaks = true});
  wire::Layout layout = cell.layout_of(grip);
  layout.pin_count = static_cast<std::uint8_t>(pins);
  for (std::size_t i = 0; i < pins; ++i) {
    const auto row = static_cast<std::int8_t>(1 + i / 2);
    layout.pins[i] = {i % 2 == 0 ? wire::Jaw::Left : wire::Jaw::Right, 0, row, 1600};
  }
  layout.peer_count = static_cast<std::uint8_t>(peers);
  for (std::size_t i = 0; i < peers; ++i) {
    const auto node = static_cast<std::uint8_t>(2 + i);
    const std::uint32_t crc = 0x1000U + node;
    layout.peers[i] = {
        .node = node,
        .layout_crc = crc,
        .f_required_dn = 400,
        .pair_crc = wire::pair_crc_of(layout.part_id, {1, wire::layout_crc_of(layout)}, {node, crc})};
  }
  for (int ms = 0; ms < 400; ++ms) {  // until the controller has booted and believes its host
    client.step(cell.now_ms() * 1000);
    cell.advance();
  }
  client.send_layout(1, layout);
  for (int ms = 0; ms < 5000 && client.outcome(1).pending(); ++ms) {
    client.step(cell.now_ms() * 1000);
    cell.advance();
  }
  EXPECT_TRUE(client.outcome(1).done()) << client.outcome(1).sentence;
  return watch.messages;
}

TEST(TransferTime, of_any_layout_stays_within_one_and_a_half_of_what_iso_tp_allows) {
  double worst = 0;
  double longest_ms = 0;
  double least_gap_ms = 1e6;
  for (const auto& [pins, peers] : {std::pair<std::size_t, std::size_t>{2, 0}, {4, 2}, {8, 4}, {16, 4}}) {
    const std::vector<Message> messages = send_layout(pins, peers);
    ASSERT_EQ(messages.size(), 2U) << "WRITE there, READBACK here";
    for (const Message& message : messages) {
      EXPECT_GE(message.taken_us(), message.bound_us()) << "no faster than ISO-TP";
      EXPECT_GE(message.least_gap_us, wire::kSegmentGap_ms * 1000.0) << "STmin";
      least_gap_ms = std::min(least_gap_ms, message.least_gap_us * 1e-3);
      EXPECT_LE(message.taken_us(), 1.5 * message.bound_us()) << message.length << " bytes";
      worst = std::max(worst, message.taken_us() / message.bound_us());
      longest_ms = std::max(longest_ms, message.taken_us() * 1e-3);
    }
  }
  test::figure("TIME-TRANSFER", "worst time / ISO-TP's bound", worst);
  test::figure("TIME-TRANSFER", "least gap between segments of a block", least_gap_ms, "ms");
  test::figure("TIME-TRANSFER", "longest layout there or back", longest_ms, "ms");
}

}  // namespace
}  // namespace pinjaw::timing
