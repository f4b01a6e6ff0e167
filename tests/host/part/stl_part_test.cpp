#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "tests/host/geometry/solids.hpp"
#include "tests/host/part/shipped_parts.hpp"
#include "tests/host/part/stl_bytes.hpp"

namespace pinjaw::part {
namespace {

using testing::HasSubstr;

std::filesystem::path written(const std::string& name, const std::string& bytes) {
  const auto file = std::filesystem::path(testing::TempDir()) / name;
  std::ofstream(file, std::ios::binary) << bytes;
  return file;
}

geometry::TriangleMesh plate() {
  return geometry::testing::block({{0, 0, 0}, {40, 20, 5}});
}

geometry::TriangleMesh open_plate() {
  auto mesh = plate();
  mesh.triangles.pop_back();
  return mesh;
}

TEST(StlPart, has_the_figures_of_its_step_file_within_what_its_chords_cut_off) {
  const auto part = read_part(source_of(test::source_dir("configs/parts/l_bracket.stl")));
  ASSERT_TRUE(part) << part.error().message;
  const Part& step = shipped_part("l_bracket");
  EXPECT_EQ(part->name, "l_bracket");
  ASSERT_TRUE(part->mesh_counts);
  EXPECT_EQ(*part->mesh_counts, (MeshCounts{.facets = 1352, .shells = 1}));
  EXPECT_NEAR(part->volume_mm3, step.volume_mm3, 1e-3 * step.volume_mm3);
  EXPECT_NEAR(part->mass_kg, step.mass_kg, 1e-3 * step.mass_kg);
  EXPECT_LT((part->centroid_mm - step.centroid_mm).norm(), 0.02);
  EXPECT_TRUE(part->edges.empty() && part->walls.empty());
  EXPECT_FALSE(part->contours.empty());
  EXPECT_LT(part->mesh_deflection_mm, 0.05);
  EXPECT_EQ(part->sha256.size(), 64U);
}

TEST(StlPart, stands_as_its_source_says) {
  auto source = source_of(written("plate.stl", binary_stl(plate())));
  source.up = Vector3d::UnitX();
  const auto part = read_part(source);
  ASSERT_TRUE(part) << part.error().message;
  EXPECT_NEAR(part->surface.z_range_mm().hi, 40, 1e-9);
  EXPECT_NEAR(part->centroid_mm.z(), 20, 1e-9);
}

TEST(StlPart, seen_from_above_is_mirrored_with_its_contours) {
  const auto part = read_part(source_of(written("plate.stl", binary_stl(plate()))));
  ASSERT_TRUE(part);
  const Part above = turned(*part, model::Side::Above);
  for (const Contour& contour : above.contours) {
    EXPECT_LE(geometry::point_at(contour.curve, 0).x(), 0);
    for (const Vector3d& p : contour.trace_mm) EXPECT_LE(p.z(), 0);
  }
}

TEST(StlPart, with_open_edges_needs_a_stated_mass) {
  auto source = source_of(written("open.stl", binary_stl(open_plate())));
  const auto weighed = read_part(source);
  ASSERT_FALSE(weighed);
  EXPECT_THAT(
      weighed.error().message,
      HasSubstr(
          "open.stl: its mesh has 3 open edges, so no material can tell its mass; state mass_kg instead"));
  source.density_g_cm3.reset();
  source.mass_kg = 0.1;
  const auto stated = read_part(source);
  ASSERT_TRUE(stated);
  EXPECT_EQ(stated->mass_kg, 0.1);
  EXPECT_EQ(stated->volume_mm3, 0);
  EXPECT_EQ(stated->mesh_counts->open_edges, 3);
}

TEST(StlPart, is_the_named_solid_of_an_ascii_file_or_all_the_others) {
  const std::string text = ascii_stl(plate(), "base plate") +
                           ascii_stl(geometry::testing::block({{10, 10, 5}, {20, 18, 9}}), "block");
  const auto source = source_of(written("pair.stl", text));
  const auto base = read_part(source, {.base = "Base Plate"});
  const auto rest = read_part(source, {.base = "base plate", .rest = true});
  ASSERT_TRUE(base && rest);
  EXPECT_NEAR(base->volume_mm3, 4000, 1e-9);
  EXPECT_NEAR(rest->volume_mm3, 320, 1e-9);
  EXPECT_EQ(base->solids.size(), 2U);
  const auto none = read_part(source, {.base = "lid"});
  ASSERT_FALSE(none);
  EXPECT_THAT(none.error().message,
              HasSubstr("no solid is named \"lid\"; it holds \"base plate\", \"block\""));
}

TEST(StlPart, names_its_file_in_every_refusal) {
  EXPECT_THAT(read_part(source_of(written("broken.stl", "solid x\nfacet"))).error().message,
              HasSubstr("broken.stl:2:6: the STL file is cut short: expected normal"));
}

}  // namespace
}  // namespace pinjaw::part
