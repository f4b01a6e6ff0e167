#include "host/planner/plan/exact.hpp"

#include <gmock/gmock.h>

#include <STEPControl_Writer.hxx>
#include <TopoDS_Shape.hxx>
#include <cmath>
#include <fstream>
#include <functional>

#include "host/planner/features/projection.hpp"
#include "host/planner/plan/plan_json.hpp"
#include "tests/host/planner/features/brep_part.hpp"
#include "tests/host/planner/plan/planned.hpp"

namespace pinjaw::planner {
namespace {

using testing::Contains;
using testing::HasSubstr;

std::vector<std::string> failures(const std::vector<Claim>& claims) {
  std::vector<std::string> failed;
  for (const Claim& claim : claims) {
    if (!claim.holds) failed.push_back(claim.claim + ": " + claim.found);
  }
  return failed;
}

ExactReport report_of(const Plan& plan, const Scene& scene,
                      const std::vector<const model::Design*>& designs) {
  const auto report = recheck_exactly(plan, scene, designs);
  if (!report) throw std::runtime_error(report.error().message);
  return *report;
}

/// The first designs of a plan, or one with a lie in it.
ExactReport report_of(const Planned& of, std::size_t count) {
  std::vector<const model::Design*> designs;
  for (std::size_t i = 0; i < std::min(count, of.plan.designs.size()); ++i)
    designs.push_back(&of.plan.designs[i]);
  return report_of(of.plan, of.scene, designs);
}
std::vector<std::string> failures_of(const Planned& of, const model::Design& design) {
  return failures(report_of(of.plan, of.scene, {&design}).designs.front().claims);
}

/// A shape written to a STEP file, planned with the pedestal kit.
Planned plan_of_shape(const std::string& name, const part::Shape& shape) {
  const std::string file = testing::TempDir() + name + ".step";
  STEPControl_Writer writer;
  writer.Transfer(*shape, STEPControl_AsIs);
  writer.Write(file.c_str());
  model::Task task = valve_pedestal().task;
  task.name = name;
  task.part.file = file;
  task.always.clear();
  task.disturbances = {model::PlainWrench{"push", {0, 0, -5}, {0, 0, 0}}};
  auto scene = read_scene(task);
  if (!scene) throw std::runtime_error(scene.error().message);
  auto plan = make_plan(task, *scene, {.top = 5});
  if (!plan) throw std::runtime_error(plan.error().message);
  return {std::move(task), std::move(*scene), std::move(*plan)};
}

/// A block under a wider plate: pins stand under its overhang.
const Planned& overhang() {
  static const Planned kPlanned =
      plan_of_shape("overhang", boxes({{{-20, -15, 0}, {20, 15, 8}}, {{-30, -25, 8}, {30, 25, 14}}}));
  return kPlanned;
}

constexpr double kFilletMm = 5;

const Planned& rounded() {
  static const Planned kPlanned =
      plan_of_shape("rounded", filleted_box({{-20, -15, 0}, {20, 15, 12}}, kFilletMm));
  return kPlanned;
}

TEST(Recheck, finds_the_valve_housings_best_designs_true_on_its_exact_faces) {
  const ExactReport report = report_of(valve_pedestal(), 4);
  ASSERT_EQ(report.designs.size(), 4U);
  EXPECT_TRUE(report.without_faces.empty());
  for (const ExactDesign& design : report.designs) {
    EXPECT_EQ(failures(design.claims), std::vector<std::string>{});
    EXPECT_LE(design.summary.contact_gap_mm, report.tolerance_mm);
    EXPECT_GT(design.summary.least_clearance_mm, 0);
    EXPECT_EQ(design.figures.size(), 12U);
  }
}

TEST(Recheck, finds_triangles_of_flat_faces_exact) {
  const Planned& of = overhang();
  ASSERT_FALSE(of.plan.designs.empty());
  const ExactReport report = report_of(of, 2);
  for (const ExactDesign& design : report.designs) {
    EXPECT_EQ(failures(design.claims), std::vector<std::string>{});
    EXPECT_LT(design.summary.largest_difference_mm, 2e-4);
    EXPECT_NEAR(design.summary.least_clearance_mm, of.plan.kit.jaws.plate_gap_mm, 1e-5)
        << "the plates under the block";
  }
}

struct Lie {
  const char* claim;  ///< that must fail
  std::function<void(model::Design&)> tell;
};

TEST(Recheck, catches_pins_that_are_not_where_the_exact_faces_let_them) {
  const Planned& of = overhang();
  const model::Vector2d towards = of.plan.designs.front().pins[0].normal;
  const std::vector<Lie> lies = {
      {"has its clearance above", [](auto& d) { d.pins[1].top_z_mm += 0.5; }},
      {"does not cut the part", [](auto& d) { d.pins[1].top_z_mm += 0.5; }},
      {"does not cut the part", [&](auto& d) { d.part_pose.t_mm -= 0.1 * towards; }},
      {"closes without cutting the part", [&](auto& d) { d.part_pose.t_mm -= 0.1 * towards; }},
      {"touches the part", [&](auto& d) { d.part_pose.t_mm += 0.1 * towards; }},
      {"touches at its stated contact", [&](auto& d) { d.pins[0].contact_mm -= 0.1 * towards; }},
      {"engages", [&](auto& d) { d.pins[2].top_z_mm = of.plan.kit.pins.min_engagement_mm - 0.1; }},
  };
  for (const Lie& lie : lies) {
    model::Design design = of.plan.designs.front();
    lie.tell(design);
    EXPECT_THAT(failures_of(of, design), Contains(HasSubstr(lie.claim))) << lie.claim;
  }
}

TEST(Recheck, tells_by_how_much_a_pin_cuts_or_misses) {
  const Planned& of = overhang();
  const model::Vector2d towards = of.plan.designs.front().pins[0].normal;
  model::Design design = of.plan.designs.front();
  design.part_pose.t_mm += 0.1 * towards;
  const ExactReport report = report_of(of.plan, of.scene, {&design});
  EXPECT_NEAR(report.designs.front().figures.front().brep_mm, 0.1, 1e-3);
}

TEST(Recheck, catches_a_jaw_body_that_stands_in_the_part) {
  const Planned& of = overhang();
  Plan plan = of.plan;
  plan.kit.jaws.bodies.push_back({{-5, 0}, {-5, 5}, {0, 20}});
  const auto failed = failures(report_of(plan, of.scene, {&plan.designs.front()}).designs.front().claims);
  EXPECT_THAT(failed, Contains(HasSubstr("jaw keeps clear of the part")));
}

TEST(Recheck, tells_the_chord_error_of_curved_faces_within_its_bounds) {
  const Planned& of = rounded();
  ASSERT_FALSE(of.plan.designs.empty());
  const ExactReport report = report_of(of, 3);
  const double chord_mm = of.scene.part.mesh_deflection_mm;
  double largest_mm = 0;
  for (const ExactDesign& design : report.designs) {
    EXPECT_EQ(failures(design.claims), std::vector<std::string>{});
    largest_mm = std::max(largest_mm, design.summary.largest_difference_mm);
    for (const ExactFigure& figure : design.figures) {
      const bool gap = figure.what.find("gap") != std::string::npos;
      // next to an upright tangent a chord error is many times as large in height
      const double bound_mm = gap ? chord_mm + kFitMm : chord_mm + std::sqrt(2 * kFilletMm * chord_mm);
      EXPECT_LE(figure.difference_mm(), bound_mm) << figure.what;
    }
  }
  EXPECT_GT(largest_mm, 1e-3) << "a mesh of a fillet is not exact";
}

TEST(Recheck, finds_obstacles_on_the_way) {
  Planned of = overhang();
  of.task.obstacles.push_back({test::source_dir("tests/host/planner/why/ring.yaml"), {}, -1});
  auto scene = read_scene(of.task);
  ASSERT_TRUE(scene) << scene.error().message;
  const auto failed = failures(report_of(of.plan, *scene, {&of.plan.designs.front()}).designs.front().claims);
  EXPECT_THAT(failed, Contains(HasSubstr("keeps clear of ring.yaml")));
}

TEST(Recheck, of_a_mesh_says_that_there_is_nothing_exact) {
  const Planned mesh = plan_of("l-bracket-stl", {.top = 2});
  const ExactReport report = report_of(mesh, 2);
  EXPECT_TRUE(report.designs.empty());
  EXPECT_THAT(report.without_faces, Contains(HasSubstr("l_bracket.stl")));
  Plan plan = mesh.plan;
  EXPECT_FALSE(tell_exactly(plan, mesh.scene, 1).has_value());
}

TEST(Recheck, asks_the_prism_of_a_profile_and_a_grip_from_above) {
  EXPECT_EQ(failures(report_of(cam(), 1).designs.front().claims), std::vector<std::string>{});
  const Planned arm = plan_of("valve-arm", {.top = 1});
  EXPECT_EQ(failures(report_of(arm, 1).designs.front().claims), std::vector<std::string>{});
}

TEST(Recheck, told_in_a_plan_comes_back_from_its_file_and_lies_about_it_are_caught) {
  Planned of = overhang();
  ASSERT_TRUE(tell_exactly(of.plan, of.scene, 1).has_value());
  ASSERT_TRUE(of.plan.designs.front().exact.has_value());
  EXPECT_FALSE(of.plan.designs.back().exact.has_value());
  const auto file = std::filesystem::path(testing::TempDir()) / "exact.json";
  std::ofstream(file) << to_json(of.plan);
  const auto read = read_plan(file);
  ASSERT_TRUE(read.has_value());
  EXPECT_EQ(to_json(*read), to_json(of.plan));
  EXPECT_EQ(failures_of(of, of.plan.designs.front()), std::vector<std::string>{});
  const std::vector<Lie> lies = {
      {"largest difference", [](auto& d) { d.exact->largest_difference_mm += 0.01; }},
      {"gap of a contact", [](auto& d) { d.exact->contact_gap_mm += 0.01; }},
      {"least clearance", [](auto& d) { d.exact->least_clearance_mm += 0.01; }},
  };
  for (const Lie& lie : lies) {
    model::Design design = of.plan.designs.front();
    lie.tell(design);
    EXPECT_THAT(failures_of(of, design), Contains(HasSubstr(lie.claim)));
  }
}

}  // namespace
}  // namespace pinjaw::planner
