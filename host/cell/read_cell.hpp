#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "host/base/diagnostics.hpp"
#include "host/base/expected.hpp"
#include "host/cell/cell_plan.hpp"
#include "host/model/cell.hpp"
#include "host/planner/plan/json_values.hpp"

namespace pinjaw::cell {

/// What a written cell plan says of one station besides its designs.
struct StationFacts {
  std::string station;
  std::string task;
  model::Kit kit;
  planner::Friction friction;
  model::Side side = model::Side::Below;
  bool grips = true;
};

/// A cell plan as a run needs it: the designs, and what they were made for.
struct SavedCellPlan {
  std::string file;
  std::string cell;
  std::filesystem::path part_file;
  std::string part_sha256;
  model::Vector3d up = model::Vector3d::UnitZ();
  std::vector<StationFacts> stations;
  std::vector<model::Handoff> handoffs;
  std::vector<CellDesign> designs;  ///< smallest max_required_n first
};

/// Reads `pinjaw-cell/1` JSON, or tells every mistake in it. Each design has one entry for each station: four
/// pins where it grips, else three.
base::Checked<SavedCellPlan> read_cell_plan(const std::filesystem::path& path);

/// Whether the plan was made for this cell: the same handoffs, the same stations with the same kits and
/// sides, and the part with `part_sha256`. Fails with a sentence that names what differs.
base::Expected<void> made_for(const SavedCellPlan& plan, const model::Cell& cell,
                              const std::string& part_sha256);

}  // namespace pinjaw::cell
