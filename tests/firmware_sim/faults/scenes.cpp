#include "tests/firmware_sim/faults/scenes.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <optional>

#include "firmware_sim/core/authentication.hpp"
#include "protocol/wire/names.hpp"
#include "protocol/wire/reception.hpp"
#include "protocol/wire/seal.hpp"

namespace pinjaw::core::test {
namespace {

constexpr wire::SqueezeForces kSqueeze{520, 1400};
constexpr std::array kBesidesAt_ms = {10, 40, 70};  // when what nothing depends on is heard

using wire::MessageType;

/// The way to a scene: a bench that remembers what each station hears.
class Stage {
 public:
  explicit Stage(Framing framing) : framing_(framing) {
    bench.on_delivery = [this](std::uint8_t to, const std::vector<wire::Frame>& frames) {
      history_[to].insert(history_[to].end(), frames.begin(), frames.end());
    };
    if (framing != Framing::Plain) bench.share_key(kSceneKey, framing == Framing::CanFd);
  }
  Stage(const Stage&) = delete;
  Stage& operator=(const Stage&) = delete;

  /// Everyone has its layout; every message of the table has been heard once.
  void warm_up() {
    bench.load_all();
    if (framing_ == Framing::CanFd) bench.run(700);  // until all know each other
    for (const std::uint8_t node : {kArm, kPedestal, kPallet}) {
      bench.inject(from_node(bench, node, wire::pack(wire::GlobalHold{}, {.node = node})));
      bench.inject(from_node(bench, node, wire::pack(wire::FaultReport{}, {.node = node})));
      bench.inject(bench.from_host(wire::pack(wire::Command{.op = wire::Op::Disarm}, {.node = node})));
      bench.inject(bench.from_host(question(node)));
    }
    bench.inject(bench.from_host(wire::pack(wire::HostTime{}, {.node = 0})));
    bench.run(600);
  }

  /// As it is now, or ends the program: a scene that is not what it says proves nothing.
  Scene scene(StateId state, std::uint8_t node, std::uint8_t peer) {
    must(bench.at(node).id() == state, state, node);
    return take(state, node, peer);
  }

  Scene take(StateId state, std::uint8_t node, std::uint8_t peer, std::vector<wire::Frame> before = {}) {
    Scene scene{.state = state,
                .node = node,
                .peer = peer,
                .framing = framing_,
                .station = bench.at(node),
                .before = std::move(before),
                .heard = {},
                .history = history_[node],
                .besides = {}};
    Bench goes_on = bench;
    for (int i = 0; i < 3; ++i) say_besides(goes_on, scene);
    goes_on.on_delivery = [&scene](std::uint8_t to, const std::vector<wire::Frame>& frames) {
      if (to == scene.node) scene.heard.push_back(frames);
    };
    for (const wire::Frame& frame : scene.before) goes_on.inject(frame);
    for (int ms = 0; ms < kSceneLength_ms; ++ms) {
      const auto* const at = std::find(kBesidesAt_ms.begin(), kBesidesAt_ms.end(), ms);
      if (at != kBesidesAt_ms.end()) say_harmless(goes_on, peer, static_cast<std::uint8_t>(ms));
      goes_on.run(1);
    }
    if (!scene.before.empty()) scene.heard.front().erase(scene.heard.front().begin());
    return scene;
  }

  void must(bool holds, StateId state, std::uint8_t node) {
    if (holds) return;
    std::fprintf(stderr, "no way to %s: node %d is %s\n", wire::to_string(state), node,
                 wire::to_string(bench.at(node).id()));
    std::abort();
  }

  Bench bench;

 private:
  static wire::Frame question(std::uint8_t node) {
    return wire::pack_segment({{MessageType::TransferRequest, node}, {2, 0x24, 1}});
  }

  wire::Frame from_node(Bench& at, std::uint8_t node, const wire::Frame& frame) const {
    return framing_ == Framing::CanFd ? at.at(node).core.link.seal(kSceneKey, frame) : frame;
  }

  void say_besides(Bench& at, Scene& scene) const {
    const wire::Command command = right_command(scene, scene.station, told_in(scene), scene.before.size());
    scene.besides[MessageType::GlobalHold].push_back(
        from_node(at, scene.peer, wire::pack(wire::GlobalHold{}, {.node = scene.peer})));
    scene.besides[MessageType::Command].push_back(at.from_host(wire::pack(command, {.node = scene.node})));
    scene.besides[MessageType::TransferRequest].push_back(at.from_host(question(scene.node)));
  }

