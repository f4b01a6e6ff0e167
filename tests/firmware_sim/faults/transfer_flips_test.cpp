/// Promises: E2E-LAYOUT.
///
/// A layout on its way to a controller, segment by segment with its COMMIT, with one, two or three of all its
/// bits flipped, through the controller's own service. The sender here is worse than a host: it goes on
/// whatever it is answered. Exhaustive: all pairs of bits here, all triples in the nightly run.
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "firmware_sim/core/layout_service.hpp"
#include "tests/firmware_sim/core/bench.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/nightly.hpp"

namespace pinjaw::core::test {
namespace {

using Message = std::vector<std::uint8_t>;
constexpr std::size_t kSegmentBits = 64;

/// The segments of `message` as its sender makes them for a receiver that takes everything.
void add_segments(std::vector<wire::Payload>& segments, const Message& message) {
  wire::TransferSender sender;
  ASSERT_TRUE(sender.start(message));
  for (int ms = 0; sender.busy() && ms < 1000; ++ms) {
    if (const auto segment = sender.advance(1)) {
      segments.push_back(*segment);
      if (wire::kind_of(*segment) == wire::SegmentKind::First) sender.accept({0x30, 0, 0});
    }
  }
}

Message service(wire::Service which, std::span<const std::uint8_t> body) {
  Message message(2 + body.size(), 9);
  message[0] = static_cast<std::uint8_t>(which);
  std::copy(body.begin(), body.end(), message.begin() + 2);
  return message;
}

/// WRITE of a layout and its COMMIT, as segments.
struct Transfer {
  explicit Transfer(const wire::Layout& layout) : encoded(wire::encode(layout)) {
    add_segments(segments, service(wire::Service::Write, encoded.span()));
    write_segments = segments.size();
    const std::uint32_t crc = wire::layout_crc_of(layout);
    std::array<std::uint8_t, 4> bytes{};
    wire::ByteWriter(bytes).put(crc, 4);
    add_segments(segments, service(wire::Service::Commit, bytes));
  }

  [[nodiscard]] std::size_t bits() const { return segments.size() * kSegmentBits; }

  /// A bit that carries nothing of the layout: the transaction's number, or padding.
  [[nodiscard]] bool means_nothing(std::size_t bit) const {
    const std::size_t segment = bit / kSegmentBits;
    const std::size_t byte = bit % kSegmentBits / 8;
    if (segment >= write_segments) return byte == 2 || byte > 6;  // COMMIT: length, service, number, 4 of CRC
    if (segment == 0) return byte == 3;
    const std::size_t place = 6 + 7 * (segment - 1) + byte - 1;  // in the message; byte 0 numbers the segment
    return byte > 0 && place >= encoded.size + 2;
  }

  wire::EncodedLayout encoded;
  std::vector<wire::Payload> segments;
  std::size_t write_segments = 0;
};

/// A controller without a layout, waiting for one.
State waiting_controller(std::uint8_t node) {
  Station station(node);
  for (int ms = 0; ms < 50; ++ms) station.step({});
  EXPECT_EQ(station.id(), StateId::Unconfigured);
  return station.core;
}

void hear(State& state, const wire::Payload& data) {
  SendQueue queue;
  take_segment(state, {{wire::MessageType::TransferRequest, state.config.node}, data}, queue);
}

wire::Payload flipped(wire::Payload data, std::size_t bit) {
  data[bit / 8] = static_cast<std::uint8_t>(data[bit / 8] ^ (1U << bit % 8));
  return data;
}

/// Sends a transfer with flips: those before a segment are behind the controllers handed on.
class Flips {
 public:
  Flips(const Transfer& transfer, const State& start) : transfer_(transfer), before_{start} {
    for (const wire::Payload& segment : transfer.segments) {
      before_.push_back(before_.back());
      hear(before_.back(), segment);
    }
  }

  /// Every pattern of `count` bits; says how many patterns there were, and fails where one commits a layout.
  std::int64_t run(int count) {
    std::vector<std::size_t> bits;
    choose(bits, count, 0);
    return patterns_;
  }

