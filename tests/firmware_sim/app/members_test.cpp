// Promises: SIM.
#include "firmware_sim/app/members.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/firmware_sim/app/arm_files.hpp"

namespace pinjaw::jaw_app {
namespace {

using ::testing::HasSubstr;

TEST(Members, a_controller_s_file_gives_its_figures) {
  const ArmFiles files;
  const auto members = read_members({files.controller("arm", 1), files.controller("pedestal", 2)});
  ASSERT_TRUE(members) << base::render(members.error(), "");
  ASSERT_EQ(members->size(), 2U);
  EXPECT_EQ(members->at(1).node, 2);
  EXPECT_EQ(members->at(1).max_squeeze_n, 140);
  EXPECT_EQ(members->at(1).force_uncertainty_n, 12);
  EXPECT_EQ(members->at(1).separation_min_mm, 5);
  EXPECT_EQ(members->at(1).separation_max_mm, 60);
  EXPECT_NE(members->at(1).kit_id, 0);
}

TEST(Members, all_mistakes_of_all_files_are_told) {
  const ArmFiles files;
  const auto members = read_members({files.controller("arm", 1), files.controller("twin", 1),
                                     files.write("bad.yaml", "controller: x\n"), files.path("missing.yaml")});
  ASSERT_FALSE(members);
  const std::string text = base::render(members.error(), "nothing was simulated");
  EXPECT_THAT(text, HasSubstr("arm.yaml is node 1 too"));
  EXPECT_THAT(text, HasSubstr("bad.yaml"));
  EXPECT_THAT(text, HasSubstr("missing.yaml"));
  EXPECT_THAT(text, HasSubstr("nothing was simulated"));
}

}  // namespace
}  // namespace pinjaw::jaw_app
