#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "protocol/bus/bus.hpp"
#include "protocol/bus/faults.hpp"

namespace pinjaw::bus {

/// Share of time that the bus was busy, and what crossed it.
struct Load {
  std::uint64_t frames = 0;
  std::int64_t busy_us = 0;
  std::int64_t elapsed_us = 0;
  double worst_window_percent = 0;  ///< busiest 100 ms
  [[nodiscard]] double percent() const {
    return elapsed_us > 0 ? 100.0 * static_cast<double>(busy_us) / static_cast<double>(elapsed_us) : 0.0;
  }
};

/// A CAN bus inside one process, in virtual time: the lowest id waiting goes first, a frame lasts as long as
/// its bits, stuff bits included, and nothing happens but in advance_to(). The same calls give the same
/// frames.
///
/// Each end has a CAN controller with the error counters of ISO 11898-1: a frame that nobody acknowledges or
/// that an error destroys is sent again, and whose own frames fail too often goes error passive and then off
/// the bus, until restart() and 128 times 11 recessive bits.
class SimBus {
 public:
  struct Settings {
    std::int64_t bit_rate = 500'000;  ///< bits per second
    std::uint64_t seed = 1;           ///< of the faults
  };

  SimBus();
  explicit SimBus(Settings settings);
  ~SimBus();
  SimBus(const SimBus&) = delete;
  SimBus& operator=(const SimBus&) = delete;
  SimBus(SimBus&&) = delete;
  SimBus& operator=(SimBus&&) = delete;

  /// A new end; it hears every other end's frames, never its own. The bus must outlive it. An end that is
  /// destroyed is silent: what it had queued is not sent.
  std::unique_ptr<Bus> open(std::vector<Filter> filters = {});

  /// Lets virtual time pass until `time_us`, delivering every frame that ends by then.
  void advance_to(std::int64_t time_us);
  [[nodiscard]] std::int64_t now_us() const;

  /// Called with every frame that crosses the bus, at its end, before anyone receives it.
  void on_frame(std::function<void(const Received&)> observer);
  /// Adds a disturbance of the bus.
  void add_fault(const Fault& fault);
  /// An error frame to every end, as if a controller had reported it now.
  void inject_error(const wire::Frame& error);

  [[nodiscard]] Load load() const;

 private:
  class Medium;
  class End;
  std::shared_ptr<Medium> medium_;
};

}  // namespace pinjaw::bus
