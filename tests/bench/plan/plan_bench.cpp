// Whole plans by the program itself: CPU time, peak memory, and the same with the exact cone.
#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <string>
#include <vector>

#include "host/planner/features/features.hpp"
#include "host/planner/planar/planar.hpp"
#include "tests/bench/suites.hpp"
#include "tests/bench/support/command.hpp"
#include "tests/bench/support/cpu_time.hpp"
#include "tests/bench/support/shipped.hpp"
#include "tests/support/places.hpp"

namespace pinjaw::bench {
namespace {

constexpr int kPlans = 5;

/// Median CPU time and largest memory of planning a shipped task.
CommandCost planned(const std::string& task_name, const std::vector<std::string>& options) {
  std::vector<std::string> command{test::program("pinjaw"), "plan",
                                   test::source_dir("configs/tasks/" + task_name + ".yaml"), "--progress",
                                   "none"};
  command.insert(command.end(), options.begin(), options.end());
  CommandCost cost;
  std::vector<double> spent_s;
  for (int i = 0; i < kPlans; ++i) {
    const CommandCost one = cost_of(command);
    if (one.exit_code != 0) throw std::runtime_error("pinjaw plan " + task_name + " failed");
    spent_s.push_back(one.cpu_s);
    cost.peak_mb = std::max(cost.peak_mb, one.peak_mb);
  }
  cost.cpu_s = median(spent_s);
  return cost;
}

void measure_glue_gun(Report& report) {
  const char* task = "glue-gun-sprayed";
  const CommandCost pyramid = planned(task, {});
  const CommandCost one_thread = planned(task, {"--threads", "1"});
  Measurement time;
  time.thing = "whole plan, glue gun housing, 4 x 9, 300 sprays";
  time.unit = "s of CPU time";
  time.ours = pyramid.cpu_s;
  time.at_most = 6;
  time.peers = {{"on one thread", one_thread.cpu_s}};
  report.add(time);
  Measurement memory;
  memory.thing = "its peak memory";
  memory.unit = "MB";
  memory.ours = pyramid.peak_mb;
  memory.at_most = 400;
  report.add(memory);
}

/// How much a planar fixture costs where there are very many.
void measure_many(Report& report) {
  const Shipped shipped("glue-gun-sprayed");
  model::Kit kit = shipped.task.kit;
  kit.grid.columns = 8;
  kit.grid.rows = 18;
  planner::PlanarOptions options;
  options.twins = planner::Twins::Once;
  const auto features = planner::find_features(shipped.scene.turned, kit.pins).features;
  std::size_t fixtures = 0;
  const Contestant ours{
      "pinjaw", [&] { fixtures = planner::plan_planar_fixtures(features, kit, options).fixtures.size(); }};
  const double spent_s = median_cpu_s({&ours, 1}, 3).front();
  Measurement measurement;
  measurement.thing = "planar fixtures of the glue gun housing, 8 x 18";
  measurement.unit = "us of CPU time a fixture";
  measurement.ours = 1e6 * spent_s / static_cast<double>(fixtures);
  measurement.note = fmt::format("{} fixtures", fixtures);
  report.add(measurement);
}

}  // namespace

void measure_plan(Report& report) {
  measure_glue_gun(report);
  measure_many(report);
}

}  // namespace pinjaw::bench
