#pragma once

#include <string>

#include "tests/firmware_sim/model_check/search.hpp"
#include "tests/support/figures.hpp"

namespace pinjaw::core::model {

/// States the figures of a search that went well.
inline void state_figures(const std::string& cell, const Findings& findings) {
  const auto figure = [&](const char* what, auto value, const char* unit) {
    pinjaw::test::figure("I2", cell + ": " + what, value, unit);
  };
  figure("states", findings.states, "states");
  figure("transitions", findings.transitions, "transitions");
  figure("states of single nodes", findings.node_states, "states");
  if (findings.distinct_node_states > 0)
    figure("of these, such that somebody could tell apart", findings.distinct_node_states, "states");
  figure("calls of step()", findings.steps, "calls");
  figure("processor time", findings.cpu_s, "s");
  figure("memory", findings.memory_bytes >> 20, "MiB");
  if (findings.resting > 0)
    pinjaw::test::figure("I2c", cell + ": quiescent states that all others lead to", findings.resting,
                         "states");
}

/// What a failing test should show.
inline std::string trace_of(const Findings& findings) {
  if (!findings.violation) return "nothing is violated";
  return name_of(findings.violation->invariant) + " is violated:\n" + findings.violation->trace;
}

}  // namespace pinjaw::core::model
