#pragma once

#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "protocol/bus/bus.hpp"
#include "protocol/wire/commands.hpp"
#include "protocol/wire/dispatch.hpp"
#include "protocol/wire/layout.hpp"
#include "protocol/wire/session.hpp"
#include "protocol/wire/transfer.hpp"

/// A controller that does what a test tells it to: real frames, sessions and transfers, no physics.
namespace pinjaw::jaw_client::testing {

/// What the fake makes of a new command.
struct Reply {
  wire::CommandResult result = wire::CommandResult::Ok;
  wire::Reason reason = wire::Reason::None;
  std::vector<wire::State> then{};  ///< states that follow, 40 ms each, the last one for good
};

class FakeController {
 public:
  FakeController(std::unique_ptr<bus::Bus> end, std::uint8_t node) : end_(std::move(end)), node_(node) {
    state.state = wire::State::Loaded;
    state.custody = wire::Fact::Empty;
  }

  /// One millisecond.
  void step() {
    ++ms_;
    while (true) {
      const auto received = end_->receive();
      if (!received || !*received) break;
      if (!deaf) (void)wire::dispatch((*received)->frame, *this);
    }
    receiver_.advance(1);
    if (const auto segment = sender_.advance(1)) send_segment(*segment);
    if (silent) return;
    if (!coming_.empty() && ms_ % 40 == 0) {
      state.state = coming_.front();
      coming_.pop_front();
    }
    if (ms_ % 20 == 0) cyclic(state);
    if (custody && ms_ % 20 == 10) cyclic(*custody);
    if (fault && ms_ % 100 == 0) cyclic(*fault);
  }

  void operator()(const wire::Received<wire::HostHeartbeat>& heartbeat) {
    ++heartbeats;
    last_heartbeat = heartbeat.message;
    state.host_alive = heartbeats >= 3;
  }
  void operator()(const wire::Received<wire::GlobalHold>& /*hold*/) { ++global_holds; }
  void operator()(const wire::Received<wire::Command>& command) {
    if (command.label.node != node_) return;
    ++commands_heard;
    answer(command.message);
  }
  void operator()(const wire::Segment& segment) {
    if (segment.identifier.type != wire::MessageType::TransferRequest || segment.identifier.node != node_)
      return;
    if (wire::kind_of(segment.data) == wire::SegmentKind::FlowControl) return sender_.accept(segment.data);
    if (const auto flow = receiver_.accept(segment.data)) send_segment(*flow);
    if (const auto request = receiver_.take()) serve({request->begin(), request->end()});
  }
  template <class Message>
  void operator()(const wire::Received<Message>& /*other*/) {}

  // Set by tests.
  wire::NodeState state;
  std::optional<wire::Custody> custody;
  std::optional<wire::FaultReport> fault;
  std::map<wire::Op, Reply> replies;
  std::map<wire::Op, std::function<void(const wire::Command&)>> effects;
  int acknowledges_to_lose = 0;
  int responses_to_lose = 0;
  int arms_without_permission = 0;  ///< so often an ARM finds that no permission was heard
  bool silent = false;              ///< sends nothing of its own accord
  bool deaf = false;
  wire::LayoutTarget target{.kit_id = 7, .f_hardware_dn = 1400, .f_uncertainty_dn = 120};
  bool garbles_readback = false;

  // Read by tests.
  int heartbeats = 0;
  int global_holds = 0;
  int commands_heard = 0;
  std::vector<wire::Command> commands_done;
  wire::HostHeartbeat last_heartbeat;
  std::optional<wire::Layout> committed;

 private:
  template <class Message>
  void cyclic(const Message& message) {
    std::uint8_t& counter = counters_[Message::kType];
    counter = wire::next_counter(counter);
    (void)end_->send(wire::pack(message, {.node = node_, .counter = counter}));
  }
  void send_segment(const wire::Payload& segment) {
    (void)end_->send(wire::pack_segment({{wire::MessageType::TransferResponse, node_}, segment}));
  }

