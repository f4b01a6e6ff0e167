#pragma once

#include <filesystem>
#include <string>

#include "host/base/diagnostics.hpp"
#include "host/planner/plan/plan.hpp"

namespace pinjaw::planner {

/// The plan as `pinjaw-plan/1` JSON, indented, ending in a newline. It carries the whole kit, so that the
/// plan file and the part are all that a check, a sheet or a controller needs.
std::string to_json(const Plan& plan);

/// A plan file back as a value, or all that is wrong with it, each with the field's path.
base::Checked<Plan> read_plan(const std::filesystem::path& path);

}  // namespace pinjaw::planner
