#include "tests/firmware_sim/faults/scenes.hpp"

#include <cstdio>
#include <cstdlib>
#include <string>

#include "protocol/wire/names.hpp"

namespace pinjaw::core::test {
namespace {

constexpr wire::SqueezeForces kSqueeze{520, 1400};

/// The way to a scene: a bench that remembers what each station hears.
class Stage {
 public:
  Stage() {
    bench.on_delivery = [this](std::uint8_t to, const std::vector<wire::Frame>& frames) {
      history_[to].insert(history_[to].end(), frames.begin(), frames.end());
    };
  }
  Stage(const Stage&) = delete;
  Stage& operator=(const Stage&) = delete;

  /// Everyone has its layout; every message of the table has been heard once.
  void warm_up() {
    bench.load_all();
    for (const std::uint8_t node : {kArm, kPedestal, kPallet}) {
      bench.inject(wire::pack(wire::GlobalHold{}, {.node = node}));
      bench.inject(wire::pack(wire::FaultReport{}, {.node = node}));
      bench.inject(wire::pack(wire::Command{.op = wire::Op::Disarm}, {.node = node}));
      bench.inject(wire::pack_segment({{wire::MessageType::TransferRequest, node}, {2, 0x24, 1}}));
    }
    bench.inject(wire::pack(wire::HostTime{}, {.node = 0}));
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
                .station = bench.at(node),
                .before = std::move(before),
                .heard = {},
                .history = history_[node]};
    Bench goes_on = bench;
    goes_on.on_delivery = [&scene](std::uint8_t to, const std::vector<wire::Frame>& frames) {
      if (to == scene.node) scene.heard.push_back(frames);
    };
    for (const wire::Frame& frame : scene.before) goes_on.inject(frame);
    goes_on.run(kSceneLength_ms);
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
  std::array<std::vector<wire::Frame>, 4> history_;
};

Scene boot() {
  Stage stage;
  stage.warm_up();
  stage.bench.arm().power_on_again();
  return stage.scene(StateId::Boot, kArm, kPedestal);
}

Scene unconfigured() {
  Stage stage;
  stage.warm_up();
  stage.bench.arm().memory.layout = {};
  stage.bench.arm().power_on_again();
  stage.bench.run(200);
  return stage.scene(StateId::Unconfigured, kArm, kPedestal);
}

Scene loaded() {
  Stage stage;
  stage.warm_up();
  return stage.scene(StateId::Loaded, kArm, kPedestal);
}

Scene fault_hold(bool on_the_way_out) {
  Stage stage;
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
  return stage.take(StateId::Recover, kArm, kPedestal, {wire::pack(clear, {.node = kArm})});
}

Scene fault_empty() {
  Stage stage;
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

/// The arm gives its part to the pedestal, as far as `until` says; then `node` is looked at.
Scene in_handoff(StateId state, std::uint8_t node, int later_ms) {
  Stage stage;
  Bench& bench = stage.bench;
  stage.warm_up();
  bench.load_gripper(kArm);
  bench.bring_part(kPedestal, true);
  bench.arm_session(kPedestal);
  const auto there = [&] {
    if (bench.at(node).id() != state) return false;
    bench.run(later_ms);
    return true;
  };
  const std::uint8_t peer = node == kArm ? kPedestal : kArm;
  if (there()) return stage.scene(state, node, peer);
  bench.command(kArm, wire::offer_command(kPedestal));
  bench.run(100);
  bench.command(kPedestal, wire::accept_command(kArm));
  if (there()) return stage.scene(state, node, peer);
  bench.reaches(kPedestal, StateId::Seated);
  bench.run(50);
  if (there()) return stage.scene(state, node, peer);
  bench.command(kPedestal, wire::squeeze_command(kSqueeze));
  if (there()) return stage.scene(state, node, peer);
  bench.reaches(kPedestal, StateId::Taken);
  if (there()) return stage.scene(state, node, peer);
  bench.reaches(kArm, StateId::Relax);
  if (there()) return stage.scene(state, node, peer);
  if (state == StateId::Resqueeze) {
    bench.run(150);  // relaxed, so that there is something to squeeze again
    bench.command(kArm, wire::plain_command(wire::Op::Abort));
  } else {
    bench.reaches(kArm, StateId::Opening);
  }
  if (there()) return stage.scene(state, node, peer);
  stage.must(false, state, node);
  std::abort();
}

std::vector<Scene> make_scenes() {
  using enum wire::State;
  std::vector<Scene> all;
  all.push_back(boot());
  all.push_back(fault_hold(true));  // RECOVER
  all.push_back(unconfigured());
  all.push_back(loaded());
  all.push_back(in_handoff(Ready, kPedestal, 50));
  all.push_back(in_handoff(Seating, kPedestal, 10));
  all.push_back(in_handoff(Seated, kPedestal, 20));
  all.push_back(in_handoff(Squeezing, kPedestal, 10));
  all.push_back(in_handoff(Taken, kPedestal, 5));
  all.push_back(in_handoff(Hold, kArm, 50));
  all.push_back(in_handoff(Offered, kArm, 30));
  all.push_back(in_handoff(Relax, kArm, 10));
  all.push_back(in_handoff(Resqueeze, kArm, 5));
  all.push_back(in_handoff(Opening, kArm, 5));
  all.push_back(fault_hold(false));
  all.push_back(fault_empty());
  return all;
}

bool is_acknowledgement(const wire::Frame& frame) {
  const auto identifier = wire::identify(frame);
  return identifier && identifier->type == wire::MessageType::Acknowledge;
}

}  // namespace

const std::vector<Scene>& scenes() {
  static const std::vector<Scene> made = make_scenes();
  return made;
}

Moment moment_of(Station& station, const std::vector<wire::Frame>& frames) {
  station.step(frames);
  Moment moment{.state = station.id(),
                .valves = station.outputs.valves,
                .nvm = station.outputs.nvm,
                .announced = station.core.announced,
                .said = {}};
  for (const wire::Frame& frame : station.outputs.send.view()) {
    if (!is_acknowledgement(frame)) moment.said.push_back(frame);
  }
  return moment;
}

std::optional<std::string> difference(const Moment& one, const Moment& other) {
  if (one.state != other.state) {
    return std::string("state ") + wire::to_string(one.state) + ", " + wire::to_string(other.state);
  }
  if (!(one.valves == other.valves)) return "valves";
  if (one.nvm.has_value() != other.nvm.has_value()) return "a store";
  if (one.nvm && (one.nvm->record != other.nvm->record || one.nvm->layout != other.nvm->layout)) {
    return "what is stored";
  }
  if (!(one.announced == other.announced)) return "custody that is announced";
  if (one.said != other.said) return "frames";
  return std::nullopt;
}

std::vector<Moment> play(const Scene& scene, int ms, const Disturbance& disturb) {
  Station station = scene.station;
  std::vector<Moment> moments;
  for (int i = 0; i < ms; ++i) {
    std::vector<wire::Frame> frames = scene.heard[static_cast<std::size_t>(i)];
    if (disturb) disturb(i, frames);
    if (i == 0) frames.insert(frames.begin(), scene.before.begin(), scene.before.end());
    moments.push_back(moment_of(station, frames));
  }
  return moments;
}

bool has_counter(const wire::Frame& frame) {
  const auto identifier = wire::identify(frame);
  return identifier && wire::spec_of(identifier->type).protection == wire::Protection::Counter;
}

std::optional<std::uint8_t> last_counter(const Scene& scene, int ms, const wire::Frame& like) {
  std::optional<std::uint8_t> last;
  const auto look = [&](const std::vector<wire::Frame>& frames) {
    for (const wire::Frame& frame : frames) {
      if (frame.id == like.id) last = frame.data[1] & 0xFU;
    }
  };
  if (scene.state != StateId::Boot) look(scene.history);  // a reset forgets it
  for (int i = 0; i < ms; ++i) look(scene.heard[static_cast<std::size_t>(i)]);
  return last;
}

wire::Frame sealed(wire::Frame frame) {
  if (const auto identifier = wire::identify(frame)) {
    const wire::Identifier who = *identifier;
    if (wire::spec_of(who.type).protection != wire::Protection::None) {
      frame.data[0] = wire::detail::checksum(who, frame.data);
    }
  }
  return frame;
}

wire::Frame with_counter(wire::Frame frame, std::uint8_t counter) {
  frame.data[1] = static_cast<std::uint8_t>((frame.data[1] & 0xF0U) | counter);
  return sealed(frame);
}

}  // namespace pinjaw::core::test
