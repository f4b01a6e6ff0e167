#pragma once

#include <array>
#include <cstdint>

#include "protocol/wire/codec.hpp"
#include "protocol/wire/layout.hpp"
#include "protocol/wire/reception.hpp"
#include "protocol/wire/timing.hpp"

namespace pinjaw::core {

/// What a controller knows of one other node that its layout names. Messages are kept only from qualified
/// frames (three in a row, at most two lost); whoever uses them asks for their freshness.
struct Peer {
  wire::CounterCheck custody_counter;
  wire::CounterCheck state_counter;
  wire::CounterCheck fault_counter;
  wire::Countdown custody_fresh;  ///< since the last usable frame: a repeated one must not make the peer lost
  wire::Countdown state_fresh;
  wire::Custody custody;  ///< the newest that is true now
  wire::Custody past;     ///< the newest outcome of a handoff that is over (R10)
  wire::NodeState state;
  wire::Countdown faulty;  ///< runs while it reports a fault for which it must hold

  [[nodiscard]] bool fresh() const { return custody_fresh.running() && state_fresh.running(); }
};

/// The nodes that the committed layout names, in its order. Frames of others mean nothing here.
class Peers {
 public:
  /// Begins anew with another layout.
  void follow(const wire::Layout& layout);

  void hear(const wire::Received<wire::Custody>& custody);
  void hear(const wire::Received<wire::NodeState>& state);
  void hear(const wire::Received<wire::FaultReport>& fault);
  void advance(std::uint16_t elapsed_ms);

  /// Nothing where the layout does not name `node`.
  [[nodiscard]] const Peer* find(std::uint8_t node) const;

 private:
  Peer* slot_of(std::uint8_t node);  ///< of node 0, which is nobody, one that find() never gives

  std::array<std::uint8_t, wire::kMaxPeers> nodes_{};  ///< 0: unused
  std::array<Peer, wire::kMaxPeers> peers_{};
};

}  // namespace pinjaw::core
