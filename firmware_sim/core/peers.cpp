#include "firmware_sim/core/peers.hpp"

#include <utility>

namespace pinjaw::core {
namespace {
constexpr std::uint16_t kFaultKept_ms = 3 * wire::kFaultPeriod_ms + 20;  // as long as three reports
}  // namespace

void Peers::follow(const wire::Layout& layout) {
  *this = {};
  for (std::size_t i = 0; i < layout.used_peers().size(); ++i) nodes_[i] = layout.used_peers()[i].node;
}

const Peer* Peers::find(std::uint8_t node) const {
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    if (nodes_[i] == node && node != 0) return &peers_[i];
  }
  return nullptr;
}

Peer* Peers::find(std::uint8_t node) {
  return const_cast<Peer*>(std::as_const(*this).find(node));
}

void Peers::hear(const wire::Received<wire::Custody>& custody) {
  Peer* peer = find(custody.label.node);
  if (peer == nullptr) return;
  if (peer->custody_reception.accept(custody.label.counter, wire::kPeerFresh_ms))
    peer->custody = custody.message;
}

void Peers::hear(const wire::Received<wire::NodeState>& state) {
  Peer* peer = find(state.label.node);
  if (peer == nullptr) return;
  if (peer->state_counter.accept(state.label.counter) != wire::CounterVerdict::Qualified) return;
  peer->state = state.message;
  peer->state_fresh.start(wire::kPeerFresh_ms);
}

void Peers::hear(const wire::Received<wire::FaultReport>& fault) {
  Peer* peer = find(fault.label.node);
  if (peer == nullptr || fault.message.severity < wire::Severity::Hold) return;
  if (fault.message.active) {
    peer->faulty.start(kFaultKept_ms);
  } else {
    peer->faulty.stop();
  }
}

void Peers::advance(std::uint16_t elapsed_ms) {
  for (Peer& peer : peers_) {
    peer.custody_fresh.advance(elapsed_ms);
    peer.state_fresh.advance(elapsed_ms);
    peer.faulty.advance(elapsed_ms);
  }
}

}  // namespace pinjaw::core
