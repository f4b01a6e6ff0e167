#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "host/base/json_fields.hpp"
#include "host/model/design.hpp"
#include "host/planner/force/disturbances.hpp"

namespace pinjaw::planner {

/// A certified worst spray; `low_n` and `high_n` are left out where no squeeze resists it.
nlohmann::ordered_json certified_json(const model::Certified& certified);
model::Certified read_certified(const base::JsonField& field);

/// The jets that a plan's worst sprays are among, each with the states of what acts with it.
nlohmann::ordered_json jets_json(const std::vector<Jet>& jets);
std::vector<Jet> read_jets(const base::JsonField& field);

/// Named wrenches, as a plan lists its disturbances.
nlohmann::ordered_json disturbances_json(const std::vector<model::Disturbance>& disturbances);
std::vector<model::Disturbance> read_disturbances(const base::JsonField& field);

}  // namespace pinjaw::planner
