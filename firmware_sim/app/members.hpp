#pragma once

#include <filesystem>
#include <vector>

#include "firmware_sim/node/figures.hpp"
#include "host/base/diagnostics.hpp"
#include "host/model/controller.hpp"

namespace pinjaw::jaw_app {

/// What a simulated node needs of its controller's file and kit.
node::Figures figures_of(const model::Controller& controller);

/// The controllers of all files, or every mistake in them, two of one node number among these.
base::Checked<std::vector<node::Figures>> read_members(const std::vector<std::filesystem::path>& paths);

}  // namespace pinjaw::jaw_app
