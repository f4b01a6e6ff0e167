#include <span>
#include <vector>

#include "firmware_sim/world/world.hpp"
#include "host/app/venue.hpp"
#include "protocol/bus/candump.hpp"
#include "protocol/bus/sim_bus.hpp"
#include "protocol/wire/layout.hpp"

namespace pinjaw::app {

namespace {

constexpr std::int64_t kTick_us = 1000;

node::Figures figures_of(const model::Station& station, const std::optional<model::Authentication>& key) {
  const model::Kit& kit = station.task.kit;
  node::Figures figures;
  figures.node = station.node;
  figures.passive = !station.grips;
  if (key) figures.key = key->key;
  figures.can_fd = key && key->can_fd;
  figures.kit_id = wire::kit_id_of(std::span(kit.sha256));
  figures.max_squeeze_n = kit.actuator.max_squeeze_n;
  figures.force_uncertainty_n = kit.actuator.force_uncertainty_n;
  figures.separation_min_mm = kit.jaws.separation_mm.lo;
  figures.separation_max_mm = kit.jaws.separation_mm.hi;
  return figures;
}

class SimVenue final : public Venue {
 public:
  SimVenue(const model::Cell& cell, std::uint64_t seed, const std::optional<model::Authentication>& key)
      : wire_({.seed = seed}),
        host_end_(wire_.open()),
        ends_(open_ends(cell)),
        world_(members(cell, key), seed),
        port_([this](const bench::Request& request) { return world_.handle(request); }) {
    wire_.on_frame([this](const bus::Received& received) {
      log_ += bus::to_log_line({received.time_us, "sim0", received.frame}) + "\n";
    });
  }

  bus::Bus& bus() override { return *host_end_; }
  bench::WorldPort* world() override { return &port_; }
  std::int64_t tick_us() override {
    now_us_ += kTick_us;
    wire_.advance_to(now_us_);
    // the in-process bus cannot fail
    static_cast<void>(world_.step());
    return now_us_;
  }
  void lose_frames(double share, double seconds) override {
    bus::Fault fault;
    fault.kind = bus::FaultKind::Drop;
    fault.from_us = wire_.now_us();
    fault.to_us = fault.from_us + static_cast<std::int64_t>(seconds * 1e6);
    fault.share = share;
    wire_.add_fault(fault);
  }
  [[nodiscard]] bool loses_frames() const override { return true; }
  [[nodiscard]] std::optional<double> load_percent() const override { return wire_.load().percent(); }
  [[nodiscard]] const std::string& log() const override { return log_; }

 private:
  std::vector<std::unique_ptr<bus::Bus>> open_ends(const model::Cell& cell) {
    std::vector<std::unique_ptr<bus::Bus>> ends;
    for (std::size_t i = 0; i < cell.stations.size(); ++i) ends.push_back(wire_.open());
    return ends;
  }
  [[nodiscard]] std::vector<world::Member> members(const model::Cell& cell,
                                                   const std::optional<model::Authentication>& key) const {
    std::vector<world::Member> members;
    for (std::size_t i = 0; i < cell.stations.size(); ++i) {
      members.push_back({figures_of(cell.stations[i], key), ends_[i].get()});
    }
    return members;
  }

  bus::SimBus wire_;
  std::unique_ptr<bus::Bus> host_end_;
  std::vector<std::unique_ptr<bus::Bus>> ends_;
  world::World world_;
  bench::InProcessWorld port_;
  std::int64_t now_us_ = 0;
  std::string log_;
};

}  // namespace

std::unique_ptr<Venue> open_sim_venue(const model::Cell& cell, std::uint64_t seed,
                                      const std::optional<model::Authentication>& key) {
  const auto& of_cell = cell.authentication ? cell.authentication : key;
  return std::make_unique<SimVenue>(cell, seed, of_cell);
}

}  // namespace pinjaw::app
