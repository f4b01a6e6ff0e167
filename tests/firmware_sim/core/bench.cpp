#include "tests/firmware_sim/core/bench.hpp"

#include <algorithm>

#include "firmware_sim/core/authentication.hpp"
#include "protocol/wire/seal.hpp"
#include "tests/firmware_sim/core/recorder.hpp"

namespace pinjaw::core::test {
namespace {

constexpr std::uint16_t kKit = 0x1234;
constexpr std::uint32_t kPart = 0xCAFE0001;
constexpr std::int32_t kContact_10um = 3000;

wire::Layout body_for(std::uint8_t node, std::uint16_t f_required_dn) {
  wire::Layout layout{
      .kit_id = kKit, .part_id = kPart, .grid_pitch_nm = 11'112'500, .pin_diameter_nm = 4'762'500};
  layout.stable_ms = 150;
  layout.slip_tolerance_um = 200;
  layout.pin_count = 3;
  for (std::uint8_t i = 0; i < 3; ++i) {
    layout.pins[i] = {
        .jaw = wire::Jaw::Left, .column = 0, .row = static_cast<std::int8_t>(i), .length_10um = 1650};
  }
  if (node == kPallet) {
    layout.node_class = wire::NodeClass::Passive;
    layout.passive = true;
    return layout;
  }
  layout.pin_count = 4;
  layout.pins[3] = {.jaw = wire::Jaw::Right, .column = 0, .row = 1, .length_10um = 1650};
  layout.separation_open_10um = 5000;
  layout.separation_contact_10um = kContact_10um;
  layout.separation_tolerance_10um = 50;
  layout.f_light_dn = 120;
  layout.f_required_dn = f_required_dn;
  layout.f_limit_dn = 1400;
  return layout;
}

}  // namespace

wire::Layout layout_for(std::uint8_t node, std::uint16_t f_required_dn) {
  wire::Layout layout = body_for(node, f_required_dn);
  const wire::PairSide own{node, wire::layout_crc_of(layout)};
  for (const std::uint8_t other : {kArm, kPedestal, kPallet}) {
    if (other == node) continue;
    const wire::Layout theirs = body_for(other, 400);
    const wire::PairSide side{other, wire::layout_crc_of(theirs)};
    layout.peers[layout.peer_count++] = {.node = other,
                                         .layout_crc = side.layout_crc,
                                         .f_required_dn = theirs.f_required_dn,
                                         .pair_crc = wire::pair_crc_of(kPart, own, side)};
  }
  return layout;
}

Station::Station(std::uint8_t node) {
  config.node = node;
  config.kit_id = kKit;
  config.passive = node == kPallet;
  if (config.passive) config.seat_switches = 7;
  jaw.passive = config.passive;
  power_on_again();
}

void Station::power_off() {
  powered = false;
  outputs = {};
}

void Station::power_on_again() {
  powered = true;
  stored = {};
  core = power_on(config, memory);
  if (Recorder* recorder = Recorder::wanted()) recorder->power_on(config, memory, core);
}

void Station::step(const std::vector<wire::Frame>& frames) {
  if (!powered) return jaw.step(Valves{});
  const std::vector<wire::Frame> received = bus.off ? std::vector<wire::Frame>{} : frames;
  const Inputs inputs{.received = received, .sensors = jaw.read(), .nvm = stored, .bus = bus};
  Recorder* recorder = Recorder::wanted();
  if (recorder != nullptr) recorder->before(core);
  outputs = core::step(core, inputs);
  if (recorder != nullptr) recorder->after(inputs, outputs, core);
  if (bus.off) outputs.send.size = 0;
  if (outputs.nvm) {
    if (memory_fails) {
      stored.failed = true;
    } else {
      if (outputs.nvm->record) memory.record = outputs.nvm->record;
      if (outputs.nvm->layout) memory.layout = *outputs.nvm->layout;
      stored = {.done = outputs.nvm->sequence, .failed = false};
    }
  }
  jaw.step(outputs.valves);
}

Bench::Bench() {
  for (const std::uint8_t node : {kArm, kPedestal, kPallet}) stations_.emplace_back(node);
}

std::uint32_t Bench::random() {
  random_ = random_ * 1664525U + 1013904223U;
  return random_ >> 16;
}

bool Bench::chance(int percent) {
  return static_cast<int>(random() % 100U) < percent;
}

void Bench::reorder(std::vector<wire::Frame>& frames, std::uint8_t to) {
  constexpr std::uint32_t kMost_ms = 30;
  std::erase_if(frames, [&](const wire::Frame& frame) {
    if (!chance(late_percent)) return false;
    late_.push_back({frame, to, now_ms + 1 + static_cast<int>(random() % kMost_ms)});
    return true;
  });
  std::erase_if(late_, [&](const Late& late) {
    if (late.to != to || late.due_ms > now_ms) return false;
    frames.push_back(late.frame);
    return true;
  });
}

void Bench::beat(std::vector<wire::Frame>& frames) {
  if (!host_alive || now_ms % wire::kHostHeartbeat_ms != 0) return;
  beat_counter_ = wire::next_counter(beat_counter_);
  const wire::HostHeartbeat heartbeat{.state = wire::HostState::Run, .permit = host_permit, .epoch = epoch};
  frames.push_back(from_host(wire::pack(heartbeat, {.node = 0, .counter = beat_counter_})));
}

std::vector<wire::Frame> Bench::delivered(const std::vector<wire::Frame>& frames, std::uint8_t to) {
  std::vector<wire::Frame> received;
  for (const wire::Frame& frame : frames) {
    const bool own =
        frame.id < 0x240 + 16 && frame.id != 0x0F0 && (frame.id & 0xFU) == to && (frame.id & 0x7F0U) != 0x100;
    if (own || lost()) continue;
    received.push_back(frame);
    if (duplicates && lost()) received.push_back(frame);
    if (duplicate_percent > 0 && chance(duplicate_percent)) received.push_back(frame);
  }
  if (late_percent > 0) reorder(received, to);
  if (on_delivery) on_delivery(to, received);
  return received;
}

void Bench::run(int ms) {
  for (int i = 0; i < ms; ++i) {
    std::vector<wire::Frame> frames = std::exchange(injected_, {});
    beat(frames);
    frames.insert(frames.end(), heard.begin(), heard.end());
    heard.clear();
    for (Station& station : stations_) {
      station.step(delivered(frames, station.config.node));
      const auto view = station.outputs.send.view();
      heard.insert(heard.end(), view.begin(), view.end());
    }
    heard_by_host = heard;
    if (host_link_) {
      heard_by_host.clear();
      for (const wire::Frame& frame : heard) {
        if (const auto opened = host_link_->open(*key_, frame)) heard_by_host.push_back(*opened);
      }
      if (const auto frame = host_link_->speak(*key_, 1)) injected_.push_back(*frame);
    }
    ++now_ms;
    if (after_step) after_step();
  }
}

bool Bench::run_until(int most_ms, const std::function<bool()>& condition) {
  for (int i = 0; i < most_ms; ++i) {
    if (condition()) return true;
    run(1);
  }
  return condition();
}

bool Bench::reaches(std::uint8_t node, StateId state, int most_ms) {
  return run_until(most_ms, [&] { return at(node).id() == state; });
}

void Bench::share_key(const wire::Key& key, bool can_fd) {
  key_ = key;
  if (can_fd) host_link_.emplace(wire::kHostNode, wire::FrameNumber{1} << 40);
  for (Station& station : stations_) {
    station.config.key = key;
    station.config.can_fd = can_fd;
    station.power_on_again();
  }
}

wire::Command Bench::sealed_for(std::uint8_t node, const wire::Command& command) {
  if (!key_ || command.op == wire::Op::Hold) return command;
  const State& core = at(node).core;
  const bool arms = command.op == wire::Op::Arm;
  return wire::sealed(*key_, node, command,
                      {.number = arms ? next_session_number(core) : core.next_session,
                       .epoch = arms ? epoch : core.session_epoch});
}

std::optional<wire::Acknowledge> Bench::command(std::uint8_t node, wire::Command command) {
  if (command.op != wire::Op::Hold && command.op != wire::Op::Arm) {
    const auto sequence = sequence_[node].take();
    if (!sequence) return std::nullopt;
    command.sequence = *sequence;
    command.session = session_[node];
  }
  command = sealed_for(node, command);
  for (int attempt = 0; attempt < 20; ++attempt) {
    inject(from_host(wire::pack(command, {.node = node})));
    for (int ms = 0; ms < wire::kAcknowledge_ms; ++ms) {
      run(1);
      for (const wire::Frame& frame : heard_by_host) {
        const auto answer = wire::parse<wire::Acknowledge>(frame);
        const bool mine = answer && answer->label.node == node && answer->message.op == command.op &&
                          answer->message.sequence == command.sequence;
        if (mine && !lost()) return answer->message;
      }
    }
  }
  return std::nullopt;
}

std::optional<wire::Acknowledge> Bench::arm_session(std::uint8_t node) {
  wire::Command arm = wire::arm_command(at(node).core.layouts.crc, epoch);
  arm.sequence = arm_sequence_++ % 100U;  // another one each time: the same would be taken for a repeat
  const auto answer = command(node, arm);
  if (answer && answer->result == wire::CommandResult::Ok) {
    session_[node] = answer->session;
    sequence_[node].begin(answer->next_sequence);
  }
  return answer;
}

wire::CommandResult Bench::result_of(std::uint8_t node, const wire::Command& wanted) {
  const auto answer = command(node, wanted);
  return answer ? answer->result : wire::CommandResult::Busy;
}

void Bench::load(std::uint8_t node, const wire::Layout& layout) {
  const wire::EncodedLayout encoded = wire::encode(layout);
  std::copy(encoded.bytes.begin(), encoded.bytes.end(), at(node).memory.layout.bytes.begin());
  at(node).memory.layout.size = static_cast<std::uint16_t>(encoded.size);
  at(node).power_on_again();
}

void Bench::load_all() {
  for (const std::uint8_t node : {kArm, kPedestal, kPallet}) load(node, layout_for(node));
  run(300);
}

void Bench::bring_part(std::uint8_t node, bool there) {
  if (at(node).config.passive) {
    at(node).jaw.part_on_seats = there;
  } else {
    at(node).jaw.part_10um = there ? std::optional(kContact_10um) : std::nullopt;
  }
}

void Bench::load_pallet() {
  bring_part(kPallet, true);
  pallet().jaw.local_enable = true;
  arm_session(kPallet);
  command(kPallet, wire::plain_command(wire::Op::CloseLight));
  reaches(kPallet, StateId::Seated);
  command(kPallet, wire::squeeze_command({0, 0}));
  reaches(kPallet, StateId::Hold);
  pallet().jaw.local_enable = false;
}

void Bench::load_gripper(std::uint8_t node) {
  bring_part(node, true);
  at(node).jaw.local_enable = true;
  arm_session(node);
  command(node, wire::plain_command(wire::Op::CloseLight));
  reaches(node, StateId::Seated);
  command(node, wire::squeeze_command({520, 1400}));
  reaches(node, StateId::Hold);
  at(node).jaw.local_enable = false;
}

bool Bench::hand_over(std::uint8_t giver, std::uint8_t receiver) {
  return seat(giver, receiver) && squeeze(receiver) && reaches(receiver, StateId::Hold) &&
         reaches(giver, StateId::Ready);
}

bool Bench::seat(std::uint8_t giver, std::uint8_t receiver) {
  for (const std::uint8_t node : {giver, receiver}) {
    if (!at(node).core.gate.armed() || at(node).id() == StateId::Loaded) arm_session(node);
  }
  bring_part(receiver, true);
  if (result_of(giver, wire::offer_command(receiver)) != wire::CommandResult::Ok) return false;
  run(100);
  return result_of(receiver, wire::accept_command(giver)) == wire::CommandResult::Ok &&
         reaches(receiver, StateId::Seated);
}

bool Bench::squeeze(std::uint8_t receiver) {
  const wire::SqueezeForces forces =
      at(receiver).config.passive ? wire::SqueezeForces{0, 0} : wire::SqueezeForces{520, 1400};
  return result_of(receiver, wire::squeeze_command(forces)) == wire::CommandResult::Ok;
}

}  // namespace pinjaw::core::test
