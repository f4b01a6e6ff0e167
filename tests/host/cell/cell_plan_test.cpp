#include "host/cell/cell_plan.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <numbers>
#include <set>

#include "host/config/read.hpp"
#include "host/planner/interference/interference.hpp"
#include "tests/support/places.hpp"

namespace pinjaw::cell {
namespace {

using geometry::Vector3d;
using model::Side;
using nlohmann::json;

/// The shipped cell of the paper (BB 4.1), planned once.
struct Shipped {
  model::Cell cell;
  CellPlan plan;
  std::vector<double> part_low_mm;  ///< as each station sees the part
};

const Shipped& shipped() {
  static const Shipped once = [] {
    const auto cell = config::read_cell(test::source_dir("configs/cells/acc.yaml"));
    if (!cell) throw std::runtime_error(base::render(cell.error(), "no cell"));
    const auto plan = make_cell_plan(*cell, {});
    if (!plan) throw std::runtime_error(plan.error().message);
    Shipped shipped{*cell, *plan, {}};
    for (const model::Station& station : cell->stations) {
      const auto scene = planner::read_scene(station.task);
      shipped.part_low_mm.push_back(scene.value().turned.surface.z_range_mm().lo);
    }
    return shipped;
  }();
  return once;
}

std::size_t index_of(const model::Cell& cell, const std::string& name) {
  const auto found = std::ranges::find(cell.stations, name, &model::Station::name);
  return static_cast<std::size_t>(found - cell.stations.begin());
}

planner::FingerSet fingers(const CellDesign& design, std::size_t station) {
  const model::Station& at = shipped().cell.stations[station];
  return planner::fingers_of(design.stations[station].design, {&at.task.kit, at.task.side, at.grips},
                             shipped().part_low_mm[station]);
}

/// The part in the handoff frame, written out in space: turned to the gripper, posed, the station adjusted,
/// turned back (DESIGN 2).
Eigen::Isometry3d part_in_handoff_frame_of(const StationDesign& station, Side side) {
  const auto spatial = [](double theta_rad, const geometry::Vector2d& t_mm) {
    return Eigen::Isometry3d(Eigen::Translation3d(t_mm.x(), t_mm.y(), 0) *
                             Eigen::AngleAxisd(theta_rad, Vector3d::UnitZ()));
  };
  const Eigen::Isometry3d turn(
      Eigen::AngleAxisd(side == Side::Above ? std::numbers::pi : 0, Vector3d::UnitY()));
  const geometry::Pose2& pose = station.design.part_pose;
  return turn * spatial(station.adjust.theta_rad, station.adjust.offset_mm) *
         spatial(pose.theta_rad, pose.t_mm) * turn;
}

TEST(ShippedCell, has_pairs_for_every_handoff_and_many_combinations) {
  const CellPlan& plan = shipped().plan;
  ASSERT_EQ(plan.pairs.size(), 2U);
  for (const PairCount& pair : plan.pairs) EXPECT_GT(pair.count, 1000);
  EXPECT_EQ(plan.pairs[0].giver, "pallet");
  EXPECT_EQ(plan.pairs[1].receiver, "pedestal");
  EXPECT_GT(plan.triples, 1000000);
  EXPECT_EQ(plan.designs.size(), 100U);
}

TEST(ShippedCell, every_handoff_of_its_designs_is_free_of_interference) {
  for (const CellDesign& design : shipped().plan.designs) {
    for (const model::Handoff& handoff : shipped().cell.handoffs) {
      const auto verdict =
          planner::check_handoff(fingers(design, index_of(shipped().cell, handoff.giver)),
                                 fingers(design, index_of(shipped().cell, handoff.receiver)));
      EXPECT_TRUE(verdict.compatible()) << design.id << ": " << planner::to_string(verdict.failed);
    }
  }
}

TEST(ShippedCell, adjustments_are_within_their_bounds_and_bring_the_part_to_one_place) {
  for (const CellDesign& design : shipped().plan.designs) {
    const Eigen::Isometry3d first =
        part_in_handoff_frame_of(design.stations[0], shipped().cell.stations[0].task.side);
    for (std::size_t i = 0; i < design.stations.size(); ++i) {
      const model::Station& station = shipped().cell.stations[i];
      EXPECT_TRUE(planner::within(design.stations[i].adjust, station.adjust)) << design.id << station.name;
      const Eigen::Isometry3d here = part_in_handoff_frame_of(design.stations[i], station.task.side);
      EXPECT_NEAR((here.matrix() - first.matrix()).cwiseAbs().maxCoeff(), 0, 1e-8) << design.id;
    }
  }
}

TEST(ShippedCell, pins_stand_in_holes_and_touch_the_part_where_their_station_planned) {
  for (const CellDesign& design : shipped().plan.designs) {
    for (std::size_t i = 0; i < design.stations.size(); ++i) {
      const model::Kit& kit = shipped().cell.stations[i].task.kit;
      const model::Design& here = design.stations[i].design;
      for (const model::PinDesign& pin : here.pins) {
        EXPECT_LT(pin.hole.row, kit.grid.rows);
        EXPECT_LT(pin.hole.column, kit.grid.columns);
        EXPECT_GE(std::min(pin.hole.row, pin.hole.column), 0);
        const geometry::Vector2d hole_mm = model::p_GHole_mm(kit.grid, pin.hole, here.jaw_separation_mm);
        EXPECT_NEAR((hole_mm + kit.pins.radius_mm * pin.normal - pin.contact_mm).norm(), 0, 1e-6);
      }
    }
  }
}

TEST(ShippedCell, designs_come_by_the_larger_squeeze_of_the_stations_that_grip) {
  double before_n = 0;
  std::set<std::string> ids;
  for (const CellDesign& design : shipped().plan.designs) {
    double larger_n = 0;
    for (std::size_t i = 0; i < design.stations.size(); ++i) {
      if (!shipped().cell.stations[i].grips) continue;
      larger_n = std::max(larger_n, design.stations[i].design.squeeze.required_n);
    }
    EXPECT_EQ(design.max_required_n, larger_n);
    EXPECT_GE(design.max_required_n, before_n);
    before_n = design.max_required_n;
    EXPECT_TRUE(ids.insert(design.id).second) << design.id;
  }
}

TEST(ShippedCell, its_pallets_are_three_pins_on_one_jaw_that_squeeze_nothing) {
  const planner::Plan& plan = shipped().plan.stations[2].plan;
  EXPECT_EQ(plan.funnel.loadable, static_cast<std::int64_t>(plan.designs.size()));
  EXPECT_EQ(plan.funnel.strong, plan.funnel.loadable);
  std::set<std::string> ids;
  for (const model::Design& design : plan.designs) {
    ASSERT_EQ(design.pins.size(), 3U);
    for (const model::PinDesign& pin : design.pins) EXPECT_EQ(pin.hole.jaw, design.pins[0].hole.jaw);
    EXPECT_EQ(design.squeeze.required_n, 0);
    EXPECT_EQ(design.jaw_open_mm, design.jaw_separation_mm) << "a pallet never opens";
    EXPECT_TRUE(ids.insert(design.id).second);
    const auto& station = shipped().cell.stations[2];
    const auto set = planner::fingers_of(design, {&station.task.kit, station.task.side, station.grips},
                                         shipped().part_low_mm[2]);
    EXPECT_EQ(set.floor_z_mm, shipped().part_low_mm[2]) << "the part rests";
    EXPECT_EQ(set.plate_count, 0);
  }
}

TEST(ShippedCell, is_written_with_the_fields_that_scripts_read) {
  const json document = json::parse(to_json(shipped().plan));
  EXPECT_EQ(document["format"], "pinjaw-cell/1");
  for (const char* station : {"arm", "pedestal", "pallet"}) {
    for (const char* phase :
         {"features", "planar", "heights", "loadable", "not_wedging", "resistable", "strong"}) {
      EXPECT_TRUE(document["stations"][station][phase].is_number_integer()) << station << phase;
    }
  }
  EXPECT_EQ(document["pairs"][0]["giver"], "pallet");
  EXPECT_EQ(document["pairs"][0]["receiver"], "arm");
  EXPECT_EQ(document["pairs"][0]["count"], shipped().plan.pairs[0].count);
  EXPECT_EQ(document["triples"], shipped().plan.triples);
  const json& best = document["designs"][0];
  EXPECT_TRUE(best["id"].is_string());
  EXPECT_EQ(best["max_required_n"], shipped().plan.designs[0].max_required_n);
  EXPECT_EQ(best["stations"].size(), 3U);
  for (const json& station : best["stations"]) {
    for (const char* field : {"id", "split", "jaw_separation_mm", "jaw_open_mm", "closure_margin",
                              "part_pose", "pins", "squeeze", "adjust"}) {
      EXPECT_TRUE(station.contains(field)) << field;
    }
    for (const char* field : {"x_mm", "y_mm", "theta_deg"}) EXPECT_TRUE(station["adjust"][field].is_number());
  }
  const auto& arm = shipped().plan.designs[0].stations[0];
  EXPECT_NEAR(best["stations"]["arm"]["adjust"]["theta_deg"], arm.adjust.theta_rad * 180 / std::numbers::pi,
              1e-9);
}

/// Mistakes are told before anything is planned.
std::string refusal(const std::vector<model::Handoff>& handoffs) {
  model::Cell cell;
  cell.name = "odd";
  cell.stations.resize(3);
  for (std::size_t i = 0; i < 3; ++i) cell.stations[i].name = std::string(1, "abc"[i]);
  cell.handoffs = handoffs;
  const auto plan = make_cell_plan(cell, {});
  return plan ? "" : plan.error().message;
}

TEST(CellPlan, of_handoffs_that_are_no_tree_is_refused) {
  using ::testing::HasSubstr;
  EXPECT_THAT(refusal({{"a", "b"}}), HasSubstr("do not connect all stations"));
  EXPECT_THAT(refusal({{"a", "b"}, {"b", "c"}, {"c", "a"}}), HasSubstr("ring"));
  EXPECT_THAT(refusal({{"a", "b"}, {"b", "d"}}), HasSubstr("[b, d]"));
}

}  // namespace
}  // namespace pinjaw::cell
