#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "protocol/bench/bench.hpp"
#include "protocol/bus/bus.hpp"
#include "protocol/wire/codes.hpp"

namespace pinjaw::sequence {

enum class RunResult { Done, Aborted };

/// A controller's report of itself, when it changed.
struct StateChange {
  double t_s = 0;
  int node = 0;
  wire::State state = wire::State::Boot;
  wire::Fact fact = wire::Fact::Unknown;
};

struct StepReport {
  std::string step;
  std::string result;  ///< done, or what went wrong
  double from_s = 0;
  double to_s = 0;
  int tries = 1;
  std::vector<StateChange> states;
};

struct BusReport {
  std::uint64_t frames = 0;
  std::optional<double> load_percent;  ///< nothing where the bus cannot tell
  bus::Statistics statistics;          ///< of the host's end
};

/// What happened in a run. The plant's figures come from the world; nothing where none was simulated.
struct RunReport {
  std::string sequence;
  std::string design;
  RunResult result = RunResult::Aborted;
  bool undersampled = false;  ///< a drawn load needed more squeeze than the plan's required_n
  std::vector<StepReport> steps;
  std::optional<bench::Truth> plant;
  BusReport bus;
};

/// `pinjaw-run/1` JSON, ending in a newline.
std::string to_json(const RunReport& report);

}  // namespace pinjaw::sequence
