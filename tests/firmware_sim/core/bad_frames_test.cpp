// Promises: I4.
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <vector>

#include "tests/firmware_sim/core/bench.hpp"

/// I4: a frame that is corrupted, misaddressed or malformed changes nothing that a controller does.
namespace pinjaw::core::test {
namespace {

bool same_frames(const Outputs& a, const Outputs& b) {
  return std::equal(a.send.view().begin(), a.send.view().end(), b.send.view().begin(), b.send.view().end());
}

/// Steps two copies of a controller for a while, one of which hears `bad` first.
void expect_no_difference(const Station& station, const std::vector<wire::Frame>& bad) {
  State clean = station.core;
  State disturbed = station.core;
  ToyJaw clean_jaw = station.jaw;
  ToyJaw disturbed_jaw = station.jaw;
  for (int ms = 0; ms < 30; ++ms) {
    const NvmStatus stored{.done = clean.store.requested};
    const Outputs a = step(clean, {.sensors = clean_jaw.read(), .nvm = stored});
    Inputs heard{.sensors = disturbed_jaw.read(), .nvm = stored};
    if (ms == 0) heard.received = bad;
    const Outputs b = step(disturbed, heard);
    RC_ASSERT(a.valves == b.valves);
    RC_ASSERT(same_frames(a, b));
    RC_ASSERT(a.nvm.has_value() == b.nvm.has_value());
    RC_ASSERT(clean.id == disturbed.id);
    clean_jaw.step(a.valves);
    disturbed_jaw.step(b.valves);
  }
}

/// Stations in every state of a handoff, made once.
const std::vector<Station>& interesting() {
  static const std::vector<Station> made = [] {
    std::vector<Station> stations;
    Bench bench;
    bench.run(50);
    stations.push_back(bench.arm());  // UNCONF
    bench.load_all();
    stations.push_back(bench.arm());  // LOADED
    bench.arm_session(kPedestal);
    stations.push_back(bench.pedestal());  // READY
    bench.load_gripper(kArm);
    stations.push_back(bench.arm());  // HOLD
    bench.bring_part(kPedestal, true);
    bench.command(kArm, wire::offer_command(kPedestal));
    stations.push_back(bench.arm());  // OFFERED
    bench.run(100);
    bench.command(kPedestal, wire::accept_command(kArm));
    stations.push_back(bench.pedestal());  // SEATING
    bench.reaches(kPedestal, StateId::Seated);
    stations.push_back(bench.pedestal());
    bench.command(kPedestal, wire::squeeze_command({520, 1400}));
    bench.run(50);
    stations.push_back(bench.pedestal());  // SQUEEZING
    bench.reaches(kPedestal, StateId::Taken);
    stations.push_back(bench.pedestal());
    bench.reaches(kArm, StateId::Relax);
    stations.push_back(bench.arm());
    bench.reaches(kArm, StateId::Opening);
    stations.push_back(bench.arm());
    return stations;
  }();
  return made;
}

const Station& some_station() {
  return interesting()[*rc::gen::inRange<std::size_t>(0, interesting().size())];
}

/// A frame that means something to `station`.
wire::Frame some_frame(const Station& station) {
  const std::uint8_t node = station.config.node;
  const std::uint8_t other = node == kArm ? kPedestal : kArm;
  const auto counter = *rc::gen::inRange<std::uint8_t>(0, 15);
  switch (*rc::gen::inRange(0, 6)) {
    case 0:
      return wire::pack(wire::GlobalHold{}, {.node = 0, .counter = counter});
    case 1:
      return wire::pack(wire::HostHeartbeat{.permit = 0, .epoch = *rc::gen::arbitrary<std::uint16_t>()},
                        {.node = 0, .counter = counter});
    case 2:
      return wire::pack(wire::Command{.sequence = *rc::gen::arbitrary<std::uint8_t>(),
                                      .op = static_cast<wire::Op>(*rc::gen::inRange(0, 11)),
                                      .session = station.core.gate.session()},
                        {.node = node});
    case 3:
      return wire::pack(wire::Custody{.fact = wire::Fact::Retain,
                                      .peer = node,
                                      .token = station.core.store.record.token,
                                      .pair = station.core.store.record.pair},
                        {.node = other, .counter = counter});
    case 4:
      return wire::pack(
          wire::FaultReport{
              .code = wire::FaultCode::OverForce, .severity = wire::Severity::Hold, .active = true},
          {.node = other, .counter = counter});
    default:
      return wire::pack(wire::NodeState{.state = StateId::Taken}, {.node = kPallet, .counter = counter});
  }
}

TEST(BadFrames, corrupted_by_up_to_three_bits_change_nothing) {
  EXPECT_TRUE(rc::check([] {
    const Station& station = some_station();
    wire::Frame frame = some_frame(station);
    const wire::Frame good = frame;
    for (int i = *rc::gen::inRange(1, 4); i > 0; --i) {
      const unsigned bit = *rc::gen::inRange(0U, 64U);
      frame.data[bit / 8] ^= static_cast<std::uint8_t>(1U << (bit % 8));
    }
    RC_PRE(!(frame == good));
    expect_no_difference(station, {frame});
  }));
}

TEST(BadFrames, of_another_id_length_or_kind_change_nothing) {
  EXPECT_TRUE(rc::check([] {
    const Station& station = some_station();
    wire::Frame frame = some_frame(station);
    switch (*rc::gen::inRange(0, 4)) {
      case 0:
        frame.length = *rc::gen::inRange<std::uint8_t>(0, 8);
        break;
      case 1:
        frame.extended = true;
        break;
      case 2:
        frame.kind = wire::FrameKind::Remote;
        break;
      default:
        frame.id ^= *rc::gen::inRange(1U, 0x200U);
        RC_PRE(frame.id < 0x600 || frame.id > 0x6FF);
        break;
    }
    expect_no_difference(station, {frame});
  }));
}

TEST(BadFrames, random_without_a_right_checksum_change_nothing) {
  EXPECT_TRUE(rc::check([] {
    const Station& station = some_station();
    wire::Frame frame;
    frame.id = *rc::gen::inRange(0U, 0x600U);
    for (std::uint8_t& byte : frame.data) byte = *rc::gen::arbitrary<std::uint8_t>();
    if (const auto identifier = wire::identify(frame)) {
      const wire::Identifier who = *identifier;
      RC_PRE(frame.data[0] != wire::detail::checksum(who, frame.data));
    }
    expect_no_difference(station, {frame});
  }));
}

TEST(BadFrames, of_another_session_move_no_valve) {
  EXPECT_TRUE(rc::check([] {
    const Station& station = some_station();
    const wire::Command command{.sequence = *rc::gen::arbitrary<std::uint8_t>(),
                                .op = static_cast<wire::Op>(*rc::gen::inRange(2, 11)),
                                .argument = *rc::gen::inRange<std::uint8_t>(0, 16),
                                .session = *rc::gen::arbitrary<std::uint16_t>(),
                                .a = *rc::gen::inRange<std::uint16_t>(0, 4096),
                                .b = *rc::gen::inRange<std::uint16_t>(0, 4096)};
    RC_PRE(command.session != station.core.gate.session());
    State clean = station.core;
    State disturbed = station.core;
    const std::vector<wire::Frame> frames{wire::pack(command, {.node = station.config.node})};
    const NvmStatus stored{.done = clean.store.requested};
    const Outputs a = step(clean, {.sensors = station.jaw.read(), .nvm = stored});
    const Outputs b = step(disturbed, {.received = frames, .sensors = station.jaw.read(), .nvm = stored});
    RC_ASSERT(a.valves == b.valves);
    RC_ASSERT(clean.id == disturbed.id);
  }));
}

TEST(BadFrames, equal_inputs_give_equal_outputs) {
  EXPECT_TRUE(rc::check([] { expect_no_difference(some_station(), {}); }));
}

}  // namespace
}  // namespace pinjaw::core::test
