#pragma once

#include <memory>
#include <string>
#include <vector>

#include "protocol/bus/bus.hpp"
#include "protocol/socketcan/send_queue.hpp"

namespace pinjaw::socketcan {

struct Settings {
  std::vector<bus::Filter> filters{};  ///< none: every frame; error frames always come
  bool hear_self = false;  ///< also receive own frames, as Origin::Self: proof that they were sent
};

/// A CAN interface of this machine (SocketCAN, raw sockets). Needs no thread: it never waits but in wait().
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

  /// Waits until something can be received, or `timeout_us` passed.
  void wait(std::int64_t timeout_us);
  /// For poll(): readable when something can be received.
  [[nodiscard]] int descriptor() const { return descriptor_; }

 private:
  SocketBus(int descriptor, std::string interface);
  bus::Expected<void> flush();
  WriteResult write(const wire::Frame& frame);

  int descriptor_;
  std::string interface_;
  SendQueue queue_;
  int write_error_ = 0;
  std::uint32_t overflow_ = 0;  ///< frames the socket had no room for, as the kernel counts them
  bus::Statistics statistics_;
};

/// The failure that `error`, an errno, means for a person who wanted to use `interface`.
bus::Failure explain(int error, const std::string& interface);

}  // namespace pinjaw::socketcan
