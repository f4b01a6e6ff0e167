#pragma once

#include <string>
#include <vector>

#include "host/base/yaml.hpp"
#include "host/model/sequence.hpp"

namespace pinjaw::config {

/// The steps of a sequence on `cell`, in order. Stations must exist, handoffs be pairs of the cell, and the
/// script must know where the part is: placed once, handed on by who has it, removed from where it is.
std::vector<model::Step> read_steps(const base::YamlValue& list, const model::Cell& cell);

/// The faults of a sequence of `step_count` steps.
std::vector<model::ScriptedFault> read_faults(const base::YamlValue& list, std::size_t step_count);

}  // namespace pinjaw::config
