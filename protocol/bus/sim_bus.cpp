#include "protocol/bus/sim_bus.hpp"

#include <algorithm>
#include <deque>
#include <optional>
#include <utility>

#include "protocol/bus/error_counters.hpp"
#include "protocol/bus/fault_injector.hpp"
#include "protocol/bus/frame_bits.hpp"

namespace pinjaw::bus {

namespace {

constexpr std::size_t kSendQueue = 256;
constexpr std::size_t kReceiveQueue = 16384;
constexpr std::int64_t kWindow_ns = 100'000'000;
constexpr int kErrorFrameBits = 20;      // flags of all, delimiter, pause: 17 to 23 (ISO 11898-1, 10.4.4)
constexpr int kSuspendBits = 8;          // after a frame of an error-passive sender (10.4.6.4)
constexpr int kRecoverySequences = 128;  // of 11 recessive bits (12.1.4.4)
constexpr int kSequenceBits = 11;

struct Waiting {
  wire::Frame frame;
  std::int64_t ready_ns = 0;
};

struct Delayed {
  wire::Frame frame;
  std::int64_t due_ns = 0;
  int sender = 0;
};

struct Station {
  int number = 0;
  std::vector<Filter> filters;
  std::deque<Waiting> sending;
  std::deque<Received> received;
  Statistics statistics;
  ErrorCounters errors;
  std::int64_t suspended_until_ns = 0;
  bool recovers = false;
  int sequences = 0;  ///< of recessive bits seen since restart(), in the stretches that ended
  std::int64_t recessive_since_ns = 0;  ///< the present stretch

  [[nodiscard]] bool wants(const wire::Frame& frame) const {
    if (filters.empty() || frame.kind == wire::FrameKind::Error) return true;
    return std::any_of(filters.begin(), filters.end(), [&frame](const Filter& filter) {
      const bool data = frame.kind == wire::FrameKind::Data || frame.kind == wire::FrameKind::Fd;
      return !frame.extended && data && (frame.id & filter.mask) == (filter.id & filter.mask);
    });
  }
  void take(const Received& message) {
    if (!wants(message.frame)) return;
    if (received.size() >= kReceiveQueue) {
      ++statistics.lost_receiving;
      return;
    }
    if (message.frame.kind == wire::FrameKind::Error) ++statistics.error_frames;
    ++statistics.received;
    received.push_back(message);
  }
};

/// Arbitration puts 11 bits of a standard id before the 29 of an extended one.
std::uint64_t priority(const wire::Frame& frame) {
  const bool remote = frame.kind == wire::FrameKind::Remote;
  if (!frame.extended) return std::uint64_t{frame.id & 0x7FFU} << 20 | (remote ? 1U << 19 : 0U);
  const std::uint64_t base = frame.id >> 18 & 0x7FFU;
  return base << 20 | 1U << 19 | std::uint64_t{frame.id & 0x3FFFFU} << 1 | (remote ? 1U : 0U);
}

}  // namespace

class SimBus::Medium {
 public:
  explicit Medium(Settings settings) : settings_(settings), injector_(settings.seed) {}

  std::shared_ptr<Station> join(std::vector<Filter> filters) {
    auto station = std::make_shared<Station>();
    station->number = ++joined_;
    station->filters = std::move(filters);
    stations_.push_back(station);
    return station;
  }

  void leave(const std::shared_ptr<Station>& station) { std::erase(stations_, station); }

  void advance_to(std::int64_t to_ns) {
    while (begin_transmission(to_ns) && flight_->end_ns <= to_ns) finish_transmission();
    deliver_delayed(to_ns);
    if (!flight_) count_recessive(to_ns, false);
    now_ns_ = std::max(now_ns_, to_ns);
  }

  void give_to_all(const Received& received, int sender) {
    if (observer_) observer_(received);
    for (const auto& station : stations_) {
      if (station->number != sender && !station->errors.off()) station->take(received);
    }
  }

  /// Lets a controller that is off count recessive bits from now on.
  void restart(Station& station) const {
    if (!station.errors.off() || station.recovers) return;
    station.recovers = true;
    station.sequences = 0;
    station.recessive_since_ns = flight_ ? flight_->end_ns : std::max(now_ns_, free_ns_);
  }

  [[nodiscard]] std::int64_t now_ns() const { return now_ns_; }
  [[nodiscard]] Load load() const {
    Load load = load_;
    load.busy_us = busy_ns_ / 1000;
    load.elapsed_us = now_ns_ / 1000;
    const std::int64_t worst_ns = std::max(worst_window_ns_, window_busy_ns_);
    load.worst_window_percent = 100.0 * static_cast<double>(worst_ns) / static_cast<double>(kWindow_ns);
    return load;
  }
  FaultInjector& injector() { return injector_; }
  void on_frame(std::function<void(const Received&)> observer) { observer_ = std::move(observer); }

