#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "protocol/bus/bus.hpp"
#include "protocol/socketcan/socket_bus.hpp"

namespace pinjaw::socketcan {

/// A bus that outlives its interface: where it fails, it is opened again, every 100 ms until that works.
/// Meanwhile every call gives the reason, and frames to send are lost and counted. For a controller, which
/// holds on whatever happens to its bus.
class LastingBus final : public bus::Bus {
 public:
  static constexpr std::int64_t kRetry_us = 100'000;  ///< chosen: two heartbeats of a host
  using Opener = std::function<bus::Expected<std::unique_ptr<bus::Bus>>()>;

  /// Opens `interface`. It must be there at first: a wrong name is a mistake, not an outage.
  static bus::Expected<std::unique_ptr<LastingBus>> open(const std::string& interface,
                                                         const Settings& settings);
  LastingBus(std::unique_ptr<bus::Bus> opened, Opener opener, Clock now_us);

  bus::Expected<void> send(const wire::Frame& frame) override;
  bus::Expected<std::optional<bus::Received>> receive() override;
  /// Of all interfaces it had.
  [[nodiscard]] bus::Statistics statistics() const override;
  /// Off while there is no interface.
  [[nodiscard]] bus::Health health() const override;
  void restart() override;

 private:
  /// The bus that is open now, perhaps just opened; null where there is none.
  bus::Bus* present();
  void lose(const bus::Failure& why);

  std::unique_ptr<bus::Bus> open_;
  Opener opener_;
  Clock now_us_;
  bus::Failure why_;
  std::int64_t next_try_us_ = 0;
  bus::Statistics past_;  ///< of the buses before, and what was lost between them
};

}  // namespace pinjaw::socketcan
