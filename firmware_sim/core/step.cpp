#include <algorithm>

#include "firmware_sim/core/commands.hpp"
#include "firmware_sim/core/core.hpp"
#include "firmware_sim/core/custody.hpp"
#include "firmware_sim/core/events.hpp"
#include "firmware_sim/core/force_control.hpp"
#include "firmware_sim/core/force_guard.hpp"
#include "firmware_sim/core/guards.hpp"
#include "firmware_sim/core/layout_service.hpp"
#include "firmware_sim/core/release_guard.hpp"
#include "firmware_sim/core/sending.hpp"
#include "firmware_sim/core/telemetry.hpp"
#include "firmware_sim/core/transitions.hpp"
#include "protocol/wire/dispatch.hpp"

namespace pinjaw::core {
namespace {

constexpr int kEventsPerStep = 4;  // boot, recovery and what follows settle in one step; no chain is longer

/// Takes each parsed message to whom it concerns.
struct Listener {
  State& state;
  SendQueue& queue;

  [[nodiscard]] bool is_mine(std::uint8_t node) const { return node == state.config.node; }

  void operator()(const wire::Received<wire::GlobalHold>&) const { apply(state, Event::CmdHold); }
  void operator()(const wire::Received<wire::HostHeartbeat>& heartbeat) const {
    state.host.hear(heartbeat, state.config.node);
  }
  void operator()(const wire::Received<wire::Command>& command) const {
    if (!is_mine(command.label.node)) return;
    const wire::Acknowledge answer = obey(state, command.message);
    send(state, queue, wire::pack(answer, {.node = state.config.node}));
  }
  void operator()(const wire::Segment& segment) const {
    if (segment.identifier.type != wire::MessageType::TransferRequest) return;
    if (is_mine(segment.identifier.node)) take_segment(state, segment, queue);
  }
  void operator()(const wire::Received<wire::Custody>& custody) const { from_peer(custody); }
  void operator()(const wire::Received<wire::NodeState>& status) const { from_peer(status); }
  void operator()(const wire::Received<wire::FaultReport>& fault) const { from_peer(fault); }

  /// What no controller acts on.
  void operator()(const wire::Unread& other) const {
    if (is_mine(other.identifier.node)) raise(state, wire::FaultCode::OwnIdSeen);
  }

