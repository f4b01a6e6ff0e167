// Promises: TRANSFER.
// Our transfer machines against Linux's own ISO-TP (net/can/isotp.c), each sending to the other over a vcan0.
// The kernel of User-Mode Linux has none, so that this runs on Debian's.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <linux/can/isotp.h>
#include <net/if.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <numeric>

#include "protocol/wire/transfer.hpp"
#include "tests/protocol/socketcan/vcan.hpp"
#include "tests/support/figures.hpp"

namespace pinjaw::socketcan {
namespace {

using Bytes = std::vector<std::uint8_t>;
using Clock = std::chrono::steady_clock;

constexpr std::uint32_t kOurs = 0x601;
constexpr std::uint32_t kTheirs = 0x681;
constexpr std::chrono::seconds kTransferPatience(20);
constexpr std::array<std::size_t, 14> kSizes{1, 6, 7, 8, 12, 13, 14, 62, 63, 100, 118, 119, 255, 256};

Bytes message_of(std::size_t size) {
  Bytes bytes(size);
  std::iota(bytes.begin(), bytes.end(), static_cast<std::uint8_t>(size));
  return bytes;
}

/// The kernel's end of a channel: it sends kTheirs and hears kOurs.
class Kernel {
 public:
  /// `block`, `gap_ms`: what it asks a sender for.
  Kernel(std::uint8_t block, std::uint8_t gap_ms)
      : socket_(::socket(PF_CAN, SOCK_DGRAM | SOCK_NONBLOCK, CAN_ISOTP)) {
    EXPECT_GE(socket_, 0) << "this kernel has no ISO-TP";
    can_isotp_options options{};
    options.flags =
        CAN_ISOTP_TX_PADDING | CAN_ISOTP_RX_PADDING | CAN_ISOTP_CHK_PAD_LEN | CAN_ISOTP_CHK_PAD_DATA;
    options.txpad_content = wire::kPadding;
    options.rxpad_content = wire::kPadding;
    EXPECT_EQ(::setsockopt(socket_, SOL_CAN_ISOTP, CAN_ISOTP_OPTS, &options, sizeof(options)), 0);
    can_isotp_fc_options flow{};
    flow.bs = block;
    flow.stmin = gap_ms;
    EXPECT_EQ(::setsockopt(socket_, SOL_CAN_ISOTP, CAN_ISOTP_RECV_FC, &flow, sizeof(flow)), 0);
    sockaddr_can address{};
    address.can_family = AF_CAN;
    address.can_ifindex = static_cast<int>(if_nametoindex("vcan0"));
    address.can_addr.tp.tx_id = kTheirs;
    address.can_addr.tp.rx_id = kOurs;
    EXPECT_EQ(::bind(socket_, static_cast<sockaddr*>(static_cast<void*>(&address)), sizeof(address)), 0);
  }
  ~Kernel() { ::close(socket_); }
  Kernel(const Kernel&) = delete;
  Kernel& operator=(const Kernel&) = delete;

  /// Begins to send.
  void send(const Bytes& message) const {
    EXPECT_EQ(::write(socket_, message.data(), message.size()), static_cast<ssize_t>(message.size()));
  }
  /// A whole message that came, or nothing so far.
  [[nodiscard]] std::optional<Bytes> take() const {
    Bytes bytes(4096);
    const ssize_t size = ::read(socket_, bytes.data(), bytes.size());
    if (size < 0) return std::nullopt;
    bytes.resize(static_cast<std::size_t>(size));
    return bytes;
  }
  /// The error that its last transfer ended with, or 0.
  [[nodiscard]] int error() const {
    int error = 0;
    socklen_t size = sizeof(error);
    EXPECT_EQ(::getsockopt(socket_, SOL_SOCKET, SO_ERROR, &error, &size), 0);
    return error;
  }

