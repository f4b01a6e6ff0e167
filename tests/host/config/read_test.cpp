#include "host/config/read.hpp"

#include <gmock/gmock.h>
#include <unistd.h>

#include <cmath>
#include <fstream>
#include <numbers>

#include "host/base/sha256.hpp"
#include "tests/support/places.hpp"

namespace pinjaw::config {
namespace {

namespace fs = std::filesystem;
using testing::DoubleNear;

/// A folder with the files of one test, removed at the end.
class ReadFiles : public testing::Test {
 protected:
  ReadFiles() : folder_(fs::temp_directory_path() / ("pinjaw-read-" + std::to_string(::getpid()))) {
    fs::create_directories(folder_);
  }
  ~ReadFiles() override { fs::remove_all(folder_); }
  fs::path write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
    return folder_ / name;
  }
  fs::path folder_;
};

template <class T>
const T& value_of(const Read<T>& read) {
  if (!read) ADD_FAILURE() << base::render(read.error(), "expected none");
  return *read;
}

const std::string kKit = R"({"kit": "json-kit",
 "grid": {"spacing_mm": 11, "columns": 3, "rows": 4, "edge_offset_mm": 5.5},
 "pins": {"radius_mm": 2.4, "lengths_mm": [30, 10, 20.5], "min_engagement_mm": 1.0, "protrusion_mm": 1.0},
 "jaws": {
  "separation_mm": [
   0,
   60
  ],
  "plate_gap_mm": 2.0
 },
 "actuator": {"max_squeeze_n": 140}})";

TEST_F(ReadFiles, a_kit_in_json_has_its_defaults) {
  const auto read = read_kit(write("kit.yaml", kKit));
  const model::Kit& kit = value_of(read);
  EXPECT_EQ(kit.name, "json-kit");
  EXPECT_EQ(kit.sha256, base::sha256(kKit));
  EXPECT_EQ(kit.grid.columns, 3);
  EXPECT_THAT(kit.pins.lengths_mm, testing::ElementsAre(10, 20.5, 30));
  EXPECT_EQ(kit.pins.clearance_mm, 0.2);
  EXPECT_EQ(kit.jaws.separation_mm, (geometry::Interval{0, 60}));
  EXPECT_FALSE(kit.jaws.opening_mm.has_value());
  EXPECT_EQ(kit.jaws.plate_thickness_mm, 10);
  EXPECT_EQ(kit.actuator.usable_squeeze_n(), 140);
  EXPECT_EQ(kit.grip.light_n, 12);
}

