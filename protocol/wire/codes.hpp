#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

/// The vocabulary of the bus: every number that has a name. The names as text are in names.hpp.
namespace pinjaw::wire {

inline constexpr std::uint8_t kHostNode = 0;  ///< source of GLOBAL_HOLD from a host
inline constexpr std::uint8_t kFirstNode = 1;
inline constexpr std::uint8_t kLastNode = 14;
inline constexpr std::uint8_t kOperatorPeer =
    15;  ///< CUSTODY.PEER of a part loaded by hand; the service tool's node

/// States of a jaw controller; what each means for holding is in the controller's table.
enum class State : std::uint8_t {
  Boot,
  Recover,
  Unconfigured,
  Loaded,
  Ready,
  Seating,
  Seated,
  Squeezing,
  Taken,
  Hold,
  Offered,
  Relax,
  Resqueeze,
  Opening,
  FaultHold,
  FaultEmpty,
};
inline constexpr std::size_t kStateCount = 16;

/// A custody fact: once said for a token it stays true for that token.
enum class Fact : std::uint8_t {
  Empty = 0,
  Sole = 1,
  Offer = 2,
  Take = 3,
  Released = 4,
  Retain = 5,
  Unknown = 15
};

enum class Op : std::uint8_t {
  Hold,
  Arm,
  Disarm,
  CloseLight,
  Squeeze,
  Offer,
  Accept,
  Abort,
  OpenEmpty,
  ClearFault,
  ManualRelease,
};
inline constexpr std::size_t kOpCount = 11;

/// What became of a command. Anything but Ok changed no output.
enum class CommandResult : std::uint8_t {
  Ok,
  Busy,
  Refused,
  BadSession,
  BadSequence,
  BadState,
  Limit,
  NoPermit
};

/// Why a command was not done.
enum class Reason : std::uint8_t {
  None,
  UnknownOperation,
  BadArgument,
  NotArmed,
  WrongSession,
  SequenceOld,
  SequenceUsedUp,  ///< 255 reached: ARM again
  WrongState,
  NoLayout,
  LayoutDiffers,  ///< the CRC named is not that of the committed layout
  HostSilent,
  TwoHosts,      ///< two epochs heard within 200 ms
  NotPermitted,  ///< HOST_HB's PERMIT bit of this node is off
  FaultActive,
  ForceOverPermit,  ///< F_set + u over F_permit
  ForceOverLimit,   ///< F_permit over the layout's or the hardware's limit
  ForceUnderRequired,
  PeerNotInLayout,
  PeerStale,
  PeerNotOffering,
  PairDiffers,
  TokenOld,
  PartHeld,
  PartSuspected,  ///< 'no part' is not proven
  NoLocalEnable,
  ChallengeWrong,
  HandoffRunning,
  CauseRemains,  ///< the fault's cause is still there
  Degraded,
  Passive,         ///< a passive station does not squeeze
  Authentication,  ///< the command's MAC is not right, or asks for what makes it right
  LockedOut,       ///< too many commands with a wrong MAC: for a while only HOLD is obeyed
};
inline constexpr std::size_t kReasonCount = 32;

enum class Severity : std::uint8_t { Info, Warning, Hold, Latched };

enum class HostState : std::uint8_t { Idle, SetUp, Run, Stopping };

enum class ResetCause : std::uint8_t { PowerOn, Watchdog, Software, Brownout, External };

enum class MemoryStatus : std::uint8_t { Good, OneCopyLost, Lost };

/// 16-bit fault codes in the ranges of CiA 301.
enum class FaultCode : std::uint16_t {
  None = 0,
  SupplyVoltage = 0x3100,
  PressureRange = 0x5010,
  SensorsDisagree = 0x5011,
  ValveStuck = 0x5020,
  Position = 0x5030,
  Watchdog = 0x6010,
  MemorySelfTest = 0x6020,
  CustodyMemory = 0x6030,
  LayoutRefused = 0x6320,
  SupplyAirLow = 0x7010,
  Leak = 0x7011,
  OverForce = 0x7020,
  HoldLost = 0x7021,
  Slip = 0x7030,
  NoPart = 0x7031,
  MisSeated = 0x7032,
  ReceiveOverrun = 0x8110,
  BusPassive = 0x8120,
  HostLost = 0x8130,
  PeerLost = 0x8131,
  BusOffRecovered = 0x8140,
  BusOff = 0x8141,
  OwnIdSeen = 0x8150,
  BadChecksum = 0x8160,
  BadSequence = 0x8161,
  BadSession = 0x8162,
  Authentication = 0x8163,
  InDoubt = 0x8170,
  HandoffAborted = 0x8171,
  ManualRelease = 0x9001,
};

/// All fault codes; a code's place is its index on the wire (STATE.FAULT), 0 being none.
inline constexpr std::array kFaultCodes = {FaultCode::None,          FaultCode::SupplyVoltage,
                                           FaultCode::PressureRange, FaultCode::SensorsDisagree,
                                           FaultCode::ValveStuck,    FaultCode::Position,
                                           FaultCode::Watchdog,      FaultCode::MemorySelfTest,
                                           FaultCode::CustodyMemory, FaultCode::LayoutRefused,
                                           FaultCode::SupplyAirLow,  FaultCode::Leak,
                                           FaultCode::OverForce,     FaultCode::HoldLost,
                                           FaultCode::Slip,          FaultCode::NoPart,
                                           FaultCode::MisSeated,     FaultCode::ReceiveOverrun,
                                           FaultCode::BusPassive,    FaultCode::HostLost,
                                           FaultCode::PeerLost,      FaultCode::BusOffRecovered,
                                           FaultCode::BusOff,        FaultCode::OwnIdSeen,
                                           FaultCode::BadChecksum,   FaultCode::BadSequence,
                                           FaultCode::BadSession,    FaultCode::Authentication,
                                           FaultCode::InDoubt,       FaultCode::HandoffAborted,
                                           FaultCode::ManualRelease};

/// 0 also for a number that is no code.
constexpr std::uint8_t index_of(FaultCode code) {
  std::size_t index = kFaultCodes.size() - 1;
  while (index > 0 && kFaultCodes[index] != code) --index;
  return static_cast<std::uint8_t>(index);
}

/// Nothing for an index that names no fault.
constexpr std::optional<FaultCode> fault_at(std::uint8_t index) {
  if (index >= kFaultCodes.size()) return std::nullopt;
  return kFaultCodes[index];
}

}  // namespace pinjaw::wire
