#include "tests/host/sequence/small_cell.hpp"

#include <numbers>
#include <span>
#include <stdexcept>

#include "firmware_sim/world/world.hpp"
#include "host/config/read.hpp"
#include "protocol/bus/candump.hpp"
#include "protocol/bus/sim_bus.hpp"
#include "tests/support/places.hpp"

namespace pinjaw::sequence::testing {

namespace {

SmallCell make_small_cell() {
  const auto cell = config::read_cell(test::source_dir("tests/host/sequence/small/cell.yaml"));
  if (!cell) throw std::runtime_error(base::render(cell.error(), "no cell"));
  auto scene = planner::read_scene(cell->stations.front().task);
  if (!scene) throw std::runtime_error(scene.error().message);
  auto plan = cell::make_cell_plan(*cell, {.plan = {}, .top = 1});
  if (!plan) throw std::runtime_error(plan.error().message);
  if (plan->designs.empty()) throw std::runtime_error("the small cell has no design");
  return {*cell, std::move(*scene), std::move(plan->designs.front())};
}

/// The in-process bus with the cell's controllers and their world.
class Controllers {
 public:
  Controllers(const model::Cell& cell, const Conditions& conditions)
      : wire_({.bit_rate = 500'000, .seed = conditions.seed}),
        host_end_(wire_.open()),
        world_(members(cell, conditions), conditions.seed),
        port_([this](const bench::Request& request) { return world_.handle(request); }) {
    wire_.on_frame([this](const bus::Received& received) {
      log_ += bus::to_log_line({received.time_us, "sim0", received.frame}) + "\n";
    });
  }

  Venue venue() {
    return {host_end_.get(), &port_, [this](double share, double seconds) {
              bus::Fault fault;
              fault.from_us = wire_.now_us();
              fault.to_us = fault.from_us + static_cast<std::int64_t>(seconds * 1e6);
              fault.share = share;
              wire_.add_fault(fault);
            }};
  }
  void advance_to(std::int64_t now_us) {
    wire_.advance_to(now_us);
    if (!world_.step()) throw std::runtime_error("the in-process bus failed");
  }
  [[nodiscard]] const std::string& log() const { return log_; }

 private:
  std::vector<world::Member> members(const model::Cell& cell, const Conditions& conditions) {
    std::vector<world::Member> members;
    for (const model::Station& station : cell.stations) {
      const model::Kit& kit = station.task.kit;
      node::Figures figures;
      figures.node = station.node;
      figures.passive = !station.grips;
      figures.kit_id = wire::kit_id_of(std::span(kit.sha256));
      figures.max_squeeze_n =
          station.name == "arm" ? conditions.controller_limit_n : kit.actuator.max_squeeze_n;
      figures.force_uncertainty_n = kit.actuator.force_uncertainty_n;
      figures.separation_min_mm = kit.jaws.separation_mm.lo;
      figures.separation_max_mm = kit.jaws.separation_mm.hi;
      ends_.push_back(wire_.open());
      members.push_back({figures, ends_.back().get()});
    }
    return members;
  }

  bus::SimBus wire_;
  std::unique_ptr<bus::Bus> host_end_;
  std::vector<std::unique_ptr<bus::Bus>> ends_;
  world::World world_;
  bench::InProcessWorld port_;
  std::string log_;
};

}  // namespace

const SmallCell& small_cell() {
  static const SmallCell kCell = make_small_cell();
  return kCell;
}

model::Sequence cleaning() {
  constexpr double kHalfTurn = std::numbers::pi;
  model::Sequence sequence;
  sequence.name = "small";
  sequence.cell = small_cell().cell;
  sequence.steps = {model::PlaceStep{"pallet"},
                    model::HandoffStep{"pallet", "arm"},
                    model::MoveStep{"arm", 0.5, 0.5},
                    model::HandoffStep{"arm", "pedestal"},
                    model::SprayStep{"pedestal", 0.5, 4, 3},
                    model::HandoffStep{"pedestal", "arm"},
                    model::RotateStep{"arm", kHalfTurn, 0.5, 2},
                    model::SprayStep{"arm", 0.5, 4, 4},
                    model::RotateStep{"arm", -kHalfTurn, 0.5, 2},
                    model::HandoffStep{"arm", "pallet"},
                    model::RemoveStep{"pallet"}};
  return sequence;
}

Played play(const model::Sequence& sequence, const Conditions& conditions) {
  auto crew = Crew::of(sequence.cell, small_cell().design, small_cell().scene);
  if (!crew) throw std::runtime_error(crew.error().message);
  auto scripts = script_of(sequence, *crew, small_cell().scene);
  if (!scripts) throw std::runtime_error(scripts.error().message);
  Controllers controllers(sequence.cell, conditions);
  const auto epoch = static_cast<std::uint16_t>(conditions.seed);
  Run run(sequence, *crew, std::move(*scripts), controllers.venue(), {.epoch = epoch});
  constexpr std::int64_t kLongest_us = 300'000'000;
  for (std::int64_t now_us = 1000; !run.over(); now_us += 1000) {
    if (now_us > kLongest_us) throw std::runtime_error("the run does not end");
    controllers.advance_to(now_us);
    run.step(now_us);
  }
  RunReport report = run.report();
  std::string json = to_json(report);
  return {std::move(report), run.trouble(), controllers.log(), std::move(json)};
}

}  // namespace pinjaw::sequence::testing
