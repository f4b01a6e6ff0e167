#include "protocol/socketcan/socket_bus.hpp"

#include <linux/can.h>
#include <linux/can/error.h>
#include <linux/can/raw.h>
#include <linux/sock_diag.h>
#include <net/if.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstddef>
#include <cstring>
#include <utility>

namespace pinjaw::socketcan {

std::int64_t steady_us() {
  return std::chrono::duration_cast<std::chrono::microseconds>(
             std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

namespace {

constexpr std::size_t kBatch = 16;  // chosen: more than 1 ms of a full 500 kbit/s bus

template <class Value>
bool set_option(int descriptor, int level, int name, const Value& value) {
  return ::setsockopt(descriptor, level, name, &value, sizeof value) == 0;
}

bool set_filters(int descriptor, const std::vector<bus::Filter>& filters) {
  if (filters.empty()) return true;
  std::vector<can_filter> raw;
  raw.reserve(filters.size());
  for (const bus::Filter& filter : filters) {
    // The flags belong to the mask, else 0x123 would also let an extended or remote frame 0x123 pass.
    raw.push_back({filter.id & CAN_SFF_MASK, (filter.mask & CAN_SFF_MASK) | CAN_EFF_FLAG | CAN_RTR_FLAG});
  }
  return ::setsockopt(descriptor, SOL_CAN_RAW, CAN_RAW_FILTER, raw.data(),
                      static_cast<socklen_t>(raw.size() * sizeof(can_filter))) == 0;
}

/// Everything that must be so before bind(), so that no frame comes early. Gives an errno, or 0.
int configure(int descriptor, const Settings& settings) {
  if (!set_filters(descriptor, settings.filters)) return errno;
  const can_err_mask_t errors = CAN_ERR_MASK;
  const int on = 1;
  if (!set_option(descriptor, SOL_CAN_RAW, CAN_RAW_ERR_FILTER, errors)) return errno;
  if (settings.hear_self && !set_option(descriptor, SOL_CAN_RAW, CAN_RAW_RECV_OWN_MSGS, on)) return errno;
  if (!set_option(descriptor, SOL_CAN_RAW, CAN_RAW_FD_FRAMES, on)) return errno;
  if (!set_option(descriptor, SOL_SOCKET, SO_TIMESTAMP, on)) return errno;
  if (!set_option(descriptor, SOL_SOCKET, SO_RXQ_OVFL, on)) return errno;
  if (!set_option(descriptor, SOL_SOCKET, SO_RCVBUFFORCE, settings.receive_buffer_bytes) &&
      !set_option(descriptor, SOL_SOCKET, SO_RCVBUF, settings.receive_buffer_bytes)) {
    return errno;
  }
  return 0;
}

/// 0 where there is none. Not by if_nametoindex() or SIOCGIFINDEX, with which the kernel, for a privileged
/// caller, starts two processes to look for a module of that name, each time, where there is no such
/// interface.
int index_of(const std::string& interface) {
  const std::unique_ptr<struct if_nameindex, decltype(&if_freenameindex)> all(::if_nameindex(),
                                                                              if_freenameindex);
  const struct if_nameindex* one = all.get();
  while (one != nullptr && one->if_index != 0 && interface != one->if_name) ++one;
  return one == nullptr ? 0 : static_cast<int>(one->if_index);
}

/// Binds to `interface` and makes sure that it is up. Gives an errno, or 0.
int attach(int descriptor, const std::string& interface) {
  if (interface.empty() || interface.size() >= IFNAMSIZ) return ENODEV;
  sockaddr_can address{};
  address.can_family = AF_CAN;
  address.can_ifindex = index_of(interface);
  if (address.can_ifindex == 0) return ENODEV;
  if (::bind(descriptor, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) return errno;
  ifreq request{};
  std::memcpy(request.ifr_name, interface.data(), interface.size());
  if (::ioctl(descriptor, SIOCGIFFLAGS, &request) != 0) return errno;
  return (request.ifr_flags & IFF_UP) != 0 ? 0 : ENETDOWN;
}

/// A classic frame, too, fits into the kernel's frame of CAN FD: its CAN_MTU bytes are laid out alike.
static_assert(offsetof(canfd_frame, len) == offsetof(can_frame, can_dlc) &&
              offsetof(canfd_frame, data) == offsetof(can_frame, data));

std::size_t size_of(const wire::Frame& frame) {
  return frame.kind == wire::FrameKind::Fd ? CANFD_MTU : CAN_MTU;
}

canfd_frame to_raw(const wire::Frame& frame) {
  canfd_frame raw{};
  raw.can_id = frame.extended ? (frame.id & CAN_EFF_MASK) | CAN_EFF_FLAG : frame.id & CAN_SFF_MASK;
  if (frame.kind == wire::FrameKind::Remote) raw.can_id |= CAN_RTR_FLAG;
  if (frame.kind == wire::FrameKind::Error) raw.can_id = (frame.id & CAN_ERR_MASK) | CAN_ERR_FLAG;
  raw.len = std::min<std::uint8_t>(frame.length, CAN_MAX_DLEN);
  std::copy_n(frame.data.begin(), raw.len, raw.data);
  if (frame.kind == wire::FrameKind::Fd) {
    raw.len = wire::kFdLength;
    raw.flags = CANFD_BRS;
    std::copy(frame.tail.begin(), frame.tail.end(), raw.data + frame.data.size());
  }
  return raw;
}

wire::Frame from_raw(const canfd_frame& raw, bool fd) {
  wire::Frame frame;
  if ((raw.can_id & CAN_ERR_FLAG) != 0) {
    frame.kind = wire::FrameKind::Error;
    frame.id = raw.can_id & CAN_ERR_MASK;
  } else {
    frame.extended = (raw.can_id & CAN_EFF_FLAG) != 0;
    frame.kind = (raw.can_id & CAN_RTR_FLAG) != 0 ? wire::FrameKind::Remote : wire::FrameKind::Data;
    frame.id = raw.can_id & (frame.extended ? CAN_EFF_MASK : CAN_SFF_MASK);
  }
  if (fd) {
    frame.kind = wire::FrameKind::Fd;
    frame.length = raw.len;
    std::copy_n(raw.data, frame.data.size(), frame.data.begin());
    std::copy_n(raw.data + frame.data.size(), frame.tail.size(), frame.tail.begin());
    return frame;
  }
  frame.length = std::min<std::uint8_t>(raw.len, CAN_MAX_DLEN);
  if (frame.kind != wire::FrameKind::Remote) std::copy_n(raw.data, frame.length, frame.data.begin());
  return frame;
}

bus::Origin origin_of(int flags) {
  if ((flags & MSG_CONFIRM) != 0) return bus::Origin::Self;
  return (flags & MSG_DONTROUTE) != 0 ? bus::Origin::SameMachine : bus::Origin::Elsewhere;
}

/// What the kernel tells beside a frame.
struct Beside {
  std::int64_t time_us = 0;
  std::optional<std::uint32_t> overflow;  ///< frames that the socket had no room for before this one
};

Beside beside(msghdr& message) {
  Beside told;
  for (cmsghdr* entry = CMSG_FIRSTHDR(&message); entry != nullptr; entry = CMSG_NXTHDR(&message, entry)) {
    if (entry->cmsg_level != SOL_SOCKET) continue;
    if (entry->cmsg_type == SO_TIMESTAMP) {
      timeval time{};
      std::memcpy(&time, CMSG_DATA(entry), sizeof time);
      told.time_us = std::int64_t{time.tv_sec} * 1'000'000 + time.tv_usec;
    } else if (entry->cmsg_type == SO_RXQ_OVFL) {
      std::memcpy(&told.overflow.emplace(), CMSG_DATA(entry), sizeof(std::uint32_t));
    }
  }
  return told;
}

/// Frames that the socket had no room for, up to now: SO_RXQ_OVFL tells the same count, but only beside the
/// next frame.
std::uint32_t overflow_of(int descriptor) {
  std::array<std::uint32_t, SK_MEMINFO_VARS> memory{};
  socklen_t size = sizeof memory;
  return ::getsockopt(descriptor, SOL_SOCKET, SO_MEMINFO, memory.data(), &size) == 0
             ? memory[SK_MEMINFO_DROPS]
             : 0;
}

}  // namespace

bus::Expected<std::unique_ptr<SocketBus>> SocketBus::open(const std::string& interface,
                                                          const Settings& settings) {
  const int descriptor = ::socket(PF_CAN, SOCK_RAW | SOCK_CLOEXEC | SOCK_NONBLOCK, CAN_RAW);
  if (descriptor < 0) return tl::unexpected(explain(errno, interface));
  std::unique_ptr<SocketBus> opened(new SocketBus(descriptor, interface, settings));
  if (const int error = configure(descriptor, settings)) return tl::unexpected(explain(error, interface));
  if (const int error = attach(descriptor, interface)) return tl::unexpected(explain(error, interface));
  return opened;
}

SocketBus::SocketBus(int descriptor, std::string interface, const Settings& settings)
    : descriptor_(descriptor),
      interface_(std::move(interface)),
      now_us_(settings.now_us),
      watch_(settings.patient) {}

SocketBus::~SocketBus() {
  ::close(descriptor_);
}

WriteResult SocketBus::write(const wire::Frame& frame) {
  if (watch_.off()) return WriteResult::Full;  // the kernel would take it, and drop it without a word
  const canfd_frame raw = to_raw(frame);
  const std::size_t size = size_of(frame);
  if (::write(descriptor_, &raw, size) == static_cast<ssize_t>(size)) {
    ++statistics_.sent;
    return WriteResult::Taken;
  }
  write_error_ = errno;
  if (write_error_ != ENOBUFS && write_error_ != EAGAIN) return WriteResult::Failed;
  ++statistics_.stalls;
  return WriteResult::Full;
}

bus::Expected<void> SocketBus::flush(std::int64_t now_us) {
  const auto result = queue_.flush(now_us, [this](const wire::Frame& frame) { return write(frame); });
  if (result != WriteResult::Failed) return {};
  return fail(write_error_);
}

tl::unexpected<bus::Failure> SocketBus::fail(int error) {
  queue_.clear();
  failed_ = explain(error, interface_);
  return tl::unexpected(*failed_);
}

bus::Expected<void> SocketBus::send(const wire::Frame& frame) {
  if (failed_) return tl::unexpected(*failed_);
  const std::int64_t now_us = now_us_();
  if (!queue_.push(frame, now_us)) {
    ++statistics_.lost_sending;
    return tl::unexpected(explain(ENOBUFS, interface_));
  }
  return flush(now_us);
}

bus::Expected<void> SocketBus::refill() {
  std::array<canfd_frame, kBatch> raw{};
  std::array<iovec, kBatch> buffers{};
  struct alignas(cmsghdr) Control {
    std::array<char, 128> bytes;
  };
  std::array<Control, kBatch> control{};
  std::array<mmsghdr, kBatch> messages{};
  for (std::size_t i = 0; i < kBatch; ++i) {
    buffers[i] = {&raw[i], sizeof raw[i]};
    msghdr& header = messages[i].msg_hdr;
    header.msg_iov = &buffers[i];
    header.msg_iovlen = 1;
    header.msg_control = control[i].bytes.data();
    header.msg_controllen = control[i].bytes.size();
  }
  const int count = ::recvmmsg(descriptor_, messages.data(), kBatch, MSG_DONTWAIT, nullptr);
  if (count < 0 && errno != EAGAIN && errno != EINTR) return fail(errno);
  drained_ = count < static_cast<int>(kBatch);
  for (std::size_t i = 0; static_cast<int>(i) < count; ++i) {
    const bool fd = messages[i].msg_len == CANFD_MTU;
    const Beside told = beside(messages[i].msg_hdr);
    overflow_ = told.overflow.value_or(overflow_);
    if (!fd && messages[i].msg_len != CAN_MTU) continue;
    inbox_.push_back({from_raw(raw[i], fd), told.time_us, origin_of(messages[i].msg_hdr.msg_flags)});
  }
  return {};
}

bus::Expected<std::optional<bus::Received>> SocketBus::receive() {
  if (failed_) return tl::unexpected(*failed_);
  if (!queue_.empty()) {
    if (const auto flushed = flush(now_us_()); !flushed) return tl::unexpected(flushed.error());
  }
  if (inbox_.empty() && !std::exchange(drained_, false)) {
    if (const auto filled = refill(); !filled) return tl::unexpected(filled.error());
  }
  if (inbox_.empty()) {
    drained_ = false;  // said so now; the next call asks again
    return std::nullopt;
  }
  const bus::Received received = inbox_.front();
  inbox_.pop_front();
  watch_.take(received, statistics_);
  ++statistics_.received;
  return received;
}

bus::Statistics SocketBus::statistics() const {
  bus::Statistics statistics = statistics_;
  statistics.lost_receiving = overflow_of(descriptor_);
  statistics.lost_sending += queue_.dropped();
  return statistics;
}

bus::Health SocketBus::health() const {
  return {.off = watch_.off(),
          .passive = watch_.passive(),
          .overruns = overflow_ + static_cast<std::uint32_t>(statistics_.overruns)};
}

void SocketBus::wait(std::int64_t timeout_us) {
  if (!inbox_.empty()) return;
  // POLLOUT does not tell of room in the driver's queue, so what waits is tried again soon.
  if (!queue_.empty()) timeout_us = std::min<std::int64_t>(timeout_us, 1000);
  pollfd poll{.fd = descriptor_, .events = POLLIN, .revents = 0};
  const timespec timeout{.tv_sec = timeout_us / 1'000'000, .tv_nsec = timeout_us % 1'000'000 * 1000};
  ::ppoll(&poll, 1, &timeout, nullptr);
}

}  // namespace pinjaw::socketcan
