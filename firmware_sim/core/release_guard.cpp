#include "firmware_sim/core/release_guard.hpp"

#include <algorithm>

#include "firmware_sim/core/rules.hpp"

// Nothing of protocol/wire but the frame and the countdown is used here: an error in the codec must not reach
// both channels. Numbers are those of docs/reliability.md 2.3.
namespace pinjaw::core {
namespace {

constexpr unsigned kFaultId = 0x020;
constexpr unsigned kCustodyId = 0x040;
constexpr unsigned kStateId = 0x060;
constexpr unsigned kCommandId = 0x100;
constexpr std::uint8_t kByHand = 15;
constexpr std::uint16_t kGood_ms = 200;       // 2.5: the receiver is watched for 200 ms
constexpr std::uint16_t kFreshTime_ms = 70;   // 2.3
constexpr std::uint16_t kFaultTime_ms = 320;  // three reports
constexpr std::uint16_t kAnswer_ms = 3000;    // 2.6

unsigned bits(const wire::Frame& frame, unsigned start, unsigned length) {
  unsigned value = 0;
  for (unsigned i = 0; i < length; ++i) {
    const unsigned at = start + i;
    value |= ((frame.data[at / 8] >> (at % 8)) & 1U) << i;
  }
  return value;
}

/// CRC-8 0x2F over the identifier's two bytes and bytes 1 to 7, by long division.
bool checksum_is_right(const wire::Frame& frame, unsigned type, unsigned node) {
  unsigned crc = 0xFF;
  const auto divide = [&crc](unsigned byte) {
    crc ^= byte;
    for (int i = 0; i < 8; ++i) crc = ((crc << 1) ^ ((crc & 0x80U) != 0 ? 0x2FU : 0U)) & 0xFFU;
  };
  divide(type << 4 | node);
  divide(0x5A);
  for (std::size_t i = 1; i < 8; ++i) divide(frame.data[i]);
  return frame.data[0] == (crc ^ 0xFFU);
}

/// A whole frame of message `type` (its number in the Data ID) that node `node` says or is told.
bool is_frame(const wire::Frame& frame, unsigned base, unsigned type, unsigned node) {
  return frame.kind == wire::FrameKind::Data && !frame.extended && frame.length == 8 &&
         frame.id == base + node && checksum_is_right(frame, type, node);
}

bool is_cyclic(const wire::Frame& frame, unsigned base, unsigned type, unsigned node) {
  return is_frame(frame, base, type, node) && bits(frame, 12, 4) == 1 && bits(frame, 8, 4) < 15;
}

/// Counts a frame in; true where it may be used.
bool take_in_order(ReleaseGuard::Watched& watched, const wire::Frame& frame) {
  const unsigned counter = bits(frame, 8, 4);
  const unsigned step = (15 + counter - watched.counter) % 15;
  const bool in_order = watched.counter == 15 || (step >= 1 && step <= 3);
  watched.counter = static_cast<std::uint8_t>(counter);
  watched.in_a_row =
      in_order ? static_cast<std::uint8_t>(std::min(watched.in_a_row + 1, 3)) : std::uint8_t{0};
  return watched.in_a_row == 3;
}

void hear_custody(ReleaseGuard& guard, unsigned own, const Release& release, const wire::Frame& frame) {
  if (!take_in_order(guard.custody, frame)) return;
  const bool past = bits(frame, 56, 8) == 0xFF && (bits(frame, 16, 4) == 4 || bits(frame, 16, 4) == 5);
  if (past) return;
  guard.custody.good = bits(frame, 16, 4) == 3 && bits(frame, 20, 4) == own &&
                       bits(frame, 24, 16) == release.token && bits(frame, 40, 16) == release.pair;
  guard.custody.fresh.start(kFreshTime_ms);
}

void hear_state(ReleaseGuard& guard, const Release& release, const wire::Frame& frame) {
  if (!take_in_order(guard.state, frame)) return;
  const unsigned force_dn = bits(frame, 32, 12);
  const bool taken = bits(frame, 16, 5) == 8 && bits(frame, 25, 1) == 1;
  guard.state.good = taken && force_dn != 0xFFF && force_dn >= release.peer_required_dn;
  guard.state.fresh.start(kFreshTime_ms);
}

void hear_command(ReleaseGuard& guard, const Release& release, const wire::Frame& frame, bool local_enable) {
  constexpr unsigned kManualRelease = 10;
  if (bits(frame, 16, 4) != kManualRelease || !local_enable) return;
  const unsigned step = bits(frame, 20, 4);
  if (step == 1) guard.asked.start(kAnswer_ms);
  const bool answered = release.challenge != 0 && bits(frame, 52, 12) == release.challenge;
  if (step == 2 && answered && guard.asked.running()) guard.hand_permits = true;
}

void hear(ReleaseGuard& guard, const Config& config, const Release& release, const wire::Frame& frame,
          bool local_enable) {
  if (is_frame(frame, kCommandId, 8, config.node)) return hear_command(guard, release, frame, local_enable);
  if (guard.peer == 0 || guard.peer == kByHand) return;
  if (is_cyclic(frame, kCustodyId, 3, guard.peer)) return hear_custody(guard, config.node, release, frame);
  if (is_cyclic(frame, kStateId, 4, guard.peer)) return hear_state(guard, release, frame);
  const bool faulty = bits(frame, 32, 2) >= 2 && bits(frame, 34, 1) == 1;
  if (is_cyclic(frame, kFaultId, 2, guard.peer) && faulty) guard.peer_faulty.start(kFaultTime_ms);
}

/// Another handoff begins with nothing permitted.
void follow(ReleaseGuard& guard, const Release& release) {
  if (guard.peer != release.peer) {
    guard.custody = {};
    guard.state = {};
    guard.peer_faulty.stop();
  }
  if (guard.peer == release.peer && guard.token == release.token) return;
  guard.peer = release.peer;
  guard.token = release.token;
  guard.custody.good = false;
  guard.peer_permits = false;
  guard.good_ms = 0;
}

/// What was heard until now and has lasted for another `elapsed_ms`.
void judge(ReleaseGuard& guard, const Release& release, std::uint16_t elapsed_ms) {
  const bool good = guard.custody.good && guard.state.good && guard.custody.fresh.running() &&
                    guard.state.fresh.running() && !guard.peer_faulty.running();
  guard.good_ms =
      good ? static_cast<std::uint16_t>(std::min(guard.good_ms + elapsed_ms, 60000)) : std::uint16_t{0};
  if (guard.good_ms >= kGood_ms) guard.peer_permits = true;
  if (release.decided) return;
  guard.decided_before = false;
  if (!guard.asked.running()) guard.hand_permits = false;
}

}  // namespace

ReleaseGuard guard_after_reset(const NvmRecord& record) {
  ReleaseGuard guard;
  guard.decided_before = record.custody == Custody::Decided;
  return guard;
}

ReleaseGuard guard_after_bus_off(const ReleaseGuard& before, const Config& config, const NvmRecord& record) {
  ReleaseGuard guard = guard_after_reset(record);
  guard.decided_before = guard.decided_before && permits_decision(before, config, record);
  return guard;
}

void watch(ReleaseGuard& guard, const Config& config, const Release& release,
           std::span<const wire::Frame> received, bool local_enable, std::uint16_t elapsed_ms) {
  follow(guard, release);
  for (wire::Countdown* timer :
       {&guard.custody.fresh, &guard.state.fresh, &guard.peer_faulty, &guard.asked}) {
    timer->advance(elapsed_ms);
  }
  for (const wire::Frame& frame : received) hear(guard, config, release, frame, local_enable);
  judge(guard, release, elapsed_ms);
}

void watch(ReleaseGuard& guard, const Config& config, const Release& release, const wire::Frame& frame,
           bool local_enable) {
  follow(guard, release);
  hear(guard, config, release, frame, local_enable);
  judge(guard, release, 0);
}

bool sees_peer_hold(const ReleaseGuard& guard, const Config& config) {
  return guard.good_ms > 0 || !config.release_guard_enabled;
}

bool permits_release(const ReleaseGuard& guard, const Config& config, const NvmRecord& record) {
  if (!config.release_guard_enabled) return true;
  return guard.peer_permits && guard.peer == record.peer && guard.token == record.token;
}

bool permits_decision(const ReleaseGuard& guard, const Config& config, const NvmRecord& record) {
  if (!config.release_guard_enabled || record.custody != Custody::Decided || guard.decided_before)
    return true;
  if (record.peer == kByHand) return guard.hand_permits;
  return permits_release(guard, config, record);
}

bool permits_opening(const ReleaseGuard& guard, const Config& config, const NvmRecord& record, bool stored) {
  if (record.custody == Custody::Empty || record.custody == Custody::Released) return true;
  if (record.custody != Custody::Decided) return !config.release_guard_enabled;
  return permits_decision(guard, config, record) && (stored || !keeps(Rule::DecisionBeforeOpen));
}

}  // namespace pinjaw::core
