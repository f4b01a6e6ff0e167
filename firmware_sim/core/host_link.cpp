#include "firmware_sim/core/host_link.hpp"

#include <utility>

namespace pinjaw::core {

HostLink::Host& HostLink::slot_for(std::uint16_t epoch) {
  for (Host& host : hosts_) {
    if (host.epoch == epoch) return host;  // a place where nobody is heard is nobody's: of epoch 0
  }
  Host& spare = hosts_[0].heard.running() ? hosts_[1] : hosts_[0];
  spare = Host{};
  spare.epoch = epoch;
  return spare;
}

void HostLink::hear(const wire::Received<wire::HostHeartbeat>& heartbeat, std::uint8_t node) {
  Host& host = slot_for(heartbeat.message.epoch);
  host.heard.start(wire::kHostFresh_ms);
  if (host.counter.accept(heartbeat.label.counter) != wire::CounterVerdict::Qualified) return;
  host.permit = heartbeat.message.permits(node);
  host.followed.start(wire::kHostFresh_ms);
}

void HostLink::advance(std::uint16_t elapsed_ms) {
  for (Host& host : hosts_) {
    host.followed.advance(elapsed_ms);
    host.heard.advance(elapsed_ms);
    if (!host.heard.running()) host = Host{};
  }
  if (!hosts_[0].heard.running()) std::swap(hosts_[0], hosts_[1]);
}

}  // namespace pinjaw::core
