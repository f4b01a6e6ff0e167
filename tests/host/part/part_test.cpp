#include "host/part/part.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <set>
#include <sstream>

#include "tests/host/part/shipped_parts.hpp"

namespace pinjaw::part {
namespace {

/// Read back from the files with FreeCAD when they were drawn.
struct Figures {
  const char* name;
  int solids;
  int faces;
  int edges;
  double volume_mm3;
  Vector3d centroid_mm;
};

std::ostream& operator<<(std::ostream& out, const Figures& figures) {
  return out << figures.name;
}

const Figures kFigures[] = {
    {"cassette_chassis", 1, 165, 439, 22617.674, {-0.4488, 0.9807, 3.2499}},
    {"connecting_rod", 1, 44, 130, 18429.438, {44.3873, 0.0000, 8.0000}},
    {"gear", 1, 179, 513, 17794.675, {-0.0769, 0.0000, 9.2513}},
    {"glue_gun_assembly", 7, 300, 797, 131309.987, {-8.3641, 22.9863, 15.5175}},
    {"glue_gun_housing", 1, 248, 681, 87517.459, {-13.9741, 21.6807, 8.9249}},
    {"hex_flange", 1, 45, 96, 36045.008, {0.0216, 0.0215, 11.5058}},
    {"l_bracket", 1, 29, 81, 33349.008, {20.2740, 22.5000, 14.2159}},
    {"pump_cover", 1, 47, 131, 63131.421, {-0.5002, -0.4456, 8.5033}},
    {"thin_tray", 1, 63, 167, 12183.601, {-1.3371, -0.4351, 6.8594}},
    {"valve_housing", 1, 154, 408, 63794.043, {-0.8078, -0.2650, 21.7944}},
};

class ShippedPart : public testing::TestWithParam<Figures> {};

TEST_P(ShippedPart, has_the_figures_it_was_drawn_with_and_a_closed_mesh_with_normals_outwards) {
  const Figures& figures = GetParam();
  const Part* part = &shipped_part(figures.name);
  EXPECT_EQ(part->name, figures.name);
  EXPECT_EQ(static_cast<int>(part->solids.size()), figures.solids);
  EXPECT_EQ(std::ranges::max(part->surface.mesh().face_of), figures.faces);
  EXPECT_EQ(part->edge_counts.total, figures.edges);
  EXPECT_EQ(part->edge_counts.total,
            part->edge_counts.kept + part->edge_counts.seams + part->edge_counts.degenerate);
  EXPECT_EQ(static_cast<int>(part->edges.size()), part->edge_counts.kept);
  EXPECT_NEAR(part->volume_mm3, figures.volume_mm3, 0.001);
  EXPECT_LT((part->centroid_mm - figures.centroid_mm).norm(), 1e-4);
  EXPECT_NEAR(part->mass_kg, 2.81e-6 * figures.volume_mm3, 1e-7);
  EXPECT_EQ(part->mesh_deflection_mm, kMeshDeflectionMm);
  EXPECT_NEAR(enclosed_mm3(part->surface.mesh()), part->volume_mm3, 2e-4 * part->volume_mm3);
}

std::string name_of_figures(const testing::TestParamInfo<Figures>& info) {
  return info.param.name;
}
INSTANTIATE_TEST_SUITE_P(Parts, ShippedPart, testing::ValuesIn(kFigures), name_of_figures);

TEST(Part, tells_the_bytes_it_was_read_from) {
  const Part* part = &shipped_part("l_bracket");
  EXPECT_EQ(part->sha256, "c5e9fe3301eed5d78ee211e5dbabb2f3daf4f24e07c28a794f2699a7fe528c02");
}

TEST(Part, takes_a_stated_mass_as_it_is) {
  model::PartSource source = source_of(shipped("l_bracket"));
  source.density_g_cm3.reset();
  source.mass_kg = 0.25;
  EXPECT_EQ(read_part(source)->mass_kg, 0.25);
}

TEST(Part, names_the_solids_of_an_assembly) {
  const Part* part = &shipped_part("glue_gun_assembly");
  std::vector<std::string> names;
  for (const Solid& solid : part->solids) names.push_back(solid.name);
  EXPECT_THAT(names, testing::ElementsAre("housing", "nozzle", "heater", "trigger", "stick_carriage",
                                          "glue_stick", "cord_grommet"));
  EXPECT_NEAR(part->solids[1].volume_mm3, 4845.59, 0.01);
}

TEST(Part, is_the_base_solid_of_an_assembly_or_all_the_others) {
  const model::PartSource source = source_of(shipped("glue_gun_assembly"));
  const Part* whole = &shipped_part("glue_gun_assembly");
  const auto base = read_part(source, {.base = "Housing"});
  const auto rest = read_part(source, {.base = "housing", .rest = true});
  ASSERT_TRUE(whole && base && rest);
  EXPECT_EQ(base->name, "Housing");
  EXPECT_EQ(base->solids.size(), 7U);
  EXPECT_NEAR(base->volume_mm3, 87517.46, 0.01);
  EXPECT_NEAR(rest->volume_mm3, whole->volume_mm3 - base->volume_mm3, 1e-3);
}

TEST(Part, says_which_solids_there_are_when_the_base_is_none_of_them) {
  const auto part = read_part(source_of(shipped("glue_gun_assembly")), {.base = "barrel"});
  ASSERT_FALSE(part);
  EXPECT_THAT(part.error().message,
              testing::HasSubstr("no solid is named \"barrel\"; it holds \"housing\", \"nozzle\""));
}

TEST(Part, drops_seams_and_keeps_every_other_edge_of_a_cylinder) {
  const Part* part = &shipped_part("valve_housing");
  EXPECT_EQ(part->edge_counts,
            (EdgeCounts{.total = 408, .kept = 377, .seams = 31, .degenerate = 0, .freeform = 9}));
}

TEST(Part, knows_which_faces_an_edge_lies_between) {
  const Part* part = &shipped_part("l_bracket");
  for (const EdgeCurve& edge : part->edges) EXPECT_EQ(edge.faces.size(), 2U) << edge.edge;
}

TEST(Part, has_its_upright_planes_and_cylinders_as_walls) {
  const Part* part = &shipped_part("valve_housing");
  const auto round = std::ranges::count_if(
      part->walls, [](const Wall& wall) { return std::holds_alternative<geometry::Arc>(wall.curve); });
  EXPECT_GT(round, 20);
  EXPECT_GT(static_cast<long>(part->walls.size()) - round, 20);
  for (const Wall& wall : part->walls) EXPECT_GT(wall.z_mm.length(), 0) << wall.face;
}

TEST(Part, comes_in_millimetres_whatever_unit_its_file_is_in) {
  std::ifstream in(shipped("l_bracket"));
  std::stringstream text;
  text << in.rdbuf();
  std::string centimetres = text.str();
  const std::string milli = "SI_UNIT(.MILLI.,.METRE.)";
  centimetres.replace(centimetres.find(milli), milli.size(), "SI_UNIT(.CENTI.,.METRE.)");
  const auto file = std::filesystem::path(testing::TempDir()) / "l_bracket_cm.step";
  std::ofstream(file) << centimetres;
  const auto part = read_part(source_of(file));
  ASSERT_TRUE(part) << part.error().message;
  EXPECT_NEAR(part->volume_mm3, 33349.008e3, 1);
}

}  // namespace
}  // namespace pinjaw::part
