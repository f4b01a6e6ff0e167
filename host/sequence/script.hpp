#pragma once

#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "host/base/expected.hpp"
#include "host/model/sequence.hpp"
#include "host/planner/plan/scene.hpp"
#include "host/sequence/action.hpp"
#include "host/sequence/crew.hpp"

namespace pinjaw::sequence {

/// One step of the sequence as actions.
struct StepScript {
  std::string name;
  std::vector<Action> actions;
  std::vector<Action> undo;                                ///< after a failed try, before the next one
  std::function<bool(const jaw_client::Client&)> reached;  ///< the step's end is there already; may be empty
  int tries = 1;
  double within_s = std::numeric_limits<double>::infinity();
  double needed_n = 0;    ///< most squeeze that the step's loads need of whoever holds the part then
  double required_n = 0;  ///< what that station's design was planned for
};

/// The sequence as step scripts, the first of which sets the controllers up: layouts, permission, sessions.
/// Fails with a sentence where the steps cannot follow each other: a station hands over what it does not
/// have, or turned over.
base::Expected<std::vector<StepScript>> script_of(const model::Sequence& sequence, Crew& crew,
                                                  const planner::Scene& scene);

}  // namespace pinjaw::sequence