  template <class Message>
  void from_peer(const wire::Received<Message>& message) const {
    if (is_mine(message.label.node)) return raise(state, wire::FaultCode::OwnIdSeen);
    state.peers.hear(message);
  }
};

Release release_of(const State& state) {
  const NvmRecord& record = state.store.record;
  const wire::LayoutPeer* peer = state.layouts.committed ? state.layouts.layout.peer(record.peer) : nullptr;
  const bool under_way = record.custody == Custody::Offered || record.custody == Custody::Decided;
  return {.peer = under_way ? record.peer : std::uint8_t{0},
          .token = record.token,
          .pair = record.pair,
          .peer_required_dn = peer == nullptr ? std::uint16_t{0} : peer->f_required_dn,
          .decided = record.custody == Custody::Decided,
          .challenge = state.timers.challenge.running() ? state.challenge : std::uint16_t{0}};
}

void listen(State& state, const Inputs& inputs, SendQueue& queue) {
  const Listener listener{state, queue};
  for (const wire::Frame& frame : inputs.received) {
    if (on_can_fd(state.config)) {
      const std::optional<wire::Frame> opened = state.link.open(*state.config.key, frame);
      if (!opened) continue;
      watch(state.release_guard, state.config, release_of(state), *opened, inputs.sensors.local_enable);
      if (wire::dispatch(*opened, listener)) ++state.counters.bad_frames;
    } else if (wire::dispatch(frame, listener)) {
      ++state.counters.bad_frames;
    }
  }
}

/// What the link says for itself.
void speak(State& state, std::uint16_t elapsed_ms, SendQueue& queue) {
  if (!on_can_fd(state.config) || !has_frame_number(state)) return;
  const std::optional<wire::Frame> frame = state.link.speak(*state.config.key, elapsed_ms);
  if (frame) queue_frame(state, queue, *frame);
}

void let_time_pass(State& state, std::uint16_t elapsed_ms) {
  state.host.advance(elapsed_ms);
  state.peers.advance(elapsed_ms);
  const bool rests = state.frozen || (state.id == StateId::Seating && !motion_permitted(state));
  state.timers.state.advance(rests ? std::uint16_t{0} : elapsed_ms);
  state.timers.challenge.advance(elapsed_ms);
  advance_lock_out(state, elapsed_ms);
}

void react(State& state) {
  for (int i = 0; i < kEventsPerStep; ++i) {
    const std::optional<Event> event = next_event(state);
    if (!event || !apply(state, *event)) return;
  }
}

void mind_bus(State& state, const BusHealth& health, std::uint16_t elapsed_ms) {
  state.bus.observe(health, elapsed_ms);
  if (state.bus.fell_off()) apply(state, Event::CmdHold);
  if (!state.bus.recovered()) return;
  state.host = {};
  if (state.layouts.committed) state.peers.follow(state.layouts.layout);
  state.release_guard = guard_after_bus_off(state.release_guard, state.config, state.store.record);
}

/// Both channels must want an opening, and a decision to be stored.
Valves release_guarded(const State& state, const Valves& wanted) {
  if (wanted.spool != Spool::Open) return wanted;
  const bool stored = state.store.durable();
  return permits_opening(state.release_guard, state.config, state.store.record, stored) ? wanted : Valves{};
}

/// What must be stored, but for a decision that only one channel took.
void store_permitted(State& state, std::optional<NvmWrite>& write) {
  if (permits_decision(state.release_guard, state.config, state.store.record)) {
    flush(state.store, state.layouts.layout, write);
  } else {
    write.reset();
    raise(state, wire::FaultCode::MemorySelfTest);  // the channels differ: something computes wrongly
  }
}

Valves decide_valves(State& state, const Inputs& inputs) {
  const Valves wanted = release_guarded(state, wanted_valves(state, inputs.elapsed_ms));
  return guarded(state.config, force_limit_dn(state), inputs.sensors, inputs.elapsed_ms, wanted, state.guard);
}

}  // namespace

void power_on(const Config& config, const NvmImage& image, State& state) {
  state.config = config;
  state.store.readable = image.readable;
  NvmRecord record = image.record.value_or(NvmRecord{});
  ++record.boot_count;
  state.next_session = record.session_block;
  if (numbers_are_left(state)) record.session_block += kSessionBlock;
  state.permit_dn = record.permit_dn;
  if (record.custody == Custody::Empty) {
    state.receiving = {.giver = record.peer, .token = record.token, .pair = record.pair};
  }
  state.release_guard = guard_after_reset(record);
  start_link(state, record);
  if (image.readable) {
    restore_layout(state, image.layout);
    to_store(state.store) = record;
  }
  state.reset = image.reset;
  if (state.reset == wire::ResetCause::Watchdog) raise(state, wire::FaultCode::Watchdog);
  state.timers.force.start(wire::kForceOffset_ms + 1);  // the first STATE goes out after 1 ms
}

State power_on(const Config& config, const NvmImage& image) {
  State state;
  power_on(config, image, state);
  return state;
}

void step(State& state, const Inputs& inputs, Outputs& outputs) {
  outputs.send.size = 0;
  const auto elapsed_ms = static_cast<std::uint16_t>(std::min<std::uint32_t>(inputs.elapsed_ms, 60000));
  const Announcement said_before = state.announced;
  ++state.counters.steps;
  let_time_pass(state, elapsed_ms);
  acknowledge(state.store, inputs.nvm);
  keep_link(state);
  observe(state.config, inputs.sensors, elapsed_ms, state.measurement);
  // on CAN FD the guard sees each frame once its MAC was found right
  const auto raw = on_can_fd(state.config) ? std::span<const wire::Frame>{} : inputs.received;
  watch(state.release_guard, state.config, release_of(state), raw, inputs.sensors.local_enable, elapsed_ms);
  mind_bus(state, inputs.bus, elapsed_ms);
  listen(state, inputs, outputs.send);
  speak(state, elapsed_ms, outputs.send);
  track(state, elapsed_ms);
  react(state);
  announce(state);
  outputs.valves = decide_valves(state, inputs);
  advance_service(state, elapsed_ms, outputs.send);
  report(state, elapsed_ms, outputs.valves, said_before, outputs.send);
  store_permitted(state, outputs.nvm);
  outputs.restart_bus = state.bus.restart();
}

Outputs step(State& state, const Inputs& inputs) {
  Outputs outputs;
  step(state, inputs, outputs);
  return outputs;
}

}  // namespace pinjaw::core
