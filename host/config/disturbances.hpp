#pragma once

#include <vector>

#include "host/base/yaml.hpp"
#include "host/model/disturbance.hpp"

namespace pinjaw::config {

/// `always` and `disturbances` of a task.
struct DisturbanceLists {
  std::vector<model::DisturbanceSource> always;
  std::vector<model::DisturbanceSource> disturbances;
};

/// Reads both lists. Unnamed disturbances are named after their kind (`spray`, then `spray-2`); a name stands
/// for one disturbance only. `always` takes no spray.
DisturbanceLists read_disturbances(base::YamlMap& task);

}  // namespace pinjaw::config