 private:
  struct Flight {
    wire::Frame frame;
    std::int64_t end_ns = 0;
    std::shared_ptr<Station> sender;
    bool repeat = false;
    std::int64_t ready_ns = 0;  ///< since when it has waited
  };

  /// Time of `frame`, its pause included.
  [[nodiscard]] std::int64_t duration_ns(const wire::Frame& frame) const {
    return bits_ns(bits_on_bus(frame));
  }
  [[nodiscard]] std::int64_t bits_ns(std::int64_t bits) const {
    return bits * std::int64_t{1'000'000'000} / settings_.bit_rate;
  }

  /// Whether a frame is on the bus by `to_ns`; arbitration at `to_ns` itself waits, others may still join in.
  bool begin_transmission(std::int64_t to_ns) {
    if (flight_) return true;
    std::optional<std::int64_t> first_ns;
    for (const auto& station : stations_) {
      for (const Waiting& waiting : station->sending) {
        const std::int64_t ready_ns = std::max(waiting.ready_ns, station->suspended_until_ns);
        if (!first_ns || ready_ns < *first_ns) first_ns = ready_ns;
      }
    }
    if (!first_ns) return false;
    const std::int64_t start_ns = std::max(*first_ns, free_ns_);
    if (start_ns >= to_ns) return false;
    start(start_ns);
    return true;
  }

  void start(std::int64_t start_ns) {
    count_recessive(start_ns, true);
    std::shared_ptr<Station> winner;
    std::deque<Waiting>::iterator frame;
    for (const auto& station : stations_) {
      if (station->suspended_until_ns > start_ns) continue;
      for (auto it = station->sending.begin(); it != station->sending.end(); ++it) {
        if (it->ready_ns > start_ns) continue;
        if (winner && priority(it->frame) >= priority(frame->frame)) continue;
        winner = station;
        frame = it;
      }
    }
    flight_ = Flight{frame->frame, start_ns + duration_ns(frame->frame), winner, false, frame->ready_ns};
    winner->sending.erase(frame);
  }

  void finish_transmission() {
    const Flight done = *flight_;
    flight_.reset();
    free_ns_ = done.end_ns;
    const Fate fate =
        done.repeat ? Fate{.frame = done.frame} : injector_.meet(done.frame, done.end_ns / 1000);
    if (fate.destroyed || !acknowledged(*done.sender)) return fail(done, fate.destroyed);
    count_busy(done);
    deliver_delayed(done.end_ns);
    count_success(*done.sender);
    if (!done.repeat) ++done.sender->statistics.sent;
    if (fate.repeated) {
      flight_ = Flight{done.frame, done.end_ns + duration_ns(done.frame), done.sender, true, done.ready_ns};
    }
    if (fate.dropped) return;
    if (fate.delay_us > 0) {
      delayed_.push_back({fate.frame, done.end_ns + fate.delay_us * 1000, done.sender->number});
    } else {
      give_to_all({fate.frame, done.end_ns / 1000, Origin::Elsewhere}, done.sender->number);
    }
  }

  [[nodiscard]] bool acknowledged(const Station& sender) const {
    return std::any_of(stations_.begin(), stations_.end(), [&sender](const auto& station) {
      return station->number != sender.number && !station->errors.off();
    });
  }

  void count_success(Station& sender) {
    sender.errors.sent();
    if (sender.errors.passive()) sender.suspended_until_ns = free_ns_ + bits_ns(kSuspendBits);
    for (const auto& station : stations_) {
      if (station->number != sender.number && !station->errors.off()) station->errors.received();
      recessive_from(*station, free_ns_);
    }
  }

  /// The frame is destroyed, or nobody acknowledged it: an error frame follows, and its sender tries again.
  void fail(const Flight& done, bool destroyed) {
    Station& sender = *done.sender;
    const bool was_passive = sender.errors.passive();
    destroyed ? sender.errors.sending_failed() : sender.errors.unacknowledged();
    if (!destroyed) ++sender.statistics.unacknowledged;
    if (!was_passive && sender.errors.passive()) ++sender.statistics.passive;
    free_ns_ = done.end_ns + bits_ns(kErrorFrameBits);
    for (const auto& station : stations_) {
      if (station->number != sender.number && !station->errors.off()) station->errors.receiving_failed();
      recessive_from(*station, free_ns_);
    }
    if (sender.errors.off()) {
      ++sender.statistics.bus_off;
      sender.statistics.lost_sending += 1 + sender.sending.size();
      sender.sending.clear();
      return;
    }
    if (sender.errors.passive()) sender.suspended_until_ns = free_ns_ + bits_ns(kSuspendBits);
    sender.sending.push_front({done.frame, done.ready_ns});
  }

  /// The end of every frame is one sequence of 11 recessive bits; then the bus idles.
  static void recessive_from(Station& station, std::int64_t from_ns) {
    if (!station.recovers || station.recessive_since_ns > from_ns) return;
    ++station.sequences;
    station.recessive_since_ns = from_ns;
  }

  /// Counts what controllers that recover have seen until `to_ns`, where the stretch `ends` or goes on.
  void count_recessive(std::int64_t to_ns, bool ends) {
    const std::int64_t sequence_ns = bits_ns(kSequenceBits);
    for (const auto& station : stations_) {
      if (!station->recovers) continue;
      const std::int64_t idle_ns = std::max<std::int64_t>(to_ns - station->recessive_since_ns, 0);
      const int seen = station->sequences + static_cast<int>(idle_ns / sequence_ns);
      if (seen >= kRecoverySequences) {
        station->recovers = false;
        station->errors.reset();
        ++station->statistics.restarts;
      } else if (ends) {
        station->sequences = seen;
        station->recessive_since_ns = to_ns;
      }
    }
  }

  void deliver_delayed(std::int64_t to_ns) {
    while (!delayed_.empty()) {
      const auto next =
          std::min_element(delayed_.begin(), delayed_.end(),
                           [](const Delayed& a, const Delayed& b) { return a.due_ns < b.due_ns; });
      if (next->due_ns > to_ns) return;
      const Delayed due = *next;
      delayed_.erase(next);
      give_to_all({due.frame, due.due_ns / 1000, Origin::Elsewhere}, due.sender);
    }
  }

  void count_busy(const Flight& flight) {
    const std::int64_t duration = duration_ns(flight.frame);
    ++load_.frames;
    busy_ns_ += duration;
    const std::int64_t window = flight.end_ns / kWindow_ns;
    if (window != window_) {
      worst_window_ns_ = std::max(worst_window_ns_, window_busy_ns_);
      window_ = window;
      window_busy_ns_ = 0;
    }
    window_busy_ns_ += duration;
  }

  Settings settings_;
  FaultInjector injector_;
  std::function<void(const Received&)> observer_;
  std::vector<std::shared_ptr<Station>> stations_;
  std::vector<Delayed> delayed_;
  std::optional<Flight> flight_;
  int joined_ = 0;
  std::int64_t now_ns_ = 0;
  std::int64_t free_ns_ = 0;
  std::int64_t busy_ns_ = 0;
  std::int64_t window_ = 0;
  std::int64_t window_busy_ns_ = 0;
  std::int64_t worst_window_ns_ = 0;
  Load load_;
};

class SimBus::End final : public Bus {
 public:
  End(std::shared_ptr<Medium> medium, std::vector<Filter> filters)
      : medium_(std::move(medium)), station_(medium_->join(std::move(filters))) {}
  End(const End&) = delete;
  End& operator=(const End&) = delete;
  End(End&&) = delete;
  End& operator=(End&&) = delete;
  ~End() override { medium_->leave(station_); }

