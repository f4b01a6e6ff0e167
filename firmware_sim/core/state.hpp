#pragma once

#include <array>
#include <cstdint>

#include "firmware_sim/core/authentication.hpp"
#include "firmware_sim/core/bus_link.hpp"
#include "firmware_sim/core/config.hpp"
#include "firmware_sim/core/faults.hpp"
#include "firmware_sim/core/force_guard.hpp"
#include "firmware_sim/core/host_link.hpp"
#include "firmware_sim/core/io.hpp"
#include "firmware_sim/core/measure.hpp"
#include "firmware_sim/core/peers.hpp"
#include "firmware_sim/core/release_guard.hpp"
#include "firmware_sim/core/state_table.hpp"
#include "protocol/wire/layout.hpp"
#include "protocol/wire/messages.hpp"
#include "protocol/wire/secured_link.hpp"
#include "protocol/wire/session.hpp"
#include "protocol/wire/timing.hpp"
#include "protocol/wire/transfer.hpp"

namespace pinjaw::core {

/// The layout that is committed, and one that waits for its COMMIT. A record has one form only, so that its
/// bytes are made again where they are wanted.
struct Layouts {
  bool committed = false;
  bool is_staged = false;
  wire::Layout layout;  ///< meaningful while `committed`
  std::uint32_t crc = 0;
  wire::Layout staged;  ///< meaningful while `is_staged`
};

/// Non-volatile memory as the core sees it: what it has asked for and what is done.
struct Store {
  NvmRecord record;  ///< as it is, or will be once stored
  std::uint16_t requested = 0;
  std::uint16_t done = 0;
  bool record_waits = false;
  bool layout_waits = false;
  bool failed = false;
  bool readable = true;  ///< memory could be read when power came

  /// What was asked for last is safe. Nobody is told a fact before.
  [[nodiscard]] bool durable() const {
    return !failed && !record_waits && !layout_waits && requested == done;
  }
};

/// A custody fact as it is said on the bus.
struct Announcement {
  wire::Fact fact = wire::Fact::Unknown;
  std::uint8_t peer = 0;
  std::uint16_t token = 0;
  std::uint16_t pair = 0;
  friend bool operator==(const Announcement&, const Announcement&) = default;
};

/// The handoff in which this node receives, from ACCEPT to TAKEN.
struct Receiving {
  std::uint8_t giver = 0;  ///< 15: the operator; 0: none
  std::uint16_t token = 0;
  std::uint16_t pair = 0;
  bool retained = false;  ///< the giver was heard to take the part back: this node may let go
};

enum class Flow : std::uint8_t { Shut, Filling, Relieving };

struct ForceControl {
  Flow flow = Flow::Shut;
  std::int32_t reference_dn = 0;   ///< runs after the set point at the ramp's rate
  std::int32_t integral_ubar = 0;  ///< what the regulator needs beyond its set point
  std::uint16_t blocked_ms = 0;    ///< SEATING: how long the jaws have stood still while air came
  std::uint16_t starved_ms = 0;    ///< holding too weakly: how long air should have come
  bool refilling = false;          ///< the chamber was opened in the last step to refill a hold
  std::uint16_t asked_ms = 0;      ///< grows while a stable hold asks for air, falls while it does not
  std::int32_t push_mdn = 0;       ///< SEATING: what the approach adds to the light squeeze
};

/// Times that remain.
struct Timers {
  wire::Countdown state;      ///< time limit of the present state
  wire::Countdown stable;     ///< until a hold counts as stable
  wire::Countdown peer_good;  ///< until G_peer has been true long enough
  wire::Countdown challenge;  ///< a MANUAL_RELEASE may be answered
  wire::Countdown custody;
  wire::Countdown outcome;
  wire::Countdown status;
  wire::Countdown force;
  wire::Countdown pneumatics;
  wire::Countdown layout;
  wire::Countdown identity;
  wire::Countdown faults;
};

/// CTR of each cyclic message.
struct SendCounters {
  std::uint8_t fault = 0;
  std::uint8_t custody = 0;
  std::uint8_t status = 0;
  std::uint8_t force = 0;
  std::uint8_t pneumatics = 0;
  std::uint8_t layout = 0;
  std::uint8_t identity = 0;
};

/// What went wrong on the bus and what came to nothing; read by the LOG service, with what the link and the
/// transfer count.
struct Counters {
  std::uint32_t bad_frames = 0;
  std::uint32_t events_ignored = 0;
  std::uint32_t events_refused = 0;
  std::uint32_t frames_not_sent = 0;
  std::uint32_t steps = 0;
  std::uint32_t wrong_macs = 0;
};

/// One request at a time, and its answer.
struct LayoutService {
  wire::TransferReceiver receiver;
  wire::TransferSender sender;
  bool commit_waits = false;  ///< the answer to COMMIT goes out when the layout is stored
  std::uint8_t commit_transaction = 0;
};

/// Everything a controller knows. A plain value; power_on makes it, step changes it.
struct State {
  Config config;
  StateId id = StateId::Boot;
  Layouts layouts;
  Store store;
  Announcement announced;
  Measurement measurement;
  ForceControl control;
  ForceGuard guard;
  ReleaseGuard release_guard;
  BusLink bus;
  HostLink host;
  wire::CommandGate gate;
  LockOut lock_out;
  wire::SecuredLink<1 + wire::kMaxPeers> link{0, 0};  ///< to host and peers; in use with Config::can_fd
  std::uint32_t frame_block = 0;  ///< frame numbers whose upper 32 bits are below it are stored as given out
  Peers peers;
  Receiving receiving;
  Faults faults;
  Timers timers;
  SendCounters send_counters;
  LayoutService service;
  Counters counters;

  std::uint16_t session_epoch = 0;  ///< of the host that opened the session
  std::uint32_t next_session = 0;   ///< sessions given out so far; on the wire, their low half
  std::uint16_t permit_dn = 0;      ///< F_permit of the squeeze; 0: light only
  std::uint16_t force_set_dn = 0;   ///< F_set of the squeeze
  std::int32_t reference_10um = 0;  ///< separation from which slip counts
  std::uint16_t challenge = 0;
  std::uint8_t bad_hold_ms = 0;  ///< how long F_low has been under F_req
  std::uint8_t identity_page = 0;
  std::uint8_t outcome_next = 0;  ///< of the record's outcomes, the one to repeat next
  bool identity_burst = true;     ///< pages follow each other at once
  bool frozen = false;            ///< HOLD stopped the jaws; the next ARM lets them go on
  bool opening_wanted = false;    ///< READY: the jaws are on their way to fully open
  bool hold_proven = false;       ///< the hold was stable at least once since power came
  bool answer_seen = false;       ///< OFFERED: a TAKE for this token was heard
  wire::ResetCause reset{};       ///< what began this run
};

}  // namespace pinjaw::core
