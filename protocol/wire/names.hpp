#pragma once

#include "protocol/wire/codes.hpp"
#include "protocol/wire/spec.hpp"

/// The text of every number that has a name, as it appears in the DBC.
namespace pinjaw::wire {

inline constexpr ValueName kStateNames[] = {
    {0, "BOOT"},       {1, "RECOVER"},  {2, "UNCONF"},      {3, "LOADED"},
    {4, "READY"},      {5, "SEATING"},  {6, "SEATED"},      {7, "SQUEEZING"},
    {8, "TAKEN"},      {9, "HOLD"},     {10, "OFFERED"},    {11, "RELAX"},
    {12, "RESQUEEZE"}, {13, "OPENING"}, {14, "FAULT_HOLD"}, {15, "FAULT_EMPTY"}};

inline constexpr ValueName kFactNames[] = {{0, "EMPTY"},    {1, "SOLE"},   {2, "OFFER"},   {3, "TAKE"},
                                           {4, "RELEASED"}, {5, "RETAIN"}, {15, "UNKNOWN"}};

inline constexpr ValueName kBriefFactNames[] = {{0, "EMPTY"},    {1, "SOLE"},   {2, "OFFER"},  {3, "TAKE"},
                                                {4, "RELEASED"}, {5, "RETAIN"}, {7, "UNKNOWN"}};

inline constexpr ValueName kOpNames[] = {
    {0, "HOLD"},   {1, "ARM"},   {2, "DISARM"},     {3, "CLOSE_LIGHT"}, {4, "SQUEEZE"},        {5, "OFFER"},
    {6, "ACCEPT"}, {7, "ABORT"}, {8, "OPEN_EMPTY"}, {9, "CLEAR_FAULT"}, {10, "MANUAL_RELEASE"}};

inline constexpr ValueName kResultNames[] = {{0, "OK"},          {1, "BUSY"},     {2, "REFUSED"},
                                             {3, "BAD_SESSION"}, {4, "BAD_SEQ"},  {5, "BAD_STATE"},
                                             {6, "LIMIT"},       {7, "NO_PERMIT"}};

inline constexpr ValueName kReasonNames[] = {{0, "NONE"},
                                             {1, "UNKNOWN_OPERATION"},
                                             {2, "BAD_ARGUMENT"},
                                             {3, "NOT_ARMED"},
                                             {4, "WRONG_SESSION"},
                                             {5, "SEQUENCE_OLD"},
                                             {6, "SEQUENCE_USED_UP"},
                                             {7, "WRONG_STATE"},
                                             {8, "NO_LAYOUT"},
                                             {9, "LAYOUT_DIFFERS"},
                                             {10, "HOST_SILENT"},
                                             {11, "TWO_HOSTS"},
                                             {12, "NOT_PERMITTED"},
                                             {13, "FAULT_ACTIVE"},
                                             {14, "FORCE_OVER_PERMIT"},
                                             {15, "FORCE_OVER_LIMIT"},
                                             {16, "FORCE_UNDER_REQUIRED"},
                                             {17, "PEER_NOT_IN_LAYOUT"},
                                             {18, "PEER_STALE"},
                                             {19, "PEER_NOT_OFFERING"},
                                             {20, "PAIR_DIFFERS"},
                                             {21, "TOKEN_OLD"},
                                             {22, "PART_HELD"},
                                             {23, "PART_SUSPECTED"},
                                             {24, "NO_LOCAL_ENABLE"},
                                             {25, "CHALLENGE_WRONG"},
                                             {26, "HANDOFF_RUNNING"},
                                             {27, "CAUSE_REMAINS"},
                                             {28, "DEGRADED"},
                                             {29, "PASSIVE"},
                                             {30, "AUTHENTICATION"},
                                             {31, "LOCKED_OUT"}};

inline constexpr ValueName kSeverityNames[] = {{0, "INFO"}, {1, "WARN"}, {2, "HOLD"}, {3, "LATCHED"}};

inline constexpr ValueName kHostStateNames[] = {{0, "IDLE"}, {1, "SET_UP"}, {2, "RUN"}, {3, "STOPPING"}};

inline constexpr ValueName kFaultNames[] = {{0x0000, "NONE"},           {0x3100, "SUPPLY_VOLTAGE"},
                                            {0x5010, "PRESSURE_RANGE"}, {0x5011, "SENSORS_DISAGREE"},
                                            {0x5020, "VALVE_STUCK"},    {0x5030, "POSITION"},
                                            {0x6010, "WATCHDOG"},       {0x6020, "MEMORY_SELF_TEST"},
                                            {0x6030, "CUSTODY_MEMORY"}, {0x6320, "LAYOUT_REFUSED"},
                                            {0x7010, "SUPPLY_AIR_LOW"}, {0x7011, "LEAK"},
                                            {0x7020, "OVER_FORCE"},     {0x7021, "HOLD_LOST"},
                                            {0x7030, "SLIP"},           {0x7031, "NO_PART"},
                                            {0x7032, "MIS_SEATED"},     {0x8110, "RECEIVE_OVERRUN"},
                                            {0x8120, "BUS_PASSIVE"},    {0x8130, "HOST_LOST"},
                                            {0x8131, "PEER_LOST"},      {0x8140, "BUS_OFF_RECOVERED"},
                                            {0x8141, "BUS_OFF"},        {0x8150, "OWN_ID_SEEN"},
                                            {0x8160, "BAD_CHECKSUM"},   {0x8161, "BAD_SEQUENCE"},
                                            {0x8162, "BAD_SESSION"},    {0x8163, "AUTHENTICATION"},
                                            {0x8170, "IN_DOUBT"},       {0x8171, "HANDOFF_ABORTED"},
                                            {0x9001, "MANUAL_RELEASE"}};

/// kFaultNames by index, as STATE.FAULT counts them.
inline constexpr auto kFaultIndexNames = [] {
  std::array<ValueName, kFaultCodes.size()> names{};
  for (std::uint32_t i = 0; i < names.size(); ++i) names[i] = {i, kFaultNames[i].name};
  return names;
}();

inline constexpr ValueName kIdentityPageNames[] = {
    {0, "PRODUCT"}, {1, "FIRMWARE"}, {2, "IMAGE"}, {3, "SERIAL"}, {4, "BOOT"}};

inline constexpr ValueName kResetCauseNames[] = {
    {0, "POWER_ON"}, {1, "WATCHDOG"}, {2, "SOFTWARE"}, {3, "BROWNOUT"}, {4, "EXTERNAL"}};

inline constexpr ValueName kMemoryStatusNames[] = {{0, "GOOD"}, {1, "ONE_COPY_LOST"}, {2, "LOST"}};

inline constexpr ValueName kSegmentNames[] = {
    {0, "SINGLE"}, {1, "FIRST"}, {2, "CONSECUTIVE"}, {3, "FLOW_CONTROL"}};

/// The name of `value` in `names`, or "?".
constexpr const char* name_in(std::span<const ValueName> names, std::uint64_t value) {
  for (const ValueName& entry : names) {
    if (entry.value == value) return entry.name;
  }
  return "?";
}

constexpr const char* to_string(State s) {
  return name_in(kStateNames, static_cast<std::uint64_t>(s));
}
constexpr const char* to_string(Fact f) {
  return name_in(kFactNames, static_cast<std::uint64_t>(f));
}
constexpr const char* to_string(Op op) {
  return name_in(kOpNames, static_cast<std::uint64_t>(op));
}
constexpr const char* to_string(CommandResult r) {
  return name_in(kResultNames, static_cast<std::uint64_t>(r));
}
constexpr const char* to_string(Reason r) {
  return name_in(kReasonNames, static_cast<std::uint64_t>(r));
}
constexpr const char* to_string(Severity s) {
  return name_in(kSeverityNames, static_cast<std::uint64_t>(s));
}
constexpr const char* to_string(FaultCode c) {
  return name_in(kFaultNames, static_cast<std::uint64_t>(c));
}

}  // namespace pinjaw::wire