  /// The messages of `peer` and of the host that no controller acts on, and a fault that is none.
  void say_harmless(Bench& at, std::uint8_t peer, std::uint8_t now) const {
    std::uint8_t& faults = at.at(peer).core.send_counters.fault;
    faults = wire::next_counter(faults);
    const wire::Label label{.node = peer, .counter = static_cast<std::uint8_t>(now % wire::kCounterModulus)};
    for (const wire::Frame& frame :
         {wire::pack(wire::FaultReport{}, {.node = peer, .counter = faults}),
          wire::pack(wire::Acknowledge{}, {.node = peer}), wire::pack(wire::Pneumatics{}, label),
          wire::pack(wire::LayoutStatus{}, label), wire::pack(wire::Identity{}, label),
          wire::pack_segment({{MessageType::TransferResponse, peer}, {2, 0x64, 1}})}) {
      at.inject(from_node(at, peer, frame));
    }
    at.inject(
        at.from_host(wire::pack(wire::HostTime{.time_us = now}, {.node = 0, .counter = label.counter})));
  }

  Framing framing_;
  std::array<std::vector<wire::Frame>, 4> history_;
};

Scene boot(Framing framing) {
  Stage stage(framing);
  stage.warm_up();
  stage.bench.arm().power_on_again();
  return stage.scene(StateId::Boot, kArm, kPedestal);
}

Scene unconfigured(Framing framing) {
  Stage stage(framing);
  stage.warm_up();
  stage.bench.arm().memory.layout = {};
  stage.bench.arm().power_on_again();
  stage.bench.run(200);
  return stage.scene(StateId::Unconfigured, kArm, kPedestal);
}

Scene loaded(Framing framing, std::uint8_t node = kArm, std::uint8_t peer = kPedestal) {
  Stage stage(framing);
  stage.warm_up();
  return stage.scene(StateId::Loaded, node, peer);
}

Scene fault_hold(Framing framing, bool on_the_way_out) {
  Stage stage(framing);
  stage.warm_up();
  stage.bench.load_gripper(kArm);
  stage.bench.arm().jaw.offset_a_mbar = 2000;
  stage.bench.reaches(kArm, StateId::FaultHold);
  stage.bench.arm().jaw.offset_a_mbar = 0;
  stage.bench.run(100);
  if (!on_the_way_out) return stage.scene(StateId::FaultHold, kArm, kPedestal);
  // CLEAR_FAULT leads to RECOVER, where the same millisecond's next frame finds it.
  const auto answer = stage.bench.arm_session(kArm);
  stage.must(answer && answer->result == wire::CommandResult::Ok, StateId::Recover, kArm);
  wire::Command clear = wire::plain_command(wire::Op::ClearFault);
  clear.session = answer->session;
  clear.sequence = answer->next_sequence;
  clear = stage.bench.sealed_for(kArm, clear);
  return stage.take(StateId::Recover, kArm, kPedestal,
                    {stage.bench.from_host(wire::pack(clear, {.node = kArm}))});
}

Scene fault_empty(Framing framing) {
  Stage stage(framing);
  stage.warm_up();
  stage.bench.load_gripper(kArm);
  stage.bench.arm_session(kPedestal);
  stage.bench.command(kArm, wire::offer_command(kPedestal));
  stage.bench.run(100);
  stage.bench.command(kPedestal, wire::accept_command(kArm));
  stage.bench.reaches(kPedestal, StateId::FaultEmpty);  // nothing is between its jaws
  stage.bench.run(50);
  return stage.scene(StateId::FaultEmpty, kPedestal, kArm);
}

/// A state of a handoff from `giver` to `receiver`, `later_ms` after its beginning.
struct Way {
  std::uint8_t giver = kArm;
  std::uint8_t receiver = kPedestal;
  StateId state = StateId::Hold;
  int later_ms = 0;
};

bool is_givers(StateId state) {
  return state == StateId::Hold || state == StateId::Offered || state == StateId::Relax ||
         state == StateId::Resqueeze || state == StateId::Opening;
}

/// As far as `way.state`; then the node that is in it is looked at.
Scene in_handoff(Framing framing, const Way& way) {
  Stage stage(framing);
  Bench& bench = stage.bench;
  stage.warm_up();
  const bool from_pallet = way.giver == kPallet;
  from_pallet ? bench.load_pallet() : bench.load_gripper(way.giver);
  // a passive station has its part as soon as it is there
  const bool comes = way.receiver != kPallet || way.state != StateId::Seating;
  bench.bring_part(way.receiver, comes);
  bench.arm_session(way.receiver);
  const std::uint8_t node = is_givers(way.state) ? way.giver : way.receiver;
  const std::uint8_t peer = is_givers(way.state) ? way.receiver : way.giver;
  const auto there = [&] {
    if (bench.at(node).id() != way.state) return false;
    bench.run(way.later_ms);
    return true;
  };
  if (way.state == StateId::Hold && there()) return stage.scene(way.state, node, peer);
  bench.command(way.giver, wire::offer_command(way.receiver));
  bench.run(100);
  if (way.state == StateId::Ready && there()) return stage.scene(way.state, node, peer);  // it may accept
  bench.command(way.receiver, wire::accept_command(way.giver));
  if (there()) return stage.scene(way.state, node, peer);
  bench.reaches(way.receiver, StateId::Seated);
  bench.run(50);
  if (there()) return stage.scene(way.state, node, peer);
  bench.squeeze(way.receiver);
  if (there()) return stage.scene(way.state, node, peer);
  bench.reaches(way.receiver, StateId::Taken);
  if (there()) return stage.scene(way.state, node, peer);
  bench.reaches(way.giver, StateId::Relax);
  if (there()) return stage.scene(way.state, node, peer);
  if (way.state == StateId::Resqueeze) {
    bench.run(150);  // relaxed, so that there is something to squeeze again
    bench.command(way.giver, wire::plain_command(wire::Op::Abort));
  } else {
    bench.reaches(way.giver, StateId::Opening);
  }
  if (there()) return stage.scene(way.state, node, peer);
  stage.must(false, way.state, node);
  std::abort();
}

std::vector<Scene> make_scenes(Framing framing) {
  using enum wire::State;
  const auto handoff = [framing](StateId state, int later_ms) {
    return in_handoff(framing, {.state = state, .later_ms = later_ms});
  };
  std::vector<Scene> all;
  all.push_back(boot(framing));
  all.push_back(fault_hold(framing, true));  // RECOVER
  all.push_back(unconfigured(framing));
  all.push_back(loaded(framing));
  all.push_back(handoff(Ready, 50));
  all.push_back(handoff(Seating, 10));
  all.push_back(handoff(Seated, 20));
  all.push_back(handoff(Squeezing, 10));
  all.push_back(handoff(Taken, 5));
  all.push_back(handoff(Hold, 50));
  all.push_back(handoff(Offered, 30));
  all.push_back(handoff(Relax, 10));
  all.push_back(handoff(Resqueeze, 5));
  all.push_back(handoff(Opening, 0));
  all.push_back(fault_hold(framing, false));
  all.push_back(fault_empty(framing));
  return all;
}

std::vector<Scene> make_passive_scenes() {
  using enum wire::State;
  std::vector<Scene> all;
  all.push_back(loaded(Framing::Plain, kPallet, kArm));
  for (const StateId state : {Ready, Seating, Seated, Squeezing, Taken}) {
    all.push_back(
        in_handoff(Framing::Plain, {.giver = kArm, .receiver = kPallet, .state = state, .later_ms = 5}));
  }
  // It has nothing to open: OPENING is over in the millisecond in which it begins.
  for (const StateId state : {Hold, Offered, Relax, Resqueeze}) {
    all.push_back(
        in_handoff(Framing::Plain, {.giver = kPallet, .receiver = kArm, .state = state, .later_ms = 5}));
  }
  return all;
}

}  // namespace

const std::vector<Scene>& scenes(Framing framing) {
  static std::array<std::optional<std::vector<Scene>>, 3> made;
  auto& all = made[static_cast<std::size_t>(framing)];
  if (!all) all = make_scenes(framing);
  return *all;
}

const std::vector<Scene>& passive_scenes() {
  static const std::vector<Scene> made = make_passive_scenes();
  return made;
}

wire::Command right_command(const Scene& scene, const Station& station, wire::Command command,
                            std::size_t waiting) {
  const State& core = station.core;
  const bool arms = command.op == wire::Op::Arm;
  if (arms) {
    command = wire::arm_command(core.layouts.crc, core.host.epoch());
    command.sequence = 101;  // of no ARM before
  } else {
    command.session = core.gate.session();
    command.sequence = static_cast<std::uint8_t>(core.gate.next_sequence() + waiting);
  }
  if (scene.framing == Framing::Plain) return command;
  return wire::sealed(kSceneKey, scene.node, command,
                      {.number = arms ? next_session_number(core) : core.next_session,
                       .epoch = arms ? core.host.epoch() : core.session_epoch});
}

wire::Command told_in(const Scene& scene) {
  if (!scene.station.core.gate.armed()) return wire::plain_command(wire::Op::Arm);
  switch (scene.state) {
    case StateId::Ready:
      return wire::accept_command(scene.peer);
    case StateId::Seated:
      return wire::squeeze_command(scene.station.config.passive ? wire::SqueezeForces{} : kSqueeze);
    case StateId::Hold:
      return wire::offer_command(scene.peer);
    case StateId::Seating:
    case StateId::Offered:
    case StateId::Relax:
    case StateId::FaultEmpty:
      return wire::plain_command(wire::Op::Abort);
    default:
      return wire::plain_command(wire::Op::ClearFault);
  }
}

}  // namespace pinjaw::core::test
