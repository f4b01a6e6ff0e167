#include "tests/firmware_sim/support/scripted_host.hpp"

namespace pinjaw::test {
namespace {

std::uint8_t node_id(int node) {
  return static_cast<std::uint8_t>(node);
}

}  // namespace

void ScriptedHost::step(int elapsed_ms) {
  const auto ms = static_cast<std::uint16_t>(elapsed_ms);
  while (true) {
    const auto next = bus_->receive();
    if (!next || !*next) break;
    hear((*next)->frame);
  }
  say_heartbeat(ms);
  say_command(ms);
  say_segment(ms);
}

void ScriptedHost::send(int node, wire::Command command) {
  Session& session = sessions_.at(static_cast<std::size_t>(node));
  if (command.op != wire::Op::Arm) {
    command.session = session.session;
    command.sequence = session.sequence.take().value_or(255);
  }
  heard_.at(static_cast<std::size_t>(node)).answer.reset();
  waiting_ = Waiting{.node = node, .command = command, .repeat = {}};
}

void ScriptedHost::request(int node, std::vector<std::uint8_t> message) {
  heard_.at(static_cast<std::size_t>(node)).response.clear();
  sender_.start(message);
  transfer_node_ = node;
}

void ScriptedHost::hear(const wire::Frame& frame) {
  (void)wire::dispatch(frame, [this](const auto& message) { hear(message); });
}

template <class Message>
void ScriptedHost::hear(const wire::Received<Message>& received) {
  Heard& heard = heard_.at(received.label.node);
  if constexpr (std::is_same_v<Message, wire::NodeState>) heard.state = received.message;
  if constexpr (std::is_same_v<Message, wire::Custody>) {
    if (!received.message.past()) heard.custody = received.message;
  }
  if constexpr (std::is_same_v<Message, wire::Force>) heard.force = received.message;
  if constexpr (std::is_same_v<Message, wire::FaultReport>) {
    if (received.message.code == wire::FaultCode::ManualRelease) heard.challenge = received.message.argument;
  }
}

void ScriptedHost::hear(const wire::Received<wire::Acknowledge>& received) {
  if (!waiting_ || waiting_->node != received.label.node) return;
  const wire::Acknowledge& answer = received.message;
  if (answer.op != waiting_->command.op || answer.sequence != waiting_->command.sequence) return;
  Session& session = sessions_.at(received.label.node);
  if (answer.op == wire::Op::Arm && answer.result == wire::CommandResult::Ok) {
    session.session = answer.session;
    session.sequence.begin(answer.next_sequence);
  }
  heard_.at(received.label.node).answer = answer;
  waiting_.reset();
}

void ScriptedHost::hear(const wire::Segment& segment) {
  if (segment.identifier.type != wire::MessageType::TransferResponse || !transfer_node_ ||
      segment.identifier.node != *transfer_node_) {
    return;
  }
  if (wire::kind_of(segment.data) == wire::SegmentKind::FlowControl) {
    sender_.accept(segment.data);
    return;
  }
  if (const auto flow = receiver_.accept(segment.data)) {
    (void)bus_->send(
        wire::pack_segment({{wire::MessageType::TransferRequest, node_id(*transfer_node_)}, *flow}));
  }
  if (const auto message = receiver_.take()) {
    heard_.at(segment.identifier.node).response.assign(message->begin(), message->end());
    transfer_node_.reset();
  }
}

void ScriptedHost::say_heartbeat(std::uint16_t elapsed_ms) {
  heartbeat_.advance(elapsed_ms);
  if (heartbeat_.running()) return;
  heartbeat_.start(wire::kHostHeartbeat_ms);
  const wire::HostHeartbeat message{.state = wire::HostState::Idle, .permit = permit_, .epoch = epoch_};
  (void)bus_->send(wire::pack(message, {.node = 0, .counter = heartbeat_counter_}));
  heartbeat_counter_ = static_cast<std::uint8_t>((heartbeat_counter_ + 1) % 15);
}

void ScriptedHost::say_command(std::uint16_t elapsed_ms) {
  if (!waiting_) return;
  waiting_->repeat.advance(elapsed_ms);
  if (waiting_->repeat.running()) return;
  waiting_->repeat.start(wire::kAcknowledge_ms);
  (void)bus_->send(wire::pack(waiting_->command, {.node = node_id(waiting_->node)}));
}

void ScriptedHost::say_segment(std::uint16_t elapsed_ms) {
  receiver_.advance(elapsed_ms);
  if (!transfer_node_) return;
  if (const auto segment = sender_.advance(elapsed_ms)) {
    (void)bus_->send(
        wire::pack_segment({{wire::MessageType::TransferRequest, node_id(*transfer_node_)}, *segment}));
  }
}

}  // namespace pinjaw::test
