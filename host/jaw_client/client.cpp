#include "host/jaw_client/client.hpp"

#include <algorithm>
#include <array>

#include "host/jaw_client/command_channel.hpp"
#include "host/jaw_client/operation.hpp"
#include "protocol/wire/dispatch.hpp"
#include "protocol/wire/secured_link.hpp"

namespace pinjaw::jaw_client {

namespace {

using wire::State;

constexpr std::int64_t kHeartbeat_us = std::int64_t{wire::kHostHeartbeat_ms} * 1000;
constexpr std::int64_t kTime_us = std::int64_t{wire::kTimePeriod_ms} * 1000;
constexpr std::int64_t kHoldSpacing_us = std::int64_t{wire::kGlobalHoldSpacing_ms} * 1000;
constexpr std::int64_t kOtherHost_us = 1'000'000;
constexpr int kMostFramesAStep = 10'000;
constexpr StateSet kFaultStates{State::FaultHold, State::FaultEmpty};
constexpr StateSet kOpen{State::Ready, State::Loaded, State::Unconfigured};

/// What the host knows of one controller and wants of it.
struct Jaw {
  NodeView view;
  CommandChannel channel;
  Operation operation;
};

/// Something sent again and again.
struct Cycle {
  std::int64_t next_us = 0;
  std::uint8_t counter = 0;

  /// Whether it is due; then it is due again `period_us` later.
  bool due(std::int64_t now_us, std::int64_t period_us) {
    if (now_us < next_us) return false;
    next_us = std::max(next_us + period_us, now_us + period_us / 2);
    counter = wire::next_counter(counter);
    return true;
  }
};

/// Another part of the numbers for each start of a host, which has no memory of its last.
wire::FrameNumber first_number(std::uint64_t drawn) {
  constexpr std::uint32_t kHalf = 0x7FFFFFFF;  // leaves the upper half to count on
  return (wire::FrameNumber{drawn ^ drawn >> 32} & kHalf) << 16 | 1U;
}

}  // namespace

class Client::Implementation {
 public:
  Implementation(bus::Bus& bus, Settings settings) : bus_(bus), settings_(settings) {
    if (!settings.key) return;
    if (settings.can_fd) link_.emplace(wire::kHostNode, first_number(settings.nonces));
    for (std::uint8_t node = wire::kFirstNode; node <= wire::kLastNode; ++node) {
      jaw(node).channel.share(node, {*settings.key, settings.nonces});
    }
  }

  void step(std::int64_t now_us) {
    const std::uint16_t elapsed_ms = elapsed(now_us);
    now_us_ = now_us;
    receive();
    if (!settings_.speaks) return;
    if (link_) {
      if (const auto frame = link_->speak(*settings_.key, elapsed_ms)) put(*frame);
    }
    send_cyclic();
    for (std::uint8_t node = wire::kFirstNode; node <= wire::kLastNode; ++node) serve(node, elapsed_ms);
  }

  Jaw& jaw(std::uint8_t node) { return jaws_.at(node); }
  [[nodiscard]] const Jaw& jaw(std::uint8_t node) const { return jaws_.at(node); }
  void order(std::uint8_t node, const Order& order) { jaw(node).operation.begin(node, order); }

  // The messages of the bus; dispatch() calls these.
  void operator()(const wire::Received<wire::Acknowledge>& r) { jaw(r.label.node).channel.take(r.message); }
  void operator()(const wire::Received<wire::NodeState>& r) { jaw(r.label.node).view.take(r, now_us_); }
  void operator()(const wire::Received<wire::HostHeartbeat>& r) {
    if (r.message.epoch != settings_.epoch || !settings_.speaks) other_host_us_ = now_us_;
  }
  void operator()(const wire::Segment& segment) {
    if (segment.identifier.type != wire::MessageType::TransferResponse) return;
    if (LayoutTransfer* transfer = jaw(segment.identifier.node).operation.transfer())
      transfer->take(segment.data);
  }
  template <class Message>
  void operator()(const wire::Received<Message>& r) {
    if constexpr (requires { jaw(1).view.take(r); }) jaw(r.label.node).view.take(r);
  }