  Expected<void> send(const wire::Frame& frame) override {
    if (station_->errors.off()) {
      ++station_->statistics.lost_sending;
      return tl::unexpected(Failure{FailureKind::Overflow, "the CAN controller is off the bus"});
    }
    if (station_->sending.size() >= kSendQueue) {
      ++station_->statistics.lost_sending;
      return tl::unexpected(Failure{FailureKind::Overflow, "too many frames wait for the bus"});
    }
    station_->sending.push_back({frame, medium_->now_ns()});
    return {};
  }

  Expected<std::optional<Received>> receive() override {
    if (station_->received.empty()) return std::nullopt;
    const Received first = station_->received.front();
    station_->received.pop_front();
    return first;
  }

  [[nodiscard]] Statistics statistics() const override { return station_->statistics; }
  [[nodiscard]] Health health() const override {
    return {.off = station_->errors.off(),
            .passive = station_->errors.passive(),
            .overruns = static_cast<std::uint32_t>(station_->statistics.lost_receiving)};
  }
  void restart() override { medium_->restart(*station_); }

 private:
  std::shared_ptr<Medium> medium_;
  std::shared_ptr<Station> station_;
};

SimBus::SimBus() : SimBus(Settings{}) {}
SimBus::SimBus(Settings settings) : medium_(std::make_shared<Medium>(settings)) {}
SimBus::~SimBus() = default;

std::unique_ptr<Bus> SimBus::open(std::vector<Filter> filters) {
  return std::make_unique<End>(medium_, std::move(filters));
}
void SimBus::advance_to(std::int64_t time_us) {
  medium_->advance_to(time_us * 1000);
}
std::int64_t SimBus::now_us() const {
  return medium_->now_ns() / 1000;
}
void SimBus::on_frame(std::function<void(const Received&)> observer) {
  medium_->on_frame(std::move(observer));
}
void SimBus::add_fault(const Fault& fault) {
  medium_->injector().add(fault);
}
void SimBus::inject_error(const wire::Frame& error) {
  medium_->give_to_all({error, now_us(), Origin::Elsewhere}, 0);
}
Load SimBus::load() const {
  return medium_->load();
}

}  // namespace pinjaw::bus
