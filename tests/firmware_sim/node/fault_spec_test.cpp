// Promises: SIM.
#include "firmware_sim/node/fault_spec.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>
#include <sstream>

namespace pinjaw::node {
namespace {

using ::testing::HasSubstr;

/// The listed faults, each with a value where it takes one.
std::vector<std::string> listed() {
  std::vector<std::string> names;
  std::istringstream list(known_faults());
  for (std::string name; std::getline(list >> std::ws, name, ',');) {
    const auto equals = name.find('=');
    names.push_back(equals == std::string::npos ? name : name.substr(0, equals) + "=0.5");
  }
  return names;
}

TEST(FaultSpec, reads_every_fault_that_it_lists) {
  EXPECT_GT(listed().size(), 30U);
  for (const std::string& text : listed()) EXPECT_TRUE(parse_fault(text)) << text;
}

TEST(FaultSpec, no_two_names_do_the_same) {
  std::set<std::string> seen;
  for (const std::string& text : listed()) {
    const Fault fault = *parse_fault(text);
    plant::Faults faults{};
    if (fault.add != nullptr) fault.add(fault.value, faults);
    std::string print =
        fmt::format("{} {} {} {} {} {} {}", faults.close_leak.conductance_m3_s_pa, faults.spool_stuck,
                    faults.spool_sticks_at ? static_cast<int>(*faults.spool_sticks_at) : -1,
                    static_cast<int>(faults.relax), static_cast<int>(faults.vent),
                    static_cast<int>(faults.cut), static_cast<int>(faults.regulator));
    print += fmt::format(" {} {} {}", faults.supply_lost, static_cast<int>(faults.soft_start),
                         static_cast<int>(fault.of));
    for (const plant::SensorFault* sensor : {&faults.pressure[0], &faults.pressure[1], &faults.pressure[2],
                                             &faults.pressure[3], &faults.position}) {
      print += fmt::format(" {} {} {} {}", sensor->offset, sensor->drift_per_s, sensor->stuck, sensor->lost);
    }
    EXPECT_TRUE(seen.insert(print).second) << text;
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
  for (const char* text : {"sensor_a=300", "spool_stuck", "leak=0.6", "position_drift=-2"}) {
    const Fault fault = *parse_fault(text);
    fault.add(fault.value, faults);
  }
  EXPECT_EQ(faults.pressure[0].offset, 30000);
  EXPECT_TRUE(faults.spool_stuck);
  EXPECT_DOUBLE_EQ(faults.close_leak.conductance_m3_s_pa, 1e-12);
  EXPECT_DOUBLE_EQ(faults.position.drift_per_s, -2e-3);
  EXPECT_FALSE(faults.supply_lost);
}

}  // namespace
}  // namespace pinjaw::node
