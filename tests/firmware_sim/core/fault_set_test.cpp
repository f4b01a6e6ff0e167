// Promises: TELEMETRY.
#include <gtest/gtest.h>

#include <map>

#include "firmware_sim/core/faults.hpp"

namespace pinjaw::core::test {
namespace {

using wire::FaultCode;
using wire::Severity;

const std::map<FaultCode, Severity>& severities() {
  using enum FaultCode;
  static const std::map<FaultCode, Severity> table = {{None, Severity::Info},
                                                      {HandoffAborted, Severity::Info},
                                                      {LayoutRefused, Severity::Info},
                                                      {BusOffRecovered, Severity::Info},
                                                      {SupplyVoltage, Severity::Warning},
                                                      {SupplyAirLow, Severity::Warning},
                                                      {Leak, Severity::Warning},
                                                      {ReceiveOverrun, Severity::Warning},
                                                      {BusPassive, Severity::Warning},
                                                      {HostLost, Severity::Warning},
                                                      {PeerLost, Severity::Warning},
                                                      {OwnIdSeen, Severity::Warning},
                                                      {BadChecksum, Severity::Warning},
                                                      {BadSequence, Severity::Warning},
                                                      {BadSession, Severity::Warning},
                                                      {InDoubt, Severity::Warning},
                                                      {Authentication, Severity::Warning},
                                                      {ManualRelease, Severity::Warning},
                                                      {CustodyMemory, Severity::Latched},
                                                      {MemorySelfTest, Severity::Latched},
                                                      {Watchdog, Severity::Latched},
                                                      {PressureRange, Severity::Hold},
                                                      {SensorsDisagree, Severity::Hold},
                                                      {ValveStuck, Severity::Hold},
                                                      {Position, Severity::Hold},
                                                      {OverForce, Severity::Hold},
                                                      {HoldLost, Severity::Hold},
                                                      {Slip, Severity::Hold},
                                                      {NoPart, Severity::Hold},
                                                      {MisSeated, Severity::Hold},
                                                      {BusOff, Severity::Hold}};
  return table;
}

TEST(Faults, are_as_bad_as_the_specification_says) {
  EXPECT_EQ(severities().size(), wire::kFaultCodes.size());
  for (const FaultCode code : wire::kFaultCodes) {
    EXPECT_EQ(severity_of(code), severities().at(code)) << static_cast<int>(code);
    Faults faults;
    faults.raise(code);
    EXPECT_EQ(faults.must_hold(), severities().at(code) >= Severity::Hold) << static_cast<int>(code);
    EXPECT_EQ(faults.worst(), code);
    EXPECT_EQ(faults.active(code), code != FaultCode::None);
  }
}

TEST(Faults, are_set_once_and_reported_once) {
  Faults faults;
  EXPECT_EQ(faults.worst(), FaultCode::None);
  EXPECT_EQ(faults.take_report(), FaultCode::None);
  EXPECT_TRUE(faults.raise(FaultCode::Slip));
  EXPECT_FALSE(faults.raise(FaultCode::Slip));
  EXPECT_EQ(faults.take_report(), FaultCode::Slip);
  EXPECT_EQ(faults.take_report(), FaultCode::None);
  faults.raise(FaultCode::Slip);
  EXPECT_EQ(faults.take_report(), FaultCode::None) << "it is no news";
  faults.report_all_again();
  EXPECT_EQ(faults.take_report(), FaultCode::Slip);
  EXPECT_EQ(faults.take_report(), FaultCode::None);
}

TEST(Faults, that_go_are_reported_once_more) {
  Faults faults;
  faults.clear(FaultCode::Leak);
  EXPECT_EQ(faults.take_report(), FaultCode::None) << "it was not there";
  faults.raise(FaultCode::Leak);
  faults.raise(FaultCode::Slip);
  faults.take_report();
  faults.take_report();
  faults.clear(FaultCode::Leak);
  EXPECT_FALSE(faults.active(FaultCode::Leak));
  EXPECT_TRUE(faults.active(FaultCode::Slip));
  EXPECT_EQ(faults.take_report(), FaultCode::Leak);
  EXPECT_EQ(faults.take_report(), FaultCode::None);
  faults.clear_all();
  EXPECT_EQ(faults.worst(), FaultCode::None);
  EXPECT_EQ(faults.take_report(), FaultCode::Slip);
  EXPECT_EQ(faults.take_report(), FaultCode::None);
}

TEST(Faults, that_are_only_noted_are_reported_and_not_active) {
  Faults faults;
  faults.note(FaultCode::HandoffAborted);
  faults.note(FaultCode::None);
  EXPECT_EQ(faults.worst(), FaultCode::None);
  EXPECT_EQ(faults.take_report(), FaultCode::HandoffAborted);
  EXPECT_EQ(faults.take_report(), FaultCode::None);
}

TEST(Faults, name_the_worst_first_come_among_equals) {
  Faults faults;
  faults.raise(FaultCode::HostLost);
  EXPECT_EQ(faults.worst(), FaultCode::HostLost);
  faults.raise(FaultCode::SupplyAirLow);
  EXPECT_EQ(faults.worst(), FaultCode::SupplyAirLow) << "the lower index";
  faults.raise(FaultCode::Slip);
  EXPECT_EQ(faults.worst(), FaultCode::Slip);
  faults.raise(FaultCode::Position);
  EXPECT_EQ(faults.worst(), FaultCode::Position);
  faults.raise(FaultCode::CustodyMemory);
  EXPECT_EQ(faults.worst(), FaultCode::CustodyMemory);
}

TEST(Faults, are_all_told_apart) {
  for (const FaultCode one : wire::kFaultCodes) {
    Faults faults;
    faults.raise(one);
    for (const FaultCode other : wire::kFaultCodes) {
      EXPECT_EQ(faults.active(other), one == other && one != FaultCode::None);
    }
  }
}

}  // namespace
}  // namespace pinjaw::core::test
