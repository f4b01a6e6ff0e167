#include <algorithm>
#include <chrono>
#include <ctime>
#include <ratio>

#include "host/app/venue.hpp"
#include "protocol/bench/unix_socket.hpp"
#include "protocol/bus/candump.hpp"
#include "protocol/bus/frame_bits.hpp"
#include "protocol/socketcan/socket_bus.hpp"

namespace pinjaw::app {

namespace {

using Clock = std::chrono::steady_clock;

constexpr double kBitsPerSecond =
    500'000;  // the contract's; an interface need not know its rate (vcan has none)

std::int64_t since_1970_us() {
  return std::chrono::duration_cast<std::chrono::microseconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

/// As std::this_thread's, which reads the clock once more before it sleeps.
void sleep_until(Clock::time_point time) {
  const auto since_start_ns =
      std::chrono::duration_cast<std::chrono::nanoseconds>(time.time_since_epoch()).count();
  const timespec until{.tv_sec = since_start_ns / std::nano::den, .tv_nsec = since_start_ns % std::nano::den};
  clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr);
}

/// A bus that writes down every frame that passes.
class RecordingBus final : public bus::Bus {
 public:
  RecordingBus(std::unique_ptr<bus::Bus> inner, std::string interface)
      : inner_(std::move(inner)), interface_(std::move(interface)) {}

  bus::Expected<void> send(const wire::Frame& frame) override {
    auto sent = inner_->send(frame);
    if (sent) record({since_1970_us(), interface_, frame});
    return sent;
  }
  bus::Expected<std::optional<bus::Received>> receive() override {
    auto received = inner_->receive();
    if (received && *received) record({(*received)->time_us, interface_, (*received)->frame});
    return received;
  }
  [[nodiscard]] bus::Statistics statistics() const override { return inner_->statistics(); }
  [[nodiscard]] const std::string& log() const { return log_; }
  /// Of all frames seen, as they take on a wire.
  [[nodiscard]] std::int64_t bits() const { return bits_; }

 private:
  void record(const bus::LogLine& line) {
    log_ += bus::to_log_line(line) + "\n";
    bits_ += bus::bits_on_bus(line.frame);
  }

  std::unique_ptr<bus::Bus> inner_;
  std::string interface_;
  std::string log_;
  std::int64_t bits_ = 0;
};

class CanVenue final : public Venue {
 public:
  CanVenue(std::unique_ptr<bus::Bus> bus, std::string interface, std::unique_ptr<bench::WorldPort> world)
      : bus_(std::move(bus), std::move(interface)), world_(std::move(world)) {}

  bus::Bus& bus() override { return bus_; }
  bench::WorldPort* world() override { return world_.get(); }
  std::int64_t tick_us() override {
    // Two calls of the kernel a tick: on User-Mode Linux each may take 0.1 ms.
    next_ = std::max(next_ + std::chrono::milliseconds(1), now_);
    sleep_until(next_);
    now_ = Clock::now();
    return std::chrono::duration_cast<std::chrono::microseconds>(now_ - started_).count();
  }
  void lose_frames(double /*share*/, double /*seconds*/) override {}
  [[nodiscard]] bool loses_frames() const override { return false; }
  [[nodiscard]] std::optional<double> load_percent() const override {
    const auto elapsed = std::chrono::duration<double>(Clock::now() - started_).count();
    return elapsed > 0 ? 100 * static_cast<double>(bus_.bits()) / (kBitsPerSecond * elapsed) : 0.0;
  }
  [[nodiscard]] const std::string& log() const override { return bus_.log(); }

 private:
  RecordingBus bus_;
  std::unique_ptr<bench::WorldPort> world_;
  Clock::time_point started_ = Clock::now();
  Clock::time_point now_ = started_;  ///< when the last tick ended
  Clock::time_point next_ = started_;
};

}  // namespace

base::Expected<std::unique_ptr<Venue>> open_can_venue(std::string_view interface,
                                                      const std::string& world_path) {
  auto bus = socketcan::SocketBus::open(std::string(interface), {});
  if (!bus) return base::failure(bus.error().message);
  std::unique_ptr<bench::WorldPort> world;
  if (!world_path.empty()) {
    auto connected = bench::SocketWorld::connect(world_path);
    if (!connected) return base::failure(connected.error().message);
    world = std::move(*connected);
  }
  return std::make_unique<CanVenue>(std::move(*bus), std::string(interface), std::move(world));
}

std::optional<std::string> can_interface(std::string_view bus) {
  constexpr std::string_view kKind = "can:";
  if (!bus.starts_with(kKind) || bus.size() == kKind.size()) return std::nullopt;
  return std::string(bus.substr(kKind.size()));
}

}  // namespace pinjaw::app