TEST_F(ReadFiles, arcs_are_stored_counter_clockwise_and_remember_their_direction) {
  const auto read = read_profile(write("p.yaml", R"(
profile: tongue
thickness_mm: 20
loops:
  - edges:
    - line: [[0, 0], [30, 0]]
    - arc: {center: [30, 14], radius: 14, from_deg: -90, to_deg: 90}
      graspable: false
    - line: [[30, 28], [26, 28]]
    - arc: {center: [17, 30], radius: 9.219544457292887, from_deg: -12.528807709151511, to_deg: -167.47119229084848}
    - line: [[8, 28], [-3, 24]]
    - line: [[-3, 24], [0, 0]]
)"));
  const model::Profile& profile = value_of(read);
  ASSERT_EQ(profile.loops.size(), 1U);
  const auto& edges = profile.loops[0];
  ASSERT_EQ(edges.size(), 6U);
  const auto& outward = std::get<geometry::Arc>(edges[1].curve);
  EXPECT_FALSE(edges[1].reversed);
  EXPECT_FALSE(edges[1].graspable);
  EXPECT_THAT(outward.sweep_rad, DoubleNear(std::numbers::pi, 1e-12));
  const auto& inward = std::get<geometry::Arc>(edges[3].curve);
  EXPECT_TRUE(edges[3].reversed);
  EXPECT_TRUE(edges[3].graspable);
  EXPECT_THAT(inward.from_rad, DoubleNear(-167.47119229084848 * std::numbers::pi / 180, 1e-12));
  EXPECT_THAT(inward.sweep_rad,
              DoubleNear((167.47119229084848 - 12.528807709151511) * std::numbers::pi / 180, 1e-12));
}

TEST_F(ReadFiles, a_task_takes_files_beside_it_and_names_its_disturbances) {
  write("kit.yaml", kKit);
  write("part.yaml", "profile: p\nthickness_mm: 5\nloops: [{polygon: [[0, 0], [9, 0], [0, 9]]}]\n");
  write("materials.yaml",
        "materials: {oak: {density_g_cm3: 0.7}, tin: {density_g_cm3: 7.3}}\nfriction: [{pair: [tin, oak], "
        "static: 0.4}]\n");
  const auto read = read_task(write("task.yaml", R"(
task: t
part: {file: part.yaml, up: [0, 0, -2], material: oak}
kit: kit.yaml
side: above
friction: {table: materials.yaml, pins: tin}
always: [{gravity: [0, 0, -1]}]
disturbances:
  - spray: {nozzle_mm: 1.2, flow_l_s: 0.07, count: 5, from: [0, 0, 1], within_deg: 60}
  - spray: {force_n: 2, count: 7, seed: 9}
  - force: {name: spray-2, at_mm: [3, 0, 20], force_n: [0, 0, -15]}
  - acceleration: {peak_g: 6, along: [[0, 0, 2]]}
)"));
  const model::Task& task = value_of(read);
  EXPECT_EQ(task.part.density_g_cm3, 0.7);
  EXPECT_EQ(task.part.up, -Eigen::Vector3d::UnitZ());
  ASSERT_TRUE(task.part.profile.has_value());
  EXPECT_EQ(task.part.profile->thickness_mm, 5);
  EXPECT_EQ(task.side, model::Side::Above);
  EXPECT_EQ(task.friction, 0.4);
  EXPECT_EQ(task.kit.name, "json-kit");
  std::vector<std::string> names;
  for (const auto& source : task.disturbances) {
    names.push_back(std::visit([](const auto& each) { return each.name; }, source));
  }
  EXPECT_THAT(names, testing::ElementsAre("spray", "spray-3", "spray-2", "acceleration"));
  const auto& spray = std::get<model::Spray>(task.disturbances[0]);
  EXPECT_THAT(spray.force_n, DoubleNear(8.67, 0.01));  // 2 rho Q^2 / A; the paper rounds to 8.4 on the way
  EXPECT_THAT(spray.within_rad.value(), DoubleNear(std::numbers::pi / 3, 1e-12));
  EXPECT_EQ(std::get<model::Spray>(task.disturbances[1]).seed, 9U);
}

TEST_F(ReadFiles, faults_of_a_sequence_become_shares_and_step_numbers) {
  const std::string cell = test::source_dir("configs/cells/acc.yaml");
  const auto read = read_sequence(write("s.yaml", "sequence: s\ncell: " + cell + R"(
steps:
  - place: {on: pallet}
  - handoff: {from: pallet, to: arm}
  - rotate: {station: arm, deg: -180, seconds: 2, peak_g: 6}
  - wait: {seconds: 1}
faults: [{at: step 4, kill: host}, {at_s: 2.5, drop: 20 %, seconds: 1}, {at_s: 0, drop: 5%, seconds: 2}]
)"));
  const model::Sequence& sequence = value_of(read);
  EXPECT_EQ(sequence.steps.size(), 4U);
  EXPECT_THAT(std::get<model::RotateStep>(sequence.steps[2]).angle_rad, DoubleNear(-std::numbers::pi, 1e-12));
  ASSERT_EQ(sequence.faults.size(), 3U);
  EXPECT_EQ(sequence.faults[0].at_step, 4);
  EXPECT_TRUE(sequence.faults[0].kill_host);
  EXPECT_THAT(sequence.faults[1].drop_share, DoubleNear(0.2, 1e-12));
  EXPECT_EQ(sequence.faults[1].at_s, 2.5);
  EXPECT_THAT(sequence.faults[2].drop_share, DoubleNear(0.05, 1e-12));
}

}  // namespace
}  // namespace pinjaw::config
