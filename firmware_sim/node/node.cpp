#include "firmware_sim/node/node.hpp"

#include <algorithm>
#include <cmath>

#include "firmware_sim/node/units.hpp"

namespace pinjaw::node {
namespace {

constexpr int kPlantSteps = 50;     // of plant::kStep_s in 1 ms
constexpr int kFramesPerStep = 64;  // chosen: a controller's receive buffer; 1 ms of 500 kbit/s brings four
constexpr double k10um_per_m = 1e5;
constexpr double kMoving_m_s = 0.01;
constexpr unsigned kWatchdog_ms = 50;  // docs/reliability.md 2.7, I5

plant::Spool plant_spool(core::Spool spool) {
  switch (spool) {
    case core::Spool::Close:
      return plant::Spool::Close;
    case core::Spool::Open:
      return plant::Spool::Open;
    case core::Spool::Hold:
      break;
  }
  return plant::Spool::Hold;
}

core::BusHealth health_of(const bus::Health& health) {
  return {.off = health.off, .passive = health.passive, .overruns = health.overruns};
}

plant::Actuation actuation_of(const core::Valves& valves) {
  return {.spool = plant_spool(valves.spool),
          .close_set_pa = valves.close_set_mbar * kPa_per_mbar,
          .relax = valves.relax,
          .vent_open = valves.pre_vent,
          .supply_cut = valves.supply_cut};
}

}  // namespace

Node::Node(const Figures& figures, std::uint64_t seed, bus::Bus& bus)
    : figures_(figures),
      config_(core_config(figures)),
      parameters_(plant_parameters(figures)),
      bus_(&bus),
      firmware_(core::power_on(config_, memory_.image())),
      plant_(plant::initial_state(parameters_, seed, parameters_.jaw.max_separation_m)) {
  truth_.separation_mm = figures.separation_max_mm;
}

bus::Expected<void> Node::step(const Surroundings& surroundings, unsigned elapsed_ms) {
  bus::Expected<void> taken = take_frames();
  bus::Expected<void> sent;
  if (powered_ && !hangs_) sent = run_firmware(surroundings, elapsed_ms);
  mind_watchdog(elapsed_ms);
  memory_.advance_ms(powered_ ? elapsed_ms : 0);
  if (!figures_.passive) run_plant(surroundings, elapsed_ms);
  return taken ? sent : taken;
}

void Node::set_power(bool on) {
  if (on == powered_) return;
  powered_ = on;
  hangs_ = false;
  valves_ = {};
  if (on) {
    firmware_ = core::power_on(config_, memory_.image());
  } else {
    memory_.cut_power();
  }
}

void Node::apply(const Fault& fault) {
  switch (fault.of) {
    case Fault::Of::Plant:
      return fault.add(fault.value, faults_);
    case Fault::Of::Memory:
      return memory_.fail();
    case Fault::Of::Processor:
      hangs_ = true;
  }
}

/// Resets a processor that hangs: the valves fall to rest, and it starts from its memory.
void Node::mind_watchdog(unsigned elapsed_ms) {
  silent_ms_ = powered_ && hangs_ ? silent_ms_ + elapsed_ms : 0;
  if (silent_ms_ < kWatchdog_ms) return;
  hangs_ = false;
  valves_ = {};
  memory_.cut_power();
  core::NvmImage found = memory_.image();
  found.reset = wire::ResetCause::Watchdog;
  firmware_ = core::power_on(config_, found);
}

bool Node::moves() const {
  return !figures_.passive && plant_.spool != plant::Spool::Hold && std::abs(plant_.speed_m_s) > kMoving_m_s;
}

bus::Expected<void> Node::take_frames() {
  received_.clear();
  for (int i = 0; i < kFramesPerStep; ++i) {
    auto next = bus_->receive();
    if (!next) return tl::unexpected(next.error());
    if (!*next) break;
    if (powered_ && (*next)->origin != bus::Origin::Self) received_.push_back((*next)->frame);
  }
  return {};
}

core::Sensors Node::read_sensors(const Surroundings& surroundings) {
  core::Sensors sensors;
  sensors.local_enable = surroundings.local_enable;
  if (figures_.passive) {
    sensors.seats = surroundings.seats_pressed ? config_.seat_switches : std::uint8_t{0};
    return sensors;
  }
  const plant::Readings readings = plant::read(parameters_, faults_, plant_);
  for (std::size_t i = 0; i < 2; ++i) {
    sensors.close_mbar.at(i) = whole(readings.close_pa.at(i) / kPa_per_mbar);
    sensors.open_mbar.at(i) = whole(readings.open_pa.at(i) / kPa_per_mbar);
  }
  sensors.supply_mbar = whole(readings.supply_pa / kPa_per_mbar);
  sensors.separation_10um = whole(readings.separation_m * k10um_per_m);
  return sensors;
}

bus::Expected<void> Node::run_firmware(const Surroundings& surroundings, unsigned elapsed_ms) {
  if (board_ != nullptr) {
    valves_ = board_->exchange(read_sensors(surroundings));
    return {};
  }
  const core::Outputs outputs = core::step(firmware_, {.elapsed_ms = elapsed_ms,
                                                       .received = received_,
                                                       .sensors = read_sensors(surroundings),
                                                       .nvm = memory_.status(),
                                                       .bus = health_of(bus_->health())});
  if (outputs.nvm) memory_.store(*outputs.nvm);
  valves_ = outputs.valves;
  if (outputs.restart_bus) bus_->restart();
  bus::Expected<void> result;
  for (const wire::Frame& frame : outputs.send.view()) {
    const auto sent = bus_->send(frame);
    // A full queue loses a frame, which counters show; anything else the caller must know.
    if (!sent && sent.error().kind != bus::FailureKind::Overflow) result = sent;
  }
  return result;
}

void Node::run_plant_for_1_ms(const plant::Inputs& inputs) {
  if (coasts_ && plant::at_rest(parameters_, inputs, plant_)) {
    plant::coast(parameters_, inputs, kPlantSteps * plant::kStep_s, plant_);
    const double squeeze_n = plant::squeeze_n(plant_);
    truth_.least_n = std::min(truth_.least_n, squeeze_n);
    truth_.most_n = std::max(truth_.most_n, squeeze_n);
    return;
  }
  for (int i = 0; i < kPlantSteps; ++i) {
    plant::step(parameters_, inputs, plant::kStep_s, plant_);
    truth_.least_n = std::min(truth_.least_n, plant::squeeze_n(plant_));
    truth_.most_n = std::max(truth_.most_n, plant::squeeze_n(plant_));
  }
}

void Node::run_plant(const Surroundings& surroundings, unsigned elapsed_ms) {
  const plant::Inputs inputs = {.actuation = actuation_of(valves_),
                                .contact = surroundings.contact,
                                .neighbour_moves = surroundings.neighbour_moves,
                                .faults = faults_};
  truth_.least_n = plant::squeeze_n(plant_);
  truth_.most_n = truth_.least_n;
  for (unsigned i = 0; i < elapsed_ms; ++i) run_plant_for_1_ms(inputs);
  truth_.left_n = plant_.left_n;
  truth_.right_n = plant_.right_n;
  truth_.squeeze_n = plant::squeeze_n(plant_);
  truth_.separation_mm = plant::separation_m(parameters_, plant_) * 1e3;
}

}  // namespace pinjaw::node