 private:
  int socket_;
};

/// Calls `turn` with each millisecond, and the segments that the kernel sent in it, until it says that it is
/// done.
template <class Turn>
bool comes_to_its_end(SocketBus& bus, Turn turn) {
  const auto start = Clock::now();
  for (std::int64_t turned_ms = 0; Clock::now() - start < kTransferPatience;) {
    std::vector<wire::Payload> segments;
    while (const auto received = next(bus, 0)) {
      if (received->frame.id == kTheirs) segments.push_back(received->frame.data);
    }
    const std::int64_t now_ms =
        std::chrono::duration_cast<std::chrono::milliseconds>(Clock::now() - start).count();
    if (turn(static_cast<std::uint16_t>(now_ms - turned_ms), segments)) return true;
    turned_ms = now_ms;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return false;
}

void put(SocketBus& bus, const wire::Payload& segment) {
  EXPECT_TRUE(bus.send(frame_of(kOurs, {segment.begin(), segment.end()})));
}

/// What the kernel gives its reader when we send `message`.
std::optional<Bytes> sent_to(const Kernel& kernel, SocketBus& bus, const Bytes& message) {
  wire::TransferSender sender;
  std::optional<Bytes> arrived;
  EXPECT_TRUE(sender.start(message));
  comes_to_its_end(bus, [&](std::uint16_t elapsed_ms, const std::vector<wire::Payload>& segments) {
    for (const wire::Payload& segment : segments) sender.accept(segment);
    if (const auto segment = sender.advance(elapsed_ms)) put(bus, *segment);
    arrived = kernel.take();
    return arrived.has_value();
  });
  EXPECT_EQ(sender.last_end(), wire::TransferEnd::Done);
  return arrived;
}

/// What we take when the kernel sends `message`.
std::optional<Bytes> heard_from(const Kernel& kernel, SocketBus& bus, const Bytes& message) {
  wire::TransferReceiver receiver;
  std::optional<Bytes> arrived;
  kernel.send(message);
  comes_to_its_end(bus, [&](std::uint16_t elapsed_ms, const std::vector<wire::Payload>& segments) {
    receiver.advance(elapsed_ms);
    for (const wire::Payload& segment : segments) {
      if (const auto flow = receiver.accept(segment)) put(bus, *flow);
      if (const auto whole = receiver.take()) arrived = Bytes(whole->begin(), whole->end());
    }
    return arrived.has_value();
  });
  EXPECT_EQ(kernel.error(), 0);
  return arrived;
}

class IsoTpOfTheKernel : public testing::Test {
 protected:
  void SetUp() override { ASSERT_NE(bus_, nullptr); }
  std::unique_ptr<SocketBus> bus_ = opened();
};

TEST_F(IsoTpOfTheKernel, takes_what_we_send_whatever_flow_it_asks_for) {
  int messages = 0;
  for (const auto& [block, gap_ms] : {std::pair{8, 5}, {0, 0}, {1, 0}, {3, 10}, {15, 1}}) {
    const Kernel kernel(static_cast<std::uint8_t>(block), static_cast<std::uint8_t>(gap_ms));
    for (const std::size_t size : kSizes) {
      const Bytes message = message_of(size);
      ASSERT_EQ(sent_to(kernel, *bus_, message), message)
          << size << " bytes, block " << block << ", gap " << gap_ms;
      ++messages;
    }
  }
  test::figure("TRANSFER", "messages that Linux's ISO-TP took from ours", messages);
}

TEST_F(IsoTpOfTheKernel, sends_what_we_take) {
  const Kernel kernel(8, 5);
  for (const std::size_t size : kSizes) {
    const Bytes message = message_of(size);
    ASSERT_EQ(heard_from(kernel, *bus_, message), message) << size;
  }
  test::figure("TRANSFER", "messages that ours took from Linux's ISO-TP", kSizes.size());
}

TEST_F(IsoTpOfTheKernel, understands_that_we_have_no_room_for_257_bytes) {
  const Kernel kernel(8, 5);
  wire::TransferReceiver receiver;
  int error = 0;
  kernel.send(message_of(257));
  EXPECT_TRUE(comes_to_its_end(*bus_, [&](std::uint16_t, const std::vector<wire::Payload>& segments) {
    for (const wire::Payload& segment : segments) {
      if (const auto flow = receiver.accept(segment)) put(*bus_, *flow);
    }
    error = kernel.error();
    return error != 0;
  }));
  EXPECT_EQ(error, EMSGSIZE);
  EXPECT_FALSE(receiver.take());
}

TEST_F(IsoTpOfTheKernel, takes_as_long_for_a_layout_as_ours) {
  const Kernel kernel(wire::kBlockSize, wire::kSegmentGap_ms);
  const Bytes layout = message_of(wire::kMaxTransferBytes);
  const auto start = Clock::now();
  ASSERT_EQ(sent_to(kernel, *bus_, layout), layout);
  const auto between = Clock::now();
  ASSERT_EQ(heard_from(kernel, *bus_, layout), layout);
  const std::chrono::duration<double> ours_s = between - start;
  const std::chrono::duration<double> theirs_s = Clock::now() - between;
  test::figure("TIME-TRANSFER", "256 bytes by us, of what Linux's ISO-TP takes beside", ours_s / theirs_s,
               "times");
}

}  // namespace
}  // namespace pinjaw::socketcan
