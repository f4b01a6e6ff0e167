/// Promises: E2E-CRC.
///
/// Every flip of one, two or three bits of every frame with a checksum, exhaustively: 64 + 2,016 + 41,664
/// patterns a frame.
#include <gtest/gtest.h>

#include "protocol/wire/dispatch.hpp"
#include "tests/protocol/wire/sample_messages.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/nightly.hpp"

namespace pinjaw::wire {
namespace {

constexpr int kBits = 64;
constexpr std::int64_t kPatterns = 64 + 2016 + 41664;

std::uint64_t bit(int index) {
  return std::uint64_t{1} << index;
}

/// How many messages came out of one frame with its bits flipped in every pattern.
class EveryFlip {
 public:
  explicit EveryFlip(const Frame& frame) : frame_(frame), word_(to_word(frame.data)) {}

  std::int64_t accepted() {
    for (int a = 0; a < kBits; ++a) {
      hear(bit(a));
      for (int b = 0; b < a; ++b) {
        hear(bit(a) | bit(b));
        for (int c = 0; c < b; ++c) hear(bit(a) | bit(b) | bit(c));
      }
    }
    return accepted_;
  }
  [[nodiscard]] std::int64_t heard() const { return heard_; }

 private:
  void hear(std::uint64_t flips) {
    frame_.data = to_payload(word_ ^ flips);
    ++heard_;
    if (!dispatch(frame_, [](const auto&) {})) ++accepted_;
  }

  Frame frame_;
  std::uint64_t word_;
  std::int64_t heard_ = 0;
  std::int64_t accepted_ = 0;
};

template <class Message>
std::int64_t flips_refused(int payloads) {
  std::int64_t refused = 0;
  testing::Engine engine(static_cast<std::uint64_t>(Message::kType));
  for (int i = 0; i < payloads; ++i) {
    const Message message = i == 0 ? Message{} : testing::random_message<Message>(engine);
    const Frame frame = pack(message, testing::random_label<Message>(engine));
    EXPECT_FALSE(dispatch(frame, [](const auto&) {})) << "the frame itself is good";
    EveryFlip flips(frame);
    EXPECT_EQ(flips.accepted(), 0) << spec_of(Message::kType).name << ", payload " << i;
    EXPECT_EQ(flips.heard(), kPatterns);
    refused += flips.heard();
  }
  return refused;
}

template <class... Message>
std::int64_t flips_refused_of_all(int payloads) {
  return (flips_refused<Message>(payloads) + ...);
}

TEST(BitFlips, of_up_to_three_bits_are_refused_in_every_frame_with_a_checksum) {
  const std::int64_t refused =
      flips_refused_of_all<GlobalHold, FaultReport, Custody, NodeState, Force, HostHeartbeat, HostTime,
                           Command, Acknowledge, Pneumatics, LayoutStatus, Identity>(test::by_night(200, 6));
  test::figure("E2E-CRC", "flips of 1 to 3 bits, 12 messages, refused", refused, "frames");
}

TEST(BitFlips, without_the_checksum_would_be_taken) {
  Frame frame = pack(Custody{.fact = Fact::Take, .peer = 2, .token = 7}, {.node = 1});
  frame.data[3] ^= 1;
  EXPECT_TRUE(dispatch(frame, [](const auto&) {}));
  frame.data[0] = detail::checksum(*identify(frame), frame.data);  // what the checksum alone would have told
  EXPECT_FALSE(dispatch(frame, [](const auto&) {}));
}

}  // namespace
}  // namespace pinjaw::wire
