#pragma once

#include "host/base/yaml.hpp"
#include "host/model/robust.hpp"

namespace pinjaw::config {

/// `ranges` of a task: how far friction, pins, part and air may be from nominal; what is not given has its
/// default. The friction's range must hold `friction`, the nominal one, and the pressure's must hold 1.
model::Ranges read_ranges(base::YamlMap& task, double friction);

}  // namespace pinjaw::config