  void answer(const wire::Command& command) {
    wire::Acknowledge acknowledge{.sequence = command.sequence, .op = command.op, .state = state.state};
    switch (gate_.admit(command)) {
      case wire::Admission::Repeated:
        acknowledge = gate_.last_answer();
        break;
      case wire::Admission::New:
        acknowledge = carry_out(command, acknowledge);
        break;
      case wire::Admission::WrongSession:
        acknowledge.result = wire::CommandResult::BadSession;
        acknowledge.reason = wire::Reason::WrongSession;
        break;
      case wire::Admission::NotArmed:
        acknowledge.result = wire::CommandResult::BadSession;
        acknowledge.reason = wire::Reason::NotArmed;
        break;
      default:
        acknowledge.result = wire::CommandResult::BadSequence;
    }
    if (acknowledges_to_lose > 0) {
      --acknowledges_to_lose;
      return;
    }
    (void)end_->send(wire::pack(acknowledge, {.node = node_}));
  }

  void arm() {
    gate_.open(++session_);
    if (arms_without_permission > 0) {
      --arms_without_permission;
    } else if (state.state == wire::State::Loaded && last_heartbeat.permits(node_)) {
      state.state = wire::State::Ready;
    }
  }

  wire::Acknowledge carry_out(const wire::Command& command, wire::Acknowledge acknowledge) {
    const Reply reply = replies[command.op];
    acknowledge.result = reply.result;
    acknowledge.reason = reply.reason;
    if (reply.result == wire::CommandResult::Ok) {
      commands_done.push_back(command);
      coming_.assign(reply.then.begin(), reply.then.end());
      if (command.op == wire::Op::Arm) arm();
      if (effects[command.op]) effects[command.op](command);
    }
    gate_.remember(command, acknowledge);
    acknowledge.state = state.state;
    acknowledge.session = gate_.session();
    acknowledge.next_sequence = gate_.next_sequence();
    gate_.remember(command, acknowledge);
    if (command.op == wire::Op::Disarm) gate_.close();
    state.armed = gate_.armed();
    return acknowledge;
  }

  void serve(const std::vector<std::uint8_t>& request) {
    if (responses_to_lose > 0) {
      --responses_to_lose;
      return;
    }
    std::vector<std::uint8_t> response{static_cast<std::uint8_t>(request[0] | wire::kResponseBit), request[1],
                                       0};
    const std::span<const std::uint8_t> body = std::span(request).subspan(wire::kRequestHeader);
    response[2] = static_cast<std::uint8_t>(served(static_cast<wire::Service>(request[0]), body, response));
    sender_.start(response);
  }

  wire::TransferStatus served(wire::Service service, std::span<const std::uint8_t> body,
                              std::vector<std::uint8_t>& response) {
    target.node = node_;
    if (service == wire::Service::Write) {
      const auto layout = wire::decode_layout(body);
      if (!layout) return layout.error();
      staged_ = *layout;
      gate_.close();
      put_crc(response, wire::layout_crc_of(*layout));
      return wire::admissible(*layout, target);
    }
    if (service == wire::Service::Commit) {
      if (!staged_) return wire::TransferStatus::NothingStaged;
      if (wire::ByteReader(body).take(4) != wire::layout_crc_of(*staged_))
        return wire::TransferStatus::CommitDiffers;
      committed = staged_;
      return wire::TransferStatus::Ok;
    }
    if (!committed) return wire::TransferStatus::NothingStaged;
    const wire::EncodedLayout encoded = wire::encode(*committed);
    response.insert(response.end(), encoded.span().begin(), encoded.span().end());
    if (garbles_readback) response.back() ^= 1U;
    return wire::TransferStatus::Ok;
  }

  static void put_crc(std::vector<std::uint8_t>& out, std::uint32_t crc) {
    for (unsigned i = 0; i < 4; ++i) out.push_back(static_cast<std::uint8_t>(crc >> (8 * i)));
  }

  std::unique_ptr<bus::Bus> end_;
  std::uint8_t node_;
  int ms_ = 0;
  std::map<wire::MessageType, std::uint8_t> counters_;
  wire::CommandGate gate_;
  std::uint16_t session_ = 100;
  std::deque<wire::State> coming_;
  wire::TransferReceiver receiver_;
  wire::TransferSender sender_;
  std::optional<wire::Layout> staged_;
};

}  // namespace pinjaw::jaw_client::testing
