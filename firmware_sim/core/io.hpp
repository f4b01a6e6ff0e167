#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "protocol/wire/codes.hpp"
#include "protocol/wire/frame.hpp"

namespace pinjaw::core {

/// What the sensors of one controller read in this millisecond. Pressures gauge.
struct Sensors {
  std::array<std::int32_t, 2> close_mbar{};  ///< two independent sensors, A and B
  std::array<std::int32_t, 2> open_mbar{};
  std::int32_t supply_mbar = 0;
  std::int32_t separation_10um = 0;
  std::uint8_t seats = 0;     ///< a bit for each seat switch that is pressed
  bool local_enable = false;  ///< the operator's key or button at the station
};

/// Main spool: Hold is where its spring puts it without current. There the close chamber is shut in by the
/// check valve and nothing opens.
enum class Spool : std::uint8_t { Hold, Close, Open };

/// The output image; a default one is the de-energised state.
struct Valves {
  Spool spool = Spool::Hold;
  std::int32_t close_set_mbar = 0;  ///< the close regulator's set point
  bool relax = false;       ///< lifts the check valve: the close chamber may blow back to the regulator
  bool pre_vent = false;    ///< vents the open chamber past the meter-out
  bool supply_cut = false;  ///< the cut-off before the regulator
  friend bool operator==(const Valves&, const Valves&) = default;
};

/// What a custody record says (section 2.5). The numbers are what non-volatile memory holds.
enum class Custody : std::uint8_t {
  Empty = 0,     ///< nothing is held
  Sole = 1,      ///< this node alone answers for the part
  Offered = 2,   ///< still sole, with an offer of `token` out
  Latched = 3,   ///< receiver: opens only on RETAIN(token), sole only on RELEASED(token)
  Decided = 4,   ///< giver: past the point of no return, opens even after a restart
  Released = 5,  ///< giver: open, the part is `peer`'s
  Retained = 6,  ///< sole again; `token` is burned and its peer may open
};

/// How a handoff ended that this node gave in.
struct Outcome {
  bool retained = false;  ///< else released
  std::uint8_t peer = 0;  ///< 0: none
  std::uint16_t token = 0;
  std::uint16_t pair = 0;
  friend bool operator==(const Outcome&, const Outcome&) = default;
};

/// The record that survives a power cut; written whole.
struct NvmRecord {
  Custody custody = Custody::Empty;
  std::uint8_t peer = 0;             ///< 15: the operator
  std::uint16_t token = 0;           ///< of the handoff that `custody` tells of
  std::uint16_t pair = 0;            ///< its pair_crc
  std::uint16_t handoff_number = 0;  ///< this node's last token as giver (R7)
  std::uint16_t force_set_dn = 0;    ///< with which the part is held
  std::uint16_t permit_dn = 0;       ///< F_permit when it was taken
  std::uint32_t session_block = 0;   ///< sessions up to here have been given out
  std::uint32_t frame_block = 0;     ///< upper 32 bits of frame numbers: those below have been given out
  std::uint16_t boot_count = 0;
  std::uint16_t seen_givers = 0;               ///< bit n: a token of node n was accepted before
  std::array<std::uint16_t, 16> last_token{};  ///< the last one of each giver (R8)
  std::array<Outcome, 4> outcomes{};           ///< of the last tokens, the newest first (R10)
  friend bool operator==(const NvmRecord&, const NvmRecord&) = default;
};

/// A committed layout as it travelled; `size` 0 is none.
struct LayoutBlob {
  std::array<std::uint8_t, 256> bytes{};
  std::uint16_t size = 0;
  friend bool operator==(const LayoutBlob&, const LayoutBlob&) = default;
};

/// What a controller finds in its non-volatile memory when power comes.
struct NvmImage {
  std::optional<NvmRecord> record;  ///< nothing: never written
  bool readable = true;             ///< false: both slots fail their checks
  LayoutBlob layout;
  wire::ResetCause reset = wire::ResetCause::PowerOn;  ///< what ended the last run, as the hardware tells
};

/// A request to store. Both parts, where given, are stored before `sequence` is reported done.
struct NvmWrite {
  std::uint16_t sequence = 0;  ///< grows by one with each request
  std::optional<NvmRecord> record;
  std::optional<LayoutBlob> layout;
};

/// How far storing has come.
struct NvmStatus {
  std::uint16_t done = 0;  ///< the last NvmWrite::sequence that is safely stored; 0 after power on
  bool failed = false;     ///< a request could not be stored
};

/// What the CAN controller says of itself.
struct BusHealth {
  bool off = false;            ///< bus-off: nothing is sent or received
  bool passive = false;        ///< error passive
  std::uint32_t overruns = 0;  ///< receive overruns since power on
};

/// Everything a controller learns in one step.
struct Inputs {
  std::uint32_t elapsed_ms = 1;
  std::span<const wire::Frame> received{};  ///< since the last step, in order of arrival
  Sensors sensors;
  NvmStatus nvm;
  BusHealth bus{};
};

/// Frames to send, in order; what does not fit is counted in State::counters.
struct SendQueue {
  static constexpr std::size_t kCapacity = 24;
  std::array<wire::Frame, kCapacity> frames{};
  std::size_t size = 0;
  [[nodiscard]] std::span<const wire::Frame> view() const { return {frames.data(), size}; }
};

/// Everything a controller does in one step.
struct Outputs {
  SendQueue send;
  Valves valves;
  std::optional<NvmWrite> nvm;
  bool restart_bus = false;  ///< lets the CAN controller recover from bus-off
};

}  // namespace pinjaw::core
