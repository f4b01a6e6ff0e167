#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "protocol/wire/codec.hpp"
#include "protocol/wire/reception.hpp"

namespace pinjaw::jaw_client {

/// What one controller said last. For people and scripts; the controllers themselves trust none of it.
class NodeView {
 public:
  /// A STATE no older than this shows that the node lives; wider than the nodes' own 70 ms, since a host's
  /// operating system may make it wait.
  static constexpr std::int64_t kAlive_us = 500'000;

  [[nodiscard]] bool alive(std::int64_t now_us) const { return state && now_us - state_at_us_ <= kAlive_us; }
  [[nodiscard]] bool in(wire::State wanted) const { return state && state->state == wanted; }
  /// A fault of this code is reported and not yet gone.
  [[nodiscard]] const wire::FaultReport* fault(wire::FaultCode code) const;

  std::optional<wire::NodeState> state;
  std::optional<wire::Force> force;
  std::optional<wire::Custody> custody;
  std::optional<wire::LayoutStatus> layout;
  std::optional<wire::Pneumatics> pneumatics;
  wire::Identity identity;                     ///< pages as they came
  std::uint8_t identity_pages = 0;             ///< bit n: page n came
  std::vector<wire::FaultReport> faults;       ///< active ones, oldest first
  std::optional<wire::FaultReport> last_note;  ///< the last report of something that is already over
  std::optional<std::uint16_t> challenge;      ///< of a MANUAL_RELEASE, waiting for its answer
  std::uint64_t states_heard = 0;              ///< STATE frames taken
  std::uint64_t discarded = 0;                 ///< repeated or out of order

  /// Each takes a checked message; repeats and jumps of the counter are discarded.
  void take(const wire::Received<wire::NodeState>& received, std::int64_t now_us);
  void take(const wire::Received<wire::Force>& received);
  void take(const wire::Received<wire::Custody>& received);
  void take(const wire::Received<wire::FaultReport>& received);
  void take(const wire::Received<wire::LayoutStatus>& received);
  void take(const wire::Received<wire::Pneumatics>& received);
  void take(const wire::Received<wire::Identity>& received);

 private:
  bool in_order(wire::MessageType type, std::uint8_t counter);

  std::int64_t state_at_us_ = 0;
  std::array<wire::CounterCheck, wire::kMessages.size()> checks_{};
};

}  // namespace pinjaw::jaw_client
