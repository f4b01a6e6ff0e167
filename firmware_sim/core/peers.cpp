#include "firmware_sim/core/peers.hpp"

namespace pinjaw::core {
namespace {
constexpr std::uint16_t kFaultKept_ms = 3 * wire::kFaultPeriod_ms + 20;  // as long as three reports
}  // namespace

void Peers::follow(const wire::Layout& layout) {
  *this = {};
  for (std::size_t i = 0; i < layout.used_peers().size(); ++i) nodes_[i] = layout.used_peers()[i].node;
}

Peer* Peers::slot_of(std::uint8_t node) {
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    if (nodes_[i] == node) return &peers_[i];
  }
  return nullptr;
}

const Peer* Peers::find(std::uint8_t node) const {
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    if (nodes_[i] == node && node != 0) return &peers_[i];
  }
  return nullptr;
}

void Peers::hear(const wire::Received<wire::Custody>& custody) {
  Peer* peer = slot_of(custody.label.node);
  if (peer == nullptr) return;
  if (peer->custody_counter.accept(custody.label.counter) != wire::CounterVerdict::Qualified) return;
  if (custody.message.past()) {
    peer->past = custody.message;
    return;
  }
  peer->custody = custody.message;
  peer->custody_fresh.start(wire::kPeerFresh_ms);
}

void Peers::hear(const wire::Received<wire::NodeState>& state) {
  Peer* peer = slot_of(state.label.node);
  if (peer == nullptr) return;
  if (peer->state_counter.accept(state.label.counter) != wire::CounterVerdict::Qualified) return;
  peer->state = state.message;
  peer->state_fresh.start(wire::kPeerFresh_ms);
}

void Peers::hear(const wire::Received<wire::FaultReport>& fault) {
  Peer* peer = slot_of(fault.label.node);
  if (peer == nullptr) return;
  // A fault is believed before three reports are in order: they are rare, and doubt is the safe side.
  if (peer->fault_counter.accept(fault.label.counter) == wire::CounterVerdict::Discarded) return;
  // That one is over says nothing of others: they run out.
  if (fault.message.severity >= wire::Severity::Hold && fault.message.active)
    peer->faulty.start(kFaultKept_ms);
}

void Peers::advance(std::uint16_t elapsed_ms) {
  for (Peer& peer : peers_) {
    peer.custody_fresh.advance(elapsed_ms);
    peer.state_fresh.advance(elapsed_ms);
    peer.faulty.advance(elapsed_ms);
  }
}

}  // namespace pinjaw::core
