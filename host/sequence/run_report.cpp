#include "host/sequence/run_report.hpp"

#include <nlohmann/json.hpp>

#include "host/base/json_number.hpp"
#include "protocol/bus/statistics.hpp"
#include "protocol/wire/names.hpp"

namespace pinjaw::sequence {

namespace {

using nlohmann::ordered_json;

/// Virtual and real time are counted in microseconds.
double seconds(double time_s) {
  return base::rounded(time_s, 6);
}

ordered_json step_json(const StepReport& step) {
  ordered_json states = ordered_json::array();
  for (const StateChange& change : step.states) {
    states.push_back({{"t_s", seconds(change.t_s)},
                      {"node", change.node},
                      {"state", wire::to_string(change.state)},
                      {"fact", wire::to_string(change.fact)}});
  }
  return {{"step", step.step},          {"result", step.result}, {"from_s", seconds(step.from_s)},
          {"to_s", seconds(step.to_s)}, {"tries", step.tries},   {"states", states}};
}

ordered_json plant_json(const std::optional<bench::Truth>& truth) {
  if (!truth) return nullptr;
  ordered_json plant = {{"max_squeeze_n", ordered_json::object()}, {"over_limit_s", ordered_json::object()}};
  for (const bench::NodeTruth& node : truth->nodes) {
    if (node.passive) continue;
    plant["max_squeeze_n"][std::to_string(node.node)] = node.max_squeeze_n;
    plant["over_limit_s"][std::to_string(node.node)] = node.over_limit_s;
  }
  plant["dropped"] = truth->dropped;
  plant["slip_mm"] = truth->slip_mm;
  plant["min_holders"] = truth->min_holders ? ordered_json(*truth->min_holders) : ordered_json(nullptr);
  plant["holders_at_end"] = truth->holders;
  return plant;
}

ordered_json bus_json(const BusReport& report) {
  ordered_json bus = {
      {"frames", report.frames},
      {"load_percent", report.load_percent ? ordered_json(*report.load_percent) : ordered_json(nullptr)}};
  for (const bus::Trouble& trouble : bus::kTroubles) bus[trouble.key] = report.statistics.*trouble.count;
  return bus;
}

}  // namespace

std::string to_json(const RunReport& report) {
  ordered_json document = {{"format", "pinjaw-run/1"},
                           {"sequence", report.sequence},
                           {"design", report.design},
                           {"result", report.result == RunResult::Done ? "done" : "aborted"},
                           {"undersampled", report.undersampled}};
  document["steps"] = ordered_json::array();
  for (const StepReport& step : report.steps) document["steps"].push_back(step_json(step));
  document["plant"] = plant_json(report.plant);
  document["bus"] = bus_json(report.bus);
  return document.dump(1) + "\n";
}

}  // namespace pinjaw::sequence
