#include "tests/firmware_sim/faults/bad_frames.hpp"

#include <array>

#include "protocol/wire/dispatch.hpp"
#include "protocol/wire/names.hpp"

namespace pinjaw::core::test {
namespace {

constexpr int kWatched_ms = 80;  // past every freshness limit of a peer

using wire::MessageType;

/// Taken by anyone at any time, in the safe direction (section 2.1), or without a checksum of its own.
bool is_exempt(const wire::Frame& frame) {
  const auto type = type_of(frame);
  if (!type) return false;
  if (*type == MessageType::GlobalHold || *type == MessageType::TransferRequest ||
      *type == MessageType::TransferResponse) {
    return true;
  }
  const auto command = wire::parse<wire::Command>(frame);
  return command && command->message.op == wire::Op::Hold;
}

/// A frame that was heard before `ms`, preferably a rare one.
const wire::Frame& some_heard(const Scene& scene, int ms, const Choose& choose) {
  if (ms > 0 && choose(2) == 0) {
    const auto& frames = scene.heard[choose(static_cast<std::uint32_t>(ms))];
    if (!frames.empty()) return frames[choose(static_cast<std::uint32_t>(frames.size()))];
  }
  return scene.history[choose(static_cast<std::uint32_t>(scene.history.size()))];
}

std::uint16_t any(const Choose& choose) {
  return static_cast<std::uint16_t>(choose(0x10000));
}

wire::Command any_command(const Choose& choose) {
  return {.sequence = static_cast<std::uint8_t>(choose(256)),
          .op = static_cast<wire::Op>(2 + choose(9)),
          .argument = static_cast<std::uint8_t>(choose(16)),
          .session = any(choose),
          .a = static_cast<std::uint16_t>(choose(4096)),
          .b = static_cast<std::uint16_t>(choose(4096))};
}

/// Whether `counter` is one of the next three after what the scene's controller heard before `ms`, or it has
/// just started and has not heard three yet: then nothing tells a replayed frame from a first one.
bool is_next(const Scene& scene, int ms, const wire::Frame& frame, unsigned counter) {
  const auto last = last_counter(scene, ms, frame);
  if (!last || scene.state == StateId::Boot) return true;
  const unsigned step = (wire::kCounterModulus + counter - *last) % wire::kCounterModulus;
  return step >= 1 && step <= wire::CounterCheck::kLargestStep;
}

wire::Frame flipped(wire::Frame frame, const Choose& choose) {
  for (std::uint32_t flips = 1 + choose(3); flips > 0; --flips) {
    const std::uint32_t bit = choose(64);
    frame.data[bit / 8] = static_cast<std::uint8_t>(frame.data[bit / 8] ^ (1U << bit % 8));
  }
  return frame;
}

wire::Frame garbled(wire::Frame frame, const Choose& choose) {
  for (std::uint8_t& byte : frame.data) byte = static_cast<std::uint8_t>(choose(256));
  if (frame.data[0] == sealed(frame).data[0]) frame.data[0] = static_cast<std::uint8_t>(~frame.data[0]);
  return frame;
}

/// A node's word that it holds, gives back or has released, of node `from` to `to`.
wire::Custody any_custody(std::uint8_t to, const Choose& choose) {
  constexpr std::array kFacts = {wire::Fact::Offer, wire::Fact::Take, wire::Fact::Released,
                                 wire::Fact::Retain};
  return {.fact = kFacts[choose(4)], .peer = to, .token = any(choose), .pair = any(choose), .f_low_n = 60};
}

wire::Frame of_foreign_node(const Scene& scene, const Choose& choose) {
  constexpr std::uint8_t kNobody = 9;
  const wire::Label label{.node = kNobody, .counter = static_cast<std::uint8_t>(choose(15))};
  switch (choose(3)) {
    case 0:
      return wire::pack(any_custody(scene.node, choose), label);
    case 1:
      return wire::pack(wire::NodeState{.state = StateId::Taken, .hold_stable = true, .f_low_dn = 900},
                        label);
    default:
      return wire::pack(
          wire::FaultReport{
              .code = wire::FaultCode::OverForce, .severity = wire::Severity::Hold, .active = true},
          label);
  }
}

/// Its checksum is right and something else is not.
std::optional<wire::Frame> reserved(wire::Frame frame, const Choose& choose) {
  const std::uint32_t bit = 8 + choose(56);
  frame.data[bit / 8] = static_cast<std::uint8_t>(frame.data[bit / 8] ^ (1U << bit % 8));
  frame = sealed(frame);
  const bool refused = wire::dispatch(frame, [](const auto&) {}).has_value();
  return refused ? std::optional(frame) : std::nullopt;
}

std::optional<wire::Frame> old_command(const Scene& scene, int ms, const Choose& choose) {
  std::vector<wire::Frame> commands;
  const auto look = [&](const std::vector<wire::Frame>& frames) {
    for (const wire::Frame& frame : frames) {
      const auto command = wire::parse<wire::Command>(frame);
      const bool moves =
          command && command->message.op != wire::Op::Hold && command->message.op != wire::Op::Arm;
      if (moves && command->label.node == scene.node) commands.push_back(frame);
    }
  };
  look(scene.history);
  if (ms > 0) look(scene.before);
  if (commands.empty()) return std::nullopt;
  return commands[choose(static_cast<std::uint32_t>(commands.size()))];
}

std::optional<wire::Frame> made(const Scene& scene, Badness kind, int ms, const Choose& choose) {
  wire::Frame frame = some_heard(scene, ms, choose);
  const bool exempt = is_exempt(frame);
  switch (kind) {
    case Badness::Corrupted:
    case Badness::Garbled: {
      const auto type = type_of(frame);
      if (type && wire::spec_of(*type).protection == wire::Protection::None) return std::nullopt;
      const wire::Frame bad = kind == Badness::Corrupted ? flipped(frame, choose) : garbled(frame, choose);
      return bad == frame ? std::nullopt : std::optional(bad);
    }
    case Badness::Misaddressed: {
      const std::uint32_t own = frame.id;
      if (exempt && type_of(frame) != MessageType::GlobalHold) return std::nullopt;
      frame.id = choose(0x600);
      return frame.id == own ? std::nullopt : std::optional(frame);
    }
    case Badness::Length:
      frame.length = static_cast<std::uint8_t>(choose(8));
      return frame;
    case Badness::Remote:
      frame.kind = wire::FrameKind::Remote;
      return frame;
    case Badness::Extended:
      frame.extended = true;
      return frame;
    case Badness::Reserved:
      return type_of(frame) && !exempt ? reserved(frame, choose) : std::nullopt;
    case Badness::Replayed:
      if (exempt || !has_counter(frame) || is_next(scene, ms, frame, frame.data[1] & 0xFU))
        return std::nullopt;
      return frame;
    case Badness::OldCommand:
      return old_command(scene, ms, choose);
    case Badness::ForeignSession: {
      const wire::Command command = any_command(choose);
      if (command.session == scene.station.core.gate.session()) return std::nullopt;
      return wire::pack(command, {.node = scene.node});
    }
    case Badness::ForeignNode:
      return of_foreign_node(scene, choose);
    case Badness::ForeignCommand: {
      wire::Command command = any_command(choose);
      command.session = scene.station.core.gate.session();
      return wire::pack(command, {.node = scene.peer});
    }
    case Badness::ForeignToken: {
      const std::uint8_t counter = static_cast<std::uint8_t>(choose(15));
      const wire::Frame word =
          wire::pack(any_custody(scene.node, choose), {.node = scene.peer, .counter = counter});
      return is_next(scene, ms, word, counter) ? std::nullopt : std::optional(word);
    }
  }
  return std::nullopt;
}

/// The undisturbed run of a scene, and the station before each of its first milliseconds.
struct CleanRun {
  std::vector<Station> before;
  std::vector<Moment> moments;
};

CleanRun make_clean_run(const Scene& scene) {
  CleanRun run;
  Station station = scene.station;
  for (int ms = 0; ms < kLatestBad_ms + kWatched_ms; ++ms) {
    std::vector<wire::Frame> frames = scene.heard[static_cast<std::size_t>(ms)];
    if (ms == 0) frames.insert(frames.begin(), scene.before.begin(), scene.before.end());
    if (ms <= kLatestBad_ms) run.before.push_back(station);
    run.moments.push_back(moment_of(station, frames));
  }
  return run;
}

const CleanRun& clean_run(const Scene& scene) {
  static std::array<std::optional<CleanRun>, kStates> runs;
  auto& run = runs[static_cast<std::size_t>(scene.state)];
  if (!run) run = make_clean_run(scene);
  return *run;
}

}  // namespace

std::optional<BadFrame> bad_frame(const Scene& scene, Badness kind, const Choose& choose) {
  const int ms = static_cast<int>(choose(kLatestBad_ms));
  const auto frame = made(scene, kind, ms, choose);
  return frame ? std::optional(BadFrame{*frame, ms}) : std::nullopt;
}

std::optional<std::string> two_runs_differ(const Scene& scene, const BadFrame& bad) {
  const CleanRun& clean = clean_run(scene);
  Station station = clean.before[static_cast<std::size_t>(bad.ms)];
  for (int ms = bad.ms; ms < bad.ms + kWatched_ms; ++ms) {
    std::vector<wire::Frame> frames = scene.heard[static_cast<std::size_t>(ms)];
    if (ms == bad.ms) frames.insert(frames.begin(), bad.frame);
    if (ms == 0) frames.insert(frames.begin(), scene.before.begin(), scene.before.end());
    const Moment moment = moment_of(station, frames);
    if (const auto differs = difference(clean.moments[static_cast<std::size_t>(ms)], moment)) {
      std::string told = wire::to_string(scene.state);
      return told + ", " + std::to_string(ms - bad.ms) + " ms after the frame: " + *differs;
    }
  }
  return std::nullopt;
}

}  // namespace pinjaw::core::test
