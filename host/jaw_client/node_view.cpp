#include "host/jaw_client/node_view.hpp"

#include <algorithm>

namespace pinjaw::jaw_client {

const wire::FaultReport* NodeView::fault(wire::FaultCode code) const {
  const auto it = std::find_if(faults.begin(), faults.end(),
                               [code](const wire::FaultReport& report) { return report.code == code; });
  return it == faults.end() ? nullptr : &*it;
}

bool NodeView::in_order(wire::MessageType type, std::uint8_t counter) {
  wire::CounterCheck& check = checks_.at(static_cast<std::size_t>(type) - 1);
  if (check.accept(counter) != wire::CounterVerdict::Discarded) return true;
  ++discarded;
  return false;
}

void NodeView::take(const wire::Received<wire::NodeState>& received, std::int64_t now_us) {
  if (!in_order(wire::MessageType::State, received.label.counter)) return;
  state = received.message;
  state_at_us_ = now_us;
  ++states_heard;
}

void NodeView::take(const wire::Received<wire::Force>& received) {
  if (in_order(wire::MessageType::Force, received.label.counter)) force = received.message;
}

void NodeView::take(const wire::Received<wire::Custody>& received) {
  if (!in_order(wire::MessageType::Custody, received.label.counter)) return;
  if (!received.message.past()) custody = received.message;
}

void NodeView::take(const wire::Received<wire::FaultReport>& received) {
  if (!in_order(wire::MessageType::Fault, received.label.counter)) return;
  const wire::FaultReport& report = received.message;
  std::erase_if(faults, [&report](const wire::FaultReport& known) { return known.code == report.code; });
  if (report.active) {
    faults.push_back(report);
  } else {
    last_note = report;
  }
  if (report.code == wire::FaultCode::ManualRelease && report.severity == wire::Severity::Info) {
    challenge = report.argument;
  }
}

void NodeView::take(const wire::Received<wire::LayoutStatus>& received) {
  if (in_order(wire::MessageType::LayoutStatus, received.label.counter)) layout = received.message;
}

void NodeView::take(const wire::Received<wire::Pneumatics>& received) {
  if (in_order(wire::MessageType::Pneumatics, received.label.counter)) pneumatics = received.message;
}

void NodeView::take(const wire::Received<wire::Identity>& received) {
  if (!in_order(wire::MessageType::Identity, received.label.counter)) return;
  const wire::Identity& page = received.message;
  identity_pages = static_cast<std::uint8_t>(identity_pages | 1U << static_cast<unsigned>(page.page));
  identity.page = page.page;
  switch (page.page) {
    case wire::IdentityPage::Product:
      identity.product = page.product;
      identity.hardware = page.hardware;
      break;
    case wire::IdentityPage::Firmware:
      identity.major = page.major;
      identity.minor = page.minor;
      identity.patch = page.patch;
      identity.dirty = page.dirty;
      break;
    case wire::IdentityPage::Image:
      identity.image_crc = page.image_crc;
      break;
    case wire::IdentityPage::Serial:
      identity.serial = page.serial;
      break;
    case wire::IdentityPage::Boot:
      identity.boots = page.boots;
      identity.reset = page.reset;
      identity.memory = page.memory;
      break;
  }
}

}  // namespace pinjaw::jaw_client
