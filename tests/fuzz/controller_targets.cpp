// Promises: FUZZ, I1, I4.
//
// step() with streams of frames, from every state, its invariants looked at after every millisecond; and the
// two-run property with a fuzzer's choices.
#include <algorithm>
#include <optional>

#include "tests/firmware_sim/faults/bad_frames.hpp"
#include "tests/fuzz/byte_source.hpp"
#include "tests/fuzz/invariants.hpp"
#include "tests/fuzz/targets.hpp"

namespace pinjaw::fuzz {

wire::Frame ByteSource::frame() {
  const std::uint8_t form = byte();
  wire::Frame made{.id = below(0x800), .data = payload()};
  switch (form % 16) {
    case 0:
      made.length = static_cast<std::uint8_t>(form >> 4);
      return made;
    case 1:
      made.extended = true;
      return made;
    case 2:
      made.kind = wire::FrameKind::Remote;
      return made;
    case 3:
      return made;
    default:
      return core::test::sealed(made);
  }
}

namespace {

using core::test::Scene;
using core::test::Station;

/// A frame that means something here: one of the scene's, changed and with its checksum right again.
wire::Frame meaningful(const Scene& scene, const Station& station, ByteSource& source) {
  wire::Frame frame = scene.history[source.below(scene.history.size())];
  const std::uint8_t how = source.byte();
  if ((how & 1U) != 0) frame.data[1 + source.below(7)] = source.byte();
  if ((how & 2U) != 0) {
    wire::Command command{.sequence = static_cast<std::uint8_t>(station.core.gate.next_sequence()),
                          .op = static_cast<wire::Op>(source.below(11)),
                          .argument = static_cast<std::uint8_t>(source.below(16)),
                          .session = station.core.gate.session(),
                          .a = static_cast<std::uint16_t>(source.below(4096)),
                          .b = static_cast<std::uint16_t>(source.below(4096))};
    return wire::pack(command, {.node = scene.node});
  }
  if ((how & 4U) != 0) {
    const wire::Custody word{.fact = static_cast<wire::Fact>(source.below(6)),
                             .peer = scene.node,
                             .token = station.core.store.record.token,
                             .pair = station.core.store.record.pair,
                             .f_low_n = 60};
    return wire::pack(word, {.node = scene.peer, .counter = static_cast<std::uint8_t>(source.below(15))});
  }
  return core::test::sealed(frame);
}

void disturb(Station& station, ByteSource& source) {
  switch (source.below(8)) {
    case 0:
      station.jaw.part_10um = std::nullopt;
      return;
    case 1:
      station.jaw.part_10um = 3000;
      return;
    case 2:
      station.jaw.local_enable = !station.jaw.local_enable;
      return;
    case 3:
      station.jaw.offset_a_mbar = station.jaw.offset_a_mbar == 0 ? 2000 : 0;
      return;
    case 4:
      station.jaw.supply_mbar = station.jaw.supply_mbar == 0 ? 6000 : 0;
      return;
    case 5:
      station.memory_fails = !station.memory_fails;
      return;
    case 6:
      station.power_on_again();
      return;
    default:
      station.jaw.leak_permille = station.jaw.leak_permille == 0 ? 20 : 0;
      return;
  }
}

/// First byte: the scene. Then what happens, one choice a millisecond.
void answer_stream(std::string_view bytes) {
  ByteSource source(bytes);
  const Scene& scene = core::test::scenes()[source.below(core::kStates)];
  Station station = scene.station;
  for (int ms = 0; !source.empty() && ms < 2000; ++ms) {
    std::vector<wire::Frame> frames;
    if (ms == 0) frames = scene.before;
    const std::uint8_t choice = source.byte();
    const bool goes_on = static_cast<std::size_t>(ms) < scene.heard.size() && (choice & 0x80U) == 0;
    if (goes_on) {
      const auto& heard = scene.heard[static_cast<std::size_t>(ms)];
      frames.insert(frames.end(), heard.begin(), heard.end());
    }
    if ((choice & 3U) == 1) frames.push_back(meaningful(scene, station, source));
    if ((choice & 3U) == 2) frames.push_back(source.frame());
    if ((choice & 0x3FU) == 3) disturb(station, source);
    for (std::uint8_t wait = choice >> 2 & 0xFU;; --wait) {
      station.step(frames);
      keeps_its_invariants(station);
      frames.clear();
      if (wait == 0) break;
    }
  }
}

/// First byte: the scene; second: the kind of bad frame; the rest its choices.
void answer_two_runs(std::string_view bytes) {
  ByteSource source(bytes);
  const Scene& scene = core::test::scenes()[source.below(core::kStates)];
  const auto kind = static_cast<core::test::Badness>(source.below(core::test::kBadnesses));
  const auto bad =
      core::test::bad_frame(scene, kind, [&](std::uint32_t limit) { return source.below(limit); });
  if (!bad) return;
  const auto differs = core::test::two_runs_differ(scene, *bad);
  must(!differs, "a bad frame makes a difference: " + differs.value_or(""));
}

}  // namespace

std::vector<Target> controller_targets() {
  return {{"stream", answer_stream, {}, "bus.dict"}, {"two-runs", answer_two_runs, {}, "bus.dict"}};
}

}  // namespace pinjaw::fuzz
