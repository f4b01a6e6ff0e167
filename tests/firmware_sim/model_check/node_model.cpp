#include "tests/firmware_sim/model_check/node_model.hpp"

#include <algorithm>
#include <bit>
#include <iterator>
#include <stdexcept>
#include <utility>

#include "firmware_sim/core/core.hpp"
#include "firmware_sim/core/custody.hpp"
#include "protocol/wire/codec.hpp"
#include "protocol/wire/commands.hpp"
#include "tests/firmware_sim/model_check/words.hpp"

namespace pinjaw::core::model {
namespace {

constexpr std::uint16_t kLong_ms = 60000;
constexpr std::uint16_t kEpoch = 77;
constexpr std::uint16_t kSession = 5;
constexpr std::uint16_t kChallenge = 7;
constexpr std::uint8_t kQualified = 2;  // CTR of the third frame in a row
constexpr std::uint8_t kInARow = 3;
constexpr std::uint16_t kAllMayMove = 0x3FFF;

/// A node whose host is alive, that has an open session and has heard its peers, long ago, say nothing of
/// note; every running timer has long to go, CUSTODY and STATE are due.
Local base_of(const Config& config, const NodeSetup& setup, const LayoutBlob& layout) {
  Local local;
  local.core = power_on(config, {.record = std::nullopt, .layout = layout});
  for (std::uint8_t counter = 0; counter <= kQualified; ++counter) {
    std::vector<wire::Frame> frames;
    frames.push_back(
        wire::pack(wire::HostHeartbeat{.state = wire::HostState::Run, .permit = kAllMayMove, .epoch = kEpoch},
                   {.node = 0, .counter = counter}));
    for (const std::uint8_t other : setup.nodes) {
      if (other == setup.node) continue;
      frames.push_back(wire::pack(wire::Custody{}, {.node = other, .counter = counter}));
      frames.push_back(wire::pack(wire::NodeState{}, {.node = other, .counter = counter}));
    }
    step(local.core, {.received = frames, .sensors = read(config, Grip::Open), .nvm = {}});
  }
  State& core = local.core;
  core.peers.advance(kLong_ms);
  core.gate.open(kSession);
  core.session_epoch = kEpoch;
  core.next_session = 1;
  core.timers = {};
  for (wire::Countdown* timer :
       {&core.timers.state, &core.timers.stable, &core.timers.peer_good, &core.timers.challenge,
        &core.timers.outcome, &core.timers.force, &core.timers.pneumatics, &core.timers.layout,
        &core.timers.identity, &core.timers.faults}) {
    timer->start(kLong_ms);
  }
  core.challenge = kChallenge;
  core.counters = {};
  core.send_counters = {};
  core.store = {};
  core.store.record.session_block = core.next_session + 8;
  core.store.record.boot_count = 1;
  core.faults = {};
  core.release_guard = {};
  for (ReleaseGuard::Watched* watched : {&core.release_guard.custody, &core.release_guard.state}) {
    watched->counter = kQualified;
    watched->in_a_row = kInARow;
  }
  local.stored = core.store.record;
  local.pending = {local.stored, local.stored};
  return local;
}

Measurement measured(const Config& config, Grip grip) {
  Measurement measurement;
  const Sensors sensors = read(config, grip);
  for (int i = 0; i < 2; ++i) observe(config, sensors, 1000, measurement);
  return measurement;
}

Traits::Record traits_of_record(const NvmRecord& record) {
  return {.custody = record.custody, .peer = record.peer, .token = record.token, .outcomes = record.outcomes};
}

bool answers(const Local& local) {
  const StateId id = local.core.id;
  if (id == StateId::Boot)
    return has_custody(local.stored.custody) && local.stored.custody != Custody::Decided;
  return (holds(id) || id == StateId::Resqueeze) && local.core.store.record.custody != Custody::Decided;
}

}  // namespace

NodeModel::NodeModel(NodeSetup setup, Network& network)
    : setup_(std::move(setup)), network_(network), config_(config_of(setup_.node)) {
  config_.table = setup_.table;
  config_.release_guard_enabled = setup_.release_guard;
  layout_ = blob_of(layout_of(setup_.node, setup_.nodes, setup_.misfit));
  base_ = base_of(config_, setup_, layout_);
  for (const Grip grip : {Grip::Open, Grip::Light, Grip::Full})
    measured_[static_cast<std::size_t>(grip)] = measured(config_, grip);
  lost_host_ = base_.core.host;
  lost_host_.advance(kLong_ms);
  std::vector<std::uint8_t> others;
  std::ranges::copy_if(setup_.nodes, std::back_inserter(others),
                       [this](std::uint8_t other) { return other != setup_.node; });
  demands_ = demands(config_.passive, others);
}

Local NodeModel::local(LocalId id) const {
  Local local = unpack(*packed_[id], base_);
  local.core.measurement = measured_[static_cast<std::size_t>(local.grip)];
  local.core.store.requested = local.pending_count;
  return local;
}

LocalId NodeModel::intern(Local& local) {
  const auto [place, is_new] = ids_.try_emplace(pack(local), static_cast<LocalId>(packed_.size()));
  if (is_new) {
    packed_.push_back(&place->first);
    traits_.push_back(traits_of(local));
    chatter_.emplace_back();
    repeats_.emplace_back();
  }
  return place->second;
}

Traits NodeModel::traits_of(const Local& local) const {
  const NvmRecord& wanted = local.core.store.record;
  const bool grips = local.grip == Grip::Full && setup_.node != setup_.misfit;
  Traits traits{.grips = grips,
                .holds = grips && answers(local),
                .stored = traits_of_record(local.stored),
                .wanted = traits_of_record(wanted)};
  if (local.pending_count > 0 || local.core.store.record_waits) return traits;
  const StateId id = local.core.id;
  traits.rests_holding = traits.holds && id == StateId::Hold &&
                         (wanted.custody == Custody::Sole || wanted.custody == Custody::Retained);
  const bool idle = id == StateId::Loaded || id == StateId::Ready;
  traits.rests_empty = idle && local.grip == Grip::Open && !has_custody(wanted.custody);
  return traits;
}

std::vector<wire::Frame> NodeModel::frames(const Stimulus& stimulus) const {
  std::vector<wire::Frame> frames;
  const auto next = static_cast<std::uint8_t>(kQualified + 1);
  if (stimulus.message >= 0) {
    const Saying& fact = network_.at(stimulus.message);
    frames.push_back(wire::pack(fact.custody, {.node = fact.node, .counter = next}));
    if (stimulus.peer_holds) {
      const int bit = std::countr_zero(network_.holding_state_of(fact.node));
      frames.push_back(wire::pack(network_.at(bit).state, {.node = fact.node, .counter = next}));
    }
  }
  switch (stimulus.demand) {
    case Demand::None:
      break;
    case Demand::GlobalHold:
      frames.push_back(wire::pack(wire::GlobalHold{}, {.node = 0, .counter = 0}));
      break;
    case Demand::Write:
      frames.push_back(wire::pack_segment({{wire::MessageType::TransferRequest, setup_.node},
                                           {0x03, static_cast<std::uint8_t>(wire::Service::Write), 1, 0}}));
      break;
    case Demand::Command: {
      wire::Command command{.op = stimulus.op, .argument = stimulus.argument, .session = kSession};
      if (stimulus.op == wire::Op::Arm) command = wire::arm_command(base_.core.layouts.crc, kEpoch);
      if (stimulus.op == wire::Op::Squeeze && !config_.passive) {
        command.a = kSqueeze_dn;
        command.b = kPermit_dn;
      }
      if (stimulus.op == wire::Op::ManualRelease) command.b = kChallenge;
      command.sequence = 1;
      frames.push_back(wire::pack(command, {.node = setup_.node}));
      break;
    }
  }
  return frames;
}

Said NodeModel::listen(const SendQueue& queue) {
  Said said = 0;
  const auto add = [&said](std::optional<int> bit) {
    if (bit) said |= Said{1} << *bit;
  };
  for (const wire::Frame& frame : queue.view()) {
    const auto identifier = wire::identify(frame);
    if (!identifier) continue;
    if (identifier->type == wire::MessageType::Custody) {
      if (const auto custody = wire::parse<wire::Custody>(frame))
        add(network_.heard(setup_.node, custody->message));
    } else if (identifier->type == wire::MessageType::State) {
      if (const auto state = wire::parse<wire::NodeState>(frame))
        add(network_.heard(setup_.node, state->message));
    }
  }
  return said;
}

NodeModel::Effect NodeModel::step(Local& local, const Stimulus& stimulus) {
  ++steps_;
  State& core = local.core;
  if (!stimulus.host_alive) core.host = lost_host_;
  if ((stimulus.fired & kStateTime) != 0) core.timers.state.stop();
  if ((stimulus.fired & kStable) != 0) core.timers.stable.stop();
  if ((stimulus.fired & kPeerGood) != 0) {
    core.timers.peer_good.stop();
    core.release_guard.good_ms = kLong_ms - 1;
  }
  if (stimulus.demand == Demand::None && stimulus.argument > 0) {
    core.timers.outcome.stop();
    core.outcome_next = static_cast<std::uint8_t>(stimulus.argument - 1);
  }
  core.bad_hold_ms = (stimulus.fired & kBadHold) != 0 ? 100 : 0;
  const std::vector<wire::Frame> received = frames(stimulus);
  Inputs inputs{.received = received,
                .sensors = read(config_, local.grip),
                .nvm = {.done = static_cast<std::uint16_t>(core.store.requested - local.pending_count)}};
  inputs.sensors.local_enable = stimulus.local_enable;
  Outputs outputs;
  core::step(core, inputs, outputs);
  if (outputs.nvm && outputs.nvm->record) {
    const std::size_t slot = std::min<std::size_t>(local.pending_count, local.pending.size() - 1);
    local.pending[slot] = *outputs.nvm->record;
    local.pending_count = static_cast<std::uint8_t>(slot + 1);
  }
  local.pull = config_.passive ? passive_pull(core.store.record.custody) : pull_of(config_, outputs.valves);

  Effect effect{.said = listen(outputs.send)};
  const auto may_open = [](Custody custody) { return !has_custody(custody) || custody == Custody::Decided; };
  if (outputs.valves.spool == Spool::Open && !may_open(local.stored.custody))
    effect.fault = Fault::OpensUndecided;
  for (Said rest = effect.said; rest != 0; rest &= rest - 1) {
    const Saying& saying = network_.at(std::countr_zero(rest));
    if (saying.holds_well || saying.custody.fact != wire::Fact::Take) continue;
    const bool latched = local.stored.custody == Custody::Latched &&
                         local.stored.token == saying.custody.token &&
                         local.stored.peer == saying.custody.peer;
    if (!latched) effect.fault = Fault::TakesUnlatched;
  }
  return effect;
}

void NodeModel::restart(Local& local, unsigned stored) const {
  if (stored > 0) local.stored = local.pending[stored - 1];
  local.pending_count = 0;
  local.core = power_on(config_, {.record = local.stored, .layout = layout_});
  local.pull = config_.passive ? passive_pull(local.stored.custody) : Pull::Stay;
}

NodeModel::Effect NodeModel::apply(Local& local, const Stimulus& stimulus) {
  switch (stimulus.what) {
    case Happening::Step:
      return step(local, stimulus);
    case Happening::Stored:
      local.stored = local.pending[0];
      local.pending[0] = local.pending[1];
      --local.pending_count;
      return {};
    case Happening::Crash:
      restart(local, stimulus.argument);
      return {};
    case Happening::Jaws:
      local.grip = pulled(local.grip, local.pull);
      return {};
  }
  return {};
}

std::vector<Move> NodeModel::work_out(LocalId id, int message, bool peer_holds) {
  std::vector<Move> found;
  const Local from = local(id);
  const auto consider = [&](Stimulus stimulus) {
    stimulus.message = static_cast<std::int8_t>(message);
    stimulus.peer_holds = peer_holds;
    Local to = from;
    const Effect effect = apply(to, stimulus);
    const Move move{.next = intern(to), .said = effect.said, .stimulus = stimulus, .fault = effect.fault};
    if (move.next == id && move.said == 0 && move.fault == Fault::None) return;
    for (Move& known : found) {
      if (known.next != move.next || known.said != move.said || known.fault != move.fault) continue;
      if (known.stimulus.is_mishap() && !stimulus.is_mishap()) known = move;
      return;
    }
    found.push_back(move);
  };
  if (message < 0) {
    if (from.pending_count > 0) consider({.what = Happening::Stored});
    if (pulled(from.grip, from.pull) != from.grip) consider({.what = Happening::Jaws});
    for (std::uint8_t stored = 0; stored <= from.pending_count; ++stored)
      consider({.what = Happening::Crash, .argument = stored});
    for (std::uint8_t outcome = 1; outcome <= from.core.store.record.outcomes.size(); ++outcome)
      consider({.argument = outcome});
  }
  for (const bool host_alive : {true, false}) {
    for (std::uint8_t fired = 0; fired < kAllFired; ++fired)
      consider({.fired = fired, .host_alive = host_alive});
  }
  for (Stimulus demand : demands_) {
    const bool offers = demand.demand == Demand::Command && demand.op == wire::Op::Offer;
    if (offers && from.core.store.record.handoff_number >= setup_.tokens) continue;
    consider(demand);
    demand.fired = kStable;
    consider(demand);
  }
  return found;
}

const std::vector<Move>& NodeModel::moves(LocalId id, int message, bool peer_holds) {
  const std::uint64_t key =
      std::uint64_t{id} << 8 | static_cast<std::uint64_t>(message + 1) << 1 | (peer_holds ? 1U : 0U);
  const auto known = moves_.find(key);
  if (known != moves_.end()) return known->second;
  std::vector<Move> found = work_out(id, message, peer_holds);
  return moves_.emplace(key, std::move(found)).first->second;
}

Said NodeModel::chatter(LocalId id) {
  if (chatter_[id]) return *chatter_[id];
  Said said = 0;
  for (const Move& move : moves(id, -1, false)) {
    if (move.next == id && !move.stimulus.is_mishap()) said |= move.said;
  }
  chatter_[id] = said;
  return said;
}

Said NodeModel::repeats(LocalId id) {
  std::optional<Said>& known = repeats_[id];
  if (known) return *known;
  Said said = 0;
  for (const std::uint8_t fired : {std::uint8_t{0}, std::uint8_t{kStable}}) {
    for (std::uint8_t outcome = 0; outcome <= base_.stored.outcomes.size(); ++outcome) {
      Local to = local(id);
      said |= apply(to, {.argument = outcome, .fired = fired}).said;
    }
  }
  repeats_[id] = said;
  return said;
}

std::string NodeModel::describe(LocalId id) const {
  const Local l = local(id);
  const auto record = [](const NvmRecord& r) {
    std::string text = custody_name(r.custody);
    if (has_custody(r.custody) || r.custody == Custody::Released)
      text += "(" + std::to_string(r.token) + " " + station(r.peer) + ")";
    return text;
  };
  std::string text = state_name(l.core.id) + ", jaws " + grip_name(l.grip) + ", stored " + record(l.stored);
  for (std::size_t i = 0; i < l.pending_count; ++i) text += ", storing " + record(l.pending[i]);
  if (l.core.store.record_waits) text += ", to store " + record(l.core.store.record);
  text += ", says " + fact_name(l.core.announced.fact);
  if (held_faults(l.core.faults) != 0) text += ", faulty";
  return text;
}

void NodeModel::run(Local& local, Stimulus stimulus) {
  apply(local, stimulus);
  local = this->local(intern(local));
}

LocalId NodeModel::ready() {
  Local local = base_;
  local.grip = Grip::Open;
  restart(local, 0);
  local = this->local(intern(local));
  const auto command = [&](wire::Op op) {
    run(local, {.demand = Demand::Command, .op = op, .local_enable = true});
  };
  for (int i = 0; i < 2; ++i) {
    run(local, {});
    if (local.pending_count > 0) run(local, {.what = Happening::Stored});
  }
  command(wire::Op::Arm);
  run(local, {});
  if (local.core.id != StateId::Ready)
    throw std::logic_error("a node that does not get READY: " + describe(intern(local)));
  return intern(local);
}

LocalId NodeModel::loaded() {
  Local local = this->local(ready());
  if (config_.passive) local.grip = Grip::Full;
  const auto command = [&](wire::Op op) {
    run(local, {.demand = Demand::Command, .op = op, .local_enable = true});
  };
  command(wire::Op::CloseLight);
  if (config_.passive) local.pull = Pull::Stay;
  for (int i = 0; i < 4 && (local.core.id != StateId::Seated || local.pending_count > 0); ++i) {
    run(local, {});
    if (local.pending_count > 0) run(local, {.what = Happening::Stored});
    if (!config_.passive) run(local, {.what = Happening::Jaws});
  }
  command(wire::Op::Squeeze);
  for (int i = 0; i < 4; ++i) {
    if (!config_.passive) run(local, {.what = Happening::Jaws});
    run(local, {.fired = kStable});
  }
  if (local.pending_count > 0) run(local, {.what = Happening::Stored});
  run(local, {.fired = kStable});
  const LocalId id = intern(local);
  if (!traits(id).rests_holding) throw std::logic_error("a node that does not hold: " + describe(id));
  return id;
}

}  // namespace pinjaw::core::model
