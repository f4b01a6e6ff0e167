// Promises: SIM.
#include "firmware_sim/app/members.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>

namespace pinjaw::jaw_app {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

class Members : public ::testing::Test {
 protected:
  Members() : folder_(fs::path(testing::TempDir()) / ("pinjaw-members-" + std::to_string(getpid()))) {
    fs::create_directories(folder_);
    write("kit.yaml",
          "kit: test\n"
          "grid: {spacing_mm: 11.1125, columns: 2, rows: 9, edge_offset_mm: 5.55625}\n"
          "pins: {radius_mm: 2.38125, lengths_mm: any, min_engagement_mm: 1.0, protrusion_mm: 1.0}\n"
          "jaws: {separation_mm: [5, 60], plate_gap_mm: 2.0}\n"
          "actuator: {max_squeeze_n: 140, force_uncertainty_n: 12}\n");
  }
  ~Members() override { fs::remove_all(folder_); }

  fs::path write(const std::string& name, const std::string& text) {
    std::ofstream(folder_ / name) << text;
    return folder_ / name;
  }

  fs::path controller(const std::string& name, int node) {
    return write(name + ".yaml", "controller: " + name + "\nnode: " + std::to_string(node) +
                                     "\nkit: kit.yaml\npassive: false\n"
                                     "hardware: {max_squeeze_n: 140, force_uncertainty_n: 12}\nplant: {}\n");
  }

  fs::path folder_;
};

TEST_F(Members, a_controller_s_file_gives_its_figures) {
  const auto members = read_members({controller("arm", 1), controller("pedestal", 2)});
  ASSERT_TRUE(members) << base::render(members.error(), "");
  ASSERT_EQ(members->size(), 2U);
  EXPECT_EQ(members->at(1).node, 2);
  EXPECT_EQ(members->at(1).max_squeeze_n, 140);
  EXPECT_EQ(members->at(1).force_uncertainty_n, 12);
  EXPECT_EQ(members->at(1).separation_min_mm, 5);
  EXPECT_EQ(members->at(1).separation_max_mm, 60);
  EXPECT_NE(members->at(1).kit_id, 0);
}

TEST_F(Members, all_mistakes_of_all_files_are_told) {
  const auto members = read_members({controller("arm", 1), controller("twin", 1),
                                     write("bad.yaml", "controller: x\n"), folder_ / "missing.yaml"});
  ASSERT_FALSE(members);
  const std::string text = base::render(members.error(), "nothing was simulated");
  EXPECT_THAT(text, HasSubstr("arm.yaml is node 1 too"));
  EXPECT_THAT(text, HasSubstr("bad.yaml"));
  EXPECT_THAT(text, HasSubstr("missing.yaml"));
  EXPECT_THAT(text, HasSubstr("nothing was simulated"));
}

}  // namespace
}  // namespace pinjaw::jaw_app
