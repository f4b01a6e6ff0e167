#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "host/base/expected.hpp"
#include "host/model/cell.hpp"
#include "host/model/design.hpp"
#include "host/planner/interference/adjustment.hpp"
#include "host/planner/plan/plan.hpp"

namespace pinjaw::cell {

/// One station of a cell design: its pins and how the station is adjusted.
struct StationDesign {
  std::string station;
  model::Design design;  ///< of a pallet: three pins, squeeze all 0
  planner::Adjustment adjust;
};

/// One design for each station, every handoff of the cell free of interference.
struct CellDesign {
  std::string id;
  std::vector<StationDesign> stations;  ///< in the cell's order
  double max_required_n = 0;            ///< larger F_max of the stations that squeeze
};

/// How many pairs of designs one handoff of the cell allows.
struct PairCount {
  std::string giver;
  std::string receiver;
  std::int64_t count = 0;
};

struct StationPlan {
  std::string station;
  planner::Plan
      plan;  ///< every design; of a pallet: three pins each, the funnel's force phases equal to loadable
  bool grips = true;
};

/// Phase 6 (BB 3.6, 4.1): compatible designs for all stations of a cell, smallest max_required_n first.
struct CellPlan {
  std::string cell;
  std::vector<StationPlan> stations;  ///< in the cell's order
  std::vector<PairCount> pairs;       ///< in the order of the cell's handoffs
  std::int64_t triples = 0;           ///< joined combinations, all of them counted
  std::vector<CellDesign> designs;    ///< the best `top`
};

struct CellOptions {
  planner::PlanOptions plan;  ///< friction, loading, threads; its `top` is ignored: all designs take part
  std::size_t top = 100;
};

/// Plans every station and joins them. No compatible combination is a legitimate answer: `designs` is empty.
base::Expected<CellPlan> make_cell_plan(const model::Cell& cell, const CellOptions& options,
                                        const planner::ProgressSink& progress = {});

/// `pinjaw-cell/1` JSON.
std::string to_json(const CellPlan& plan);

}  // namespace pinjaw::cell