  /// One pattern, its bits ascending.
  void judge(const std::vector<std::size_t>& bits) {
    const std::size_t first = bits.front() / kSegmentBits;
    State state = before_[first];
    std::size_t next = 0;
    bool harmless = true;
    for (std::size_t i = first; i < transfer_.segments.size(); ++i) {
      wire::Payload segment = transfer_.segments[i];
      for (; next < bits.size() && bits[next] / kSegmentBits == i; ++next) {
        segment = flipped(segment, bits[next] % kSegmentBits);
        harmless = harmless && transfer_.means_nothing(bits[next]);
      }
      hear(state, segment);
    }
    ++patterns_;
    if (state.layouts.committed != harmless) {
      ADD_FAILURE() << (harmless ? "not committed" : "committed") << " with bits "
                    << ::testing::PrintToString(bits);
    }
    if (!state.layouts.committed) return;
    EXPECT_EQ(state.layouts.layout, undisturbed().layouts.layout);
  }

  [[nodiscard]] const State& undisturbed() const { return before_.back(); }

 private:
  void choose(std::vector<std::size_t>& bits, int count, std::size_t from) {
    if (count == 0) return judge(bits);
    for (std::size_t bit = from; bit < transfer_.bits(); ++bit) {
      bits.push_back(bit);
      choose(bits, count - 1, bit + 1);
      bits.pop_back();
    }
  }

  const Transfer& transfer_;
  std::vector<State> before_;  ///< the controller before each segment, nothing flipped until then
  std::int64_t patterns_ = 0;
};

/// Two pins, no peer: the smallest.
wire::Layout small_layout() {
  wire::Layout layout = layout_for(kArm);
  layout.pins[1] = layout.pins[3];
  layout.pin_count = 2;
  layout.peer_count = 0;
  return layout;
}

TEST(TransferFlips, undisturbed_it_is_committed) {
  for (const std::uint8_t node : {kArm, kPallet}) {
    const Transfer transfer(layout_for(node));
    const Flips flips(transfer, waiting_controller(node));
    EXPECT_TRUE(flips.undisturbed().layouts.committed);
    EXPECT_EQ(flips.undisturbed().layouts.crc, wire::layout_crc_of(layout_for(node)));
  }
}

TEST(TransferFlips, of_one_or_two_bits_commit_no_layout) {
  std::int64_t patterns = 0;
  for (const std::uint8_t node : {kArm, kPallet}) {
    const Transfer transfer(layout_for(node));
    Flips flips(transfer, waiting_controller(node));
    flips.run(1);
    patterns += flips.run(2);
    if (!pinjaw::test::nightly()) break;
  }
  pinjaw::test::figure("E2E-LAYOUT", "flips of 1 or 2 bits of a layout transfer, none committed", patterns,
                       "transfers");
}

TEST(TransferFlips, of_three_bits_commit_no_layout) {
  if (pinjaw::test::nightly()) {
    const Transfer transfer(layout_for(kArm));
    Flips flips(transfer, waiting_controller(kArm));
    pinjaw::test::figure("E2E-LAYOUT", "flips of 3 bits of a layout transfer, none committed", flips.run(3),
                         "transfers");
    return;
  }
  // By day: a random sample of triples of the smallest layout's bits.
  const Transfer transfer(small_layout());
  Flips flips(transfer, waiting_controller(kArm));
  std::uint32_t random = 7;
  const auto below = [&random](std::size_t limit) {
    random = random * 1664525U + 1013904223U;
    return std::size_t{random >> 8} % limit;
  };
  for (int i = 0; i < 200'000; ++i) {
    std::vector<std::size_t> bits{below(transfer.bits()), below(transfer.bits()), below(transfer.bits())};
    std::sort(bits.begin(), bits.end());
    if (bits[0] == bits[1] || bits[1] == bits[2]) continue;
    flips.judge(bits);
  }
}

}  // namespace
}  // namespace pinjaw::core::test
