// Promises: TRANSFER.
#include <gtest/gtest.h>
#include <linux/can.h>
#include <linux/can/isotp.h>
#include <net/if.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "protocol/wire/transfer.hpp"
#include "tests/protocol/socketcan/vcan.hpp"
#include "tests/support/figures.hpp"

/// Our ISO-TP machines against the kernel's own, in both directions. A kernel without CAN_ISOTP cannot be
/// compared with, which the test says and states as its figure.
namespace pinjaw::socketcan {
namespace {

constexpr std::uint32_t kToKernel = 0x601;
constexpr std::uint32_t kFromKernel = 0x681;

/// The kernel's end of a transfer; asks for what our machines ask for.
class KernelEnd {
 public:
  KernelEnd() : socket_(::socket(PF_CAN, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, CAN_ISOTP)) {
    if (socket_ < 0) return;
    can_isotp_options options{};
    options.flags = CAN_ISOTP_TX_PADDING;
    options.txpad_content = wire::kPadding;
    can_isotp_fc_options flow{};
    flow.bs = wire::kBlockSize;
    flow.stmin = wire::kSegmentGap_ms;
    sockaddr_can address{};
    address.can_family = AF_CAN;
    address.can_ifindex = static_cast<int>(::if_nametoindex("vcan0"));
    address.can_addr.tp.tx_id = kFromKernel;
    address.can_addr.tp.rx_id = kToKernel;
    EXPECT_EQ(::setsockopt(socket_, SOL_CAN_ISOTP, CAN_ISOTP_OPTS, &options, sizeof options), 0);
    EXPECT_EQ(::setsockopt(socket_, SOL_CAN_ISOTP, CAN_ISOTP_RECV_FC, &flow, sizeof flow), 0);
    EXPECT_EQ(::bind(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0)
        << std::strerror(errno);
  }
  ~KernelEnd() {
    if (socket_ >= 0) ::close(socket_);
  }
  KernelEnd(const KernelEnd&) = delete;
  KernelEnd& operator=(const KernelEnd&) = delete;
  KernelEnd(KernelEnd&&) = delete;
  KernelEnd& operator=(KernelEnd&&) = delete;

  [[nodiscard]] bool exists() const { return socket_ >= 0; }
  [[nodiscard]] bool send(const std::vector<std::uint8_t>& message) const {
    return ::write(socket_, message.data(), message.size()) == static_cast<ssize_t>(message.size());
  }
  [[nodiscard]] std::optional<std::vector<std::uint8_t>> receive() const {
    std::vector<std::uint8_t> message(4096);
    const ssize_t size = ::read(socket_, message.data(), message.size());
    if (size <= 0) return std::nullopt;
    message.resize(static_cast<std::size_t>(size));
    return message;
  }

 private:
  int socket_;
};

std::vector<std::uint8_t> message_of(std::size_t size) {
  std::vector<std::uint8_t> message(size);
  for (std::size_t i = 0; i < size; ++i) message[i] = static_cast<std::uint8_t>(13 * i + size);
  return message;
}

/// Calls `step` every millisecond until it gives something, or patience is at its end.
template <class Step>
auto patiently(Step step) -> decltype(step()) {
  for (int ms = 0; ms < 5000; ++ms) {
    if (auto found = step()) return found;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return {};
}

template <class Take>
void each_from_kernel(bus::Bus& bus, Take take) {
  for (auto received = bus.receive(); received && *received; received = bus.receive()) {
    if ((*received)->frame.id == kFromKernel) take((*received)->frame.data);
  }
}

void send(bus::Bus& bus, const wire::Payload& segment) {
  ASSERT_TRUE(bus.send({.id = kToKernel, .data = segment}).has_value());
}

std::optional<std::vector<std::uint8_t>> sent_by_us(bus::Bus& bus, const KernelEnd& kernel,
                                                    const std::vector<std::uint8_t>& message) {
  wire::TransferSender sender;
  EXPECT_TRUE(sender.start(message));
  return patiently([&] {
    each_from_kernel(bus, [&](const wire::Payload& flow) { sender.accept(flow); });
    if (const auto segment = sender.advance(1)) send(bus, *segment);
    return kernel.receive();
  });
}

std::optional<std::vector<std::uint8_t>> sent_by_kernel(bus::Bus& bus, const KernelEnd& kernel,
                                                        const std::vector<std::uint8_t>& message) {
  wire::TransferReceiver receiver;
  EXPECT_TRUE(kernel.send(message)) << std::strerror(errno);
  return patiently([&]() -> std::optional<std::vector<std::uint8_t>> {
    each_from_kernel(bus, [&](const wire::Payload& segment) {
      if (const auto flow = receiver.accept(segment)) send(bus, *flow);
    });
    receiver.advance(1);
    const auto whole = receiver.take();
    if (!whole) return std::nullopt;
    return std::vector<std::uint8_t>(whole->begin(), whole->end());
  });
}

TEST(KernelsIsoTp, and_ours_understand_each_other_where_the_kernel_has_one) {
  const KernelEnd kernel;
  if (!kernel.exists()) {
    test::figure("TRANSFER", "compared with the kernel's ISO-TP", "no: this kernel has none");
    return;
  }
  const auto bus = opened();
  ASSERT_NE(bus, nullptr);
  int compared = 0;
  for (const std::size_t size : {1U, 6U, 7U, 8U, 13U, 62U, 63U, 94U, 255U, 256U}) {
    const auto message = message_of(size);
    EXPECT_EQ(sent_by_us(*bus, kernel, message), message) << size << " bytes to the kernel";
    EXPECT_EQ(sent_by_kernel(*bus, kernel, message), message) << size << " bytes from the kernel";
    ++compared;
  }
  test::figure("TRANSFER", "lengths exchanged with the kernel's ISO-TP in both directions", compared,
               "lengths");
}

}  // namespace
}  // namespace pinjaw::socketcan
