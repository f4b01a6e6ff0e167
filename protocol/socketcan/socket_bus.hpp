#pragma once

#include <deque>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "protocol/bus/bus.hpp"
#include "protocol/socketcan/controller_watch.hpp"
#include "protocol/socketcan/send_queue.hpp"

namespace pinjaw::socketcan {

/// Microseconds that never fall; only differences count.
using Clock = std::function<std::int64_t()>;
std::int64_t steady_us();

struct Settings {
  std::vector<bus::Filter> filters{};  ///< none: every frame; error frames always come
  bool hear_self = false;  ///< also receive own frames, as Origin::Self: proof that they were sent
  int receive_buffer_bytes = 4 << 20;  ///< the kernel's own holds 278 frames, 75 ms of a full 500 kbit/s bus
  bool patient = false;      ///< bus-off lasts until restart(), too, not only until the kernel restarts
  Clock now_us = steady_us;  ///< for how long frames have waited
};

/// A CAN interface of this machine (SocketCAN, raw sockets). Needs no thread: it never waits but in wait().
/// What the driver has no room for waits in a SendQueue, as does everything while the controller is bus-off;
/// an interface that went down or away fails every call from then on (LastingBus opens it again).
class SocketBus final : public bus::Bus {
 public:
  /// Opens `interface`, such as can0 or vcan0; where that fails, a sentence that tells the way out.
  static bus::Expected<std::unique_ptr<SocketBus>> open(const std::string& interface,
                                                        const Settings& settings);

  ~SocketBus() override;
  SocketBus(const SocketBus&) = delete;
  SocketBus& operator=(const SocketBus&) = delete;
  SocketBus(SocketBus&&) = delete;
  SocketBus& operator=(SocketBus&&) = delete;

  bus::Expected<void> send(const wire::Frame& frame) override;
  bus::Expected<std::optional<bus::Received>> receive() override;
  [[nodiscard]] bus::Statistics statistics() const override;
  [[nodiscard]] bus::Health health() const override;
  void restart() override { watch_.permit_restart(); }

  /// Waits until something can be received, or `timeout_us` passed.
  void wait(std::int64_t timeout_us);
  /// For poll(): readable when something can be received.
  [[nodiscard]] int descriptor() const { return descriptor_; }

 private:
  SocketBus(int descriptor, std::string interface, const Settings& settings);
  /// Asks the kernel for what has come, many frames in one call: on User-Mode Linux a call may take 0.1 ms.
  bus::Expected<void> refill();
  /// Sends what waits; `now_us` as Settings::now_us tells it.
  bus::Expected<void> flush(std::int64_t now_us);
  /// What an errno means; from now on every call gives it.
  tl::unexpected<bus::Failure> fail(int error);
  WriteResult write(const wire::Frame& frame);

  int descriptor_;
  std::string interface_;
  Clock now_us_;
  SendQueue queue_;
  int write_error_ = 0;
  std::optional<bus::Failure> failed_;
  ControllerWatch watch_;
  bus::Statistics statistics_;
  std::deque<bus::Received> inbox_;  ///< taken from the kernel, not yet given
  bool drained_ = false;             ///< the kernel had no more when the inbox was filled
  std::uint32_t overflow_ = 0;       ///< what the socket had no room for, up to the last frame in the inbox
};

/// The failure that `error`, an errno, means for a person who wanted to use `interface`.
bus::Failure explain(int error, const std::string& interface);

}  // namespace pinjaw::socketcan
