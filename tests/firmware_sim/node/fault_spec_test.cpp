// Promises: SIM.
#include "firmware_sim/node/fault_spec.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pinjaw::node {
namespace {

using ::testing::HasSubstr;

TEST(FaultSpec, reads_every_fault_that_it_lists) {
  for (const char* text : {"leak=0.05", "spool_stuck", "regulator_open", "supply_lost", "sensor_a=300",
                           "sensor_b=-300", "position_stuck", "nvm_failed"}) {
    EXPECT_TRUE(parse_fault(text)) << text;
    const std::string name = std::string(text).substr(0, std::string(text).find('='));
    EXPECT_THAT(known_faults(), HasSubstr(name));
  }
}

TEST(FaultSpec, says_what_is_wrong) {
  EXPECT_THAT(parse_fault("").error(), HasSubstr("no such fault: ''; known are leak=CM3_S"));
  EXPECT_THAT(parse_fault("leek=1").error(), HasSubstr("no such fault: 'leek'"));
  EXPECT_THAT(parse_fault("leak").error(), HasSubstr("leak needs a number from 0 to 100"));
  EXPECT_THAT(parse_fault("leak=-1").error(), HasSubstr("leak needs"));
  EXPECT_THAT(parse_fault("leak=1x").error(), HasSubstr("leak needs"));
  EXPECT_THAT(parse_fault("leak=nan").error(), HasSubstr("leak needs"));
  EXPECT_THAT(parse_fault("spool_stuck=1").error(), HasSubstr("takes no value"));
}

TEST(FaultSpec, faults_add_up) {
  plant::Faults faults;
  add_fault(*parse_fault("sensor_a=300"), faults);
  add_fault(*parse_fault("spool_stuck"), faults);
  add_fault(*parse_fault("leak=0.6"), faults);
  EXPECT_EQ(faults.close_sensor_offset_pa[0], 30000);
  EXPECT_TRUE(faults.spool_stuck);
  EXPECT_DOUBLE_EQ(faults.close_leak.conductance_m3_s_pa, 1e-12);
  EXPECT_FALSE(faults.supply_lost);
}

}  // namespace
}  // namespace pinjaw::node
