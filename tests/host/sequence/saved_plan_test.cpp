#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <fstream>

#include "host/cell/read_cell.hpp"
#include "tests/host/sequence/small_cell.hpp"

/// A cell plan written, read again, and compared with the cell that a run wants it for.
namespace pinjaw::cell {
namespace {

using sequence::testing::small_cell;

SavedCellPlan saved() {
  const std::string file = ::testing::TempDir() + "saved_cell_plan.json";
  std::ofstream(file) << to_json(*make_cell_plan(small_cell().cell, {.plan = {}, .top = 2}));
  auto plan = read_cell_plan(file);
  std::remove(file.c_str());
  return plan.value();
}

TEST(SavedCellPlan, comes_back_as_it_was_written) {
  const SavedCellPlan plan = saved();
  ASSERT_EQ(plan.designs.size(), 2U);
  const CellDesign& best = plan.designs.front();
  EXPECT_EQ(best.id, small_cell().design.id);
  for (const StationDesign& made : small_cell().design.stations) {
    const auto found = std::ranges::find(best.stations, made.station, &StationDesign::station);
    ASSERT_NE(found, best.stations.end());
    EXPECT_EQ(found->design.jaw_separation_mm, made.design.jaw_separation_mm);
    EXPECT_EQ(found->design.pins.size(), made.design.pins.size());
    EXPECT_NEAR(found->adjust.theta_rad, made.adjust.theta_rad, 1e-12);
  }
  EXPECT_TRUE(made_for(plan, small_cell().cell, small_cell().scene.part.sha256));
}

TEST(SavedCellPlan, is_refused_for_another_part_kit_side_or_handoff) {
  const SavedCellPlan plan = saved();
  const std::string part = small_cell().scene.part.sha256;
  EXPECT_FALSE(made_for(plan, small_cell().cell, "another"));
  model::Cell other = small_cell().cell;
  other.stations.front().task.kit.sha256 = "another";
  EXPECT_FALSE(made_for(plan, other, part));
  other = small_cell().cell;
  other.stations.front().task.side = model::Side::Below;
  EXPECT_FALSE(made_for(plan, other, part));
  other = small_cell().cell;
  other.handoffs.pop_back();
  EXPECT_FALSE(made_for(plan, other, part));
}

}  // namespace
}  // namespace pinjaw::cell