  /// A changed permission is said with the next step.
  void beat_soon() { heartbeat_.next_us = now_us_; }
  [[nodiscard]] std::int64_t now_us() const { return now_us_; }
  [[nodiscard]] std::uint16_t epoch() const { return settings_.epoch; }
  [[nodiscard]] bool other_host() const {
    return other_host_us_ && now_us_ - *other_host_us_ <= kOtherHost_us;
  }

  wire::HostHeartbeat heartbeat;
  wire::GlobalHold global_hold;
  int holds_left = 0;
  std::optional<bus::Failure> failure;
  std::array<std::uint64_t, wire::kFrameErrorCount> rejected{};

 private:
  std::uint16_t elapsed(std::int64_t now_us) {
    if (!started_) {
      started_ = true;
      counted_us_ = now_us;
    }
    const std::int64_t ms = std::min<std::int64_t>((now_us - counted_us_) / 1000, 60'000);
    counted_us_ += ms * 1000;
    return static_cast<std::uint16_t>(ms);
  }

  void receive() {
    for (int i = 0; i < kMostFramesAStep; ++i) {
      const auto received = bus_.receive();
      if (!received) return fail(received.error());
      if (!*received) return;
      if ((*received)->origin == bus::Origin::Self) continue;
      take((*received)->frame);
    }
  }

  void take(const wire::Frame& said) {
    const std::optional<wire::Frame> frame = link_ ? link_->open(*settings_.key, said) : said;
    if (!frame) return;
    if (const auto error = wire::dispatch(*frame, *this)) ++rejected.at(static_cast<std::size_t>(*error));
  }

  void send(const wire::Frame& frame) { put(link_ ? link_->seal(*settings_.key, frame) : frame); }

  void put(const wire::Frame& frame) {
    const auto sent = bus_.send(frame);
    if (!sent && sent.error().kind != bus::FailureKind::Overflow) fail(sent.error());
  }

  void fail(const bus::Failure& why) {
    failure = why;
    for (Jaw& jaw : jaws_) jaw.operation.fail(OutcomeKind::BusFailed, why.message);
  }

  void send_cyclic() {
    if (heartbeat_.due(now_us_, kHeartbeat_us)) {
      heartbeat.epoch = settings_.epoch;
      send(wire::pack(heartbeat, {.counter = heartbeat_.counter}));
    }
    if (time_.due(now_us_, kTime_us)) {
      const auto time_us = static_cast<std::uint64_t>(now_us_) & wire::ones(48);
      send(wire::pack(wire::HostTime{time_us}, {.counter = time_.counter}));
    }
    if (holds_left > 0 && hold_.due(now_us_, kHoldSpacing_us)) {
      --holds_left;
      send(wire::pack(global_hold, {.counter = hold_.counter}));
    }
  }

  void serve(std::uint8_t node, std::uint16_t elapsed_ms) {
    Jaw& jaw = jaws_.at(node);
    const std::uint8_t giver = jaw.operation.giver();
    jaw.operation.advance({.view = jaw.view,
                           .giver = giver == 0 ? nullptr : &jaws_.at(giver).view,
                           .channel = jaw.channel,
                           .now_us = now_us_});
    if (const auto command = jaw.channel.due(now_us_)) send(wire::pack(*command, {.node = node}));
    LayoutTransfer* transfer = jaw.operation.transfer();
    if (transfer == nullptr) return;
    for (const wire::Payload& segment : transfer->advance(elapsed_ms)) {
      send(wire::pack_segment({{wire::MessageType::TransferRequest, node}, segment}));
    }
  }

  bus::Bus& bus_;
  Settings settings_;
  std::optional<wire::SecuredLink<wire::kLastNode>> link_;
  std::array<Jaw, wire::kLastNode + 1> jaws_;
  Cycle heartbeat_;
  Cycle time_;
  Cycle hold_;
  std::int64_t now_us_ = 0;
  std::int64_t counted_us_ = 0;
  bool started_ = false;
  std::optional<std::int64_t> other_host_us_;
};

Client::Client(bus::Bus& bus, Settings settings)
    : implementation_(std::make_unique<Implementation>(bus, settings)) {}
Client::~Client() = default;

void Client::step(std::int64_t now_us) {
  implementation_->step(now_us);
}

const NodeView& Client::node(std::uint8_t node) const {
  return implementation_->jaw(node).view;
}
bool Client::alive(std::uint8_t node) const {
  return this->node(node).alive(implementation_->now_us());
}

void Client::permit(std::uint8_t node, bool allowed) {
  const auto bit = static_cast<std::uint16_t>(1U << (node - 1U));
  std::uint16_t& permit = implementation_->heartbeat.permit;
  const auto wanted = static_cast<std::uint16_t>(allowed ? permit | bit : permit & ~bit);
  if (wanted != permit) implementation_->beat_soon();
  permit = wanted;
}
void Client::set_state(wire::HostState state) {
  implementation_->heartbeat.state = state;
}

void Client::send_layout(std::uint8_t node, const wire::Layout& layout) {
  implementation_->jaw(node).operation.begin(node, layout);
}

void Client::arm(std::uint8_t node, std::uint32_t layout_crc) {
  const std::uint16_t epoch = implementation_->epoch();
  const bool healthy = !this->node(node).state || this->node(node).state->fault == wire::FaultCode::None;
  implementation_->order(node, {.command = wire::arm_command(layout_crc, epoch),
                                .needs_host_heard = true,
                                .leaves_loaded = healthy && implementation_->heartbeat.permits(node)});
}
void Client::disarm(std::uint8_t node) {
  implementation_->order(node, {.command = wire::plain_command(wire::Op::Disarm)});
}

void Client::close_light(std::uint8_t node) {
  implementation_->order(node, {.command = wire::plain_command(wire::Op::CloseLight),
                                .goals = {State::Seated},
                                .failures = kFaultStates,
                                .reach_us = 20'000'000});
}

void Client::squeeze(std::uint8_t node, wire::SqueezeForces forces) {
  implementation_->order(node, {.command = wire::squeeze_command(forces),
                                .goals = {State::Hold, State::Taken},
                                .failures = {State::Seated, State::FaultHold, State::FaultEmpty}});
}

void Client::offer(std::uint8_t giver, std::uint8_t receiver) {
  implementation_->order(giver, {.command = wire::offer_command(receiver),
                                 .goals = {State::Offered, State::Relax, State::Opening},
                                 .failures = kFaultStates,
                                 .reach_us = 2'000'000});
}

void Client::accept(std::uint8_t receiver, std::uint8_t giver) {
  implementation_->order(receiver, {.command = wire::accept_command(giver),
                                    .goals = {State::Seated, State::Squeezing, State::Taken, State::Hold},
                                    .failures = kFaultStates,
                                    .reach_us = 20'000'000,
                                    .offering_giver = giver});
}

void Client::abort(std::uint8_t node) {
  implementation_->order(node, {.command = wire::plain_command(wire::Op::Abort)});
}
void Client::hold(std::uint8_t node) {
  implementation_->order(node, {.command = wire::hold_command()});
}

void Client::open_empty(std::uint8_t node) {
  implementation_->order(
      node, {.command = wire::plain_command(wire::Op::OpenEmpty), .goals = kOpen, .reach_us = 20'000'000});
}

void Client::release(std::uint8_t node) {
  implementation_->order(node, {.command = wire::manual_release_ask(),
                                .goals = kOpen,
                                .failures = {State::FaultEmpty},
                                .reach_us = 20'000'000,
                                .asks_challenge = true});
}

void Client::clear_fault(std::uint8_t node) {
  implementation_->order(node, {.command = wire::plain_command(wire::Op::ClearFault)});
}

void Client::hold_everyone(wire::Reason reason) {
  implementation_->global_hold.reason = reason;
  implementation_->holds_left = wire::kGlobalHoldRepeats;
}

const Outcome& Client::outcome(std::uint8_t node) const {
  return implementation_->jaw(node).operation.outcome();
}
bool Client::armed(std::uint8_t node) const {
  return implementation_->jaw(node).channel.armed();
}
bool Client::other_host() const {
  return implementation_->other_host();
}
const std::optional<bus::Failure>& Client::bus_failure() const {
  return implementation_->failure;
}
std::uint64_t Client::rejected(wire::FrameError error) const {
  return implementation_->rejected.at(static_cast<std::size_t>(error));
}

}  // namespace pinjaw::jaw_client
