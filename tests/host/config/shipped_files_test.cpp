#include <gmock/gmock.h>

#include <filesystem>
#include <map>

#include "host/config/materials.hpp"
#include "host/config/read.hpp"
#include "tests/support/places.hpp"

namespace pinjaw::config {
namespace {

const std::filesystem::path kConfigs = test::source_dir("configs");

/// Mistakes of every file in a folder of configs/, rendered; empty where all are clean.
template <class T>
std::string mistakes_in(const char* folder, Read<T> (*read)(const std::filesystem::path&), int& count) {
  std::string all;
  for (const auto& entry : std::filesystem::directory_iterator(kConfigs / folder)) {
    if (entry.path().extension() != ".yaml") continue;
    ++count;
    const Read<T> value = read(entry.path());
    if (!value) all += base::render(value.error(), "expected none");
  }
  return all;
}

TEST(ShippedFiles, every_kit_reads_clean) {
  int count = 0;
  EXPECT_EQ(mistakes_in("kits", read_kit, count), "");
  EXPECT_GE(count, 4);
}

TEST(ShippedFiles, every_profile_reads_clean) {
  int count = 0;
  EXPECT_EQ(mistakes_in("parts", read_profile, count), "");
  EXPECT_GE(count, 2);
}

TEST(ShippedFiles, every_task_reads_clean) {
  int count = 0;
  EXPECT_EQ(mistakes_in("tasks", read_task, count), "");
  EXPECT_GE(count, 8);
}

TEST(ShippedFiles, every_cell_controller_and_sequence_reads_clean) {
  int count = 0;
  EXPECT_EQ(mistakes_in("cells", read_cell, count), "");
  EXPECT_EQ(mistakes_in("controllers", read_controller, count), "");
  EXPECT_EQ(mistakes_in("sequences", read_sequence, count), "");
  EXPECT_EQ(count, 5);
}

TEST(ShippedFiles, the_materials_read_clean_and_are_built_in) {
  const auto table = read_materials(kConfigs / "materials.yaml");
  ASSERT_TRUE(table.has_value()) << base::render(table.error(), "expected none");
  EXPECT_EQ(table->density_g_cm3("aluminium-7075"), 2.81);
  EXPECT_EQ(table->static_friction("steel", "aluminium-7075"), 0.2);
  EXPECT_EQ(built_in_materials().materials.size(), table->materials.size());
  EXPECT_EQ(built_in_materials().pairs.size(), table->pairs.size());
}

TEST(ShippedFiles, the_cell_gives_every_station_its_controller) {
  const auto cell = read_cell(kConfigs / "cells" / "acc.yaml");
  ASSERT_TRUE(cell.has_value());
  for (const model::Station& station : cell->stations) {
    const auto controller = read_controller(kConfigs / "controllers" / (station.name + ".yaml"));
    ASSERT_TRUE(controller.has_value());
    EXPECT_EQ(controller->node, station.node);
    EXPECT_EQ(controller->kit.sha256, station.task.kit.sha256);
    EXPECT_EQ(controller->passive, !station.grips);
  }
}

}  // namespace
}  // namespace pinjaw::config
