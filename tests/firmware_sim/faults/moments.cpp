#include "tests/firmware_sim/faults/moments.hpp"

#include "protocol/wire/names.hpp"

namespace pinjaw::core::test {

Moment moment_of(Station& station, const std::vector<wire::Frame>& frames) {
  station.step(frames);
  Moment moment{.state = station.id(),
                .valves = station.outputs.valves,
                .nvm = station.outputs.nvm,
                .announced = station.core.announced,
                .said = {}};
  for (const wire::Frame& sealed_frame : station.outputs.send.view()) {
    wire::Frame frame = classic(sealed_frame);
    const auto type = type_of(frame);
    if (type == wire::MessageType::Acknowledge) continue;
    if (!type) frame.data = {};
    moment.said.push_back(frame);
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

wire::Frame classic(wire::Frame frame) {
  if (frame.kind != wire::FrameKind::Fd) return frame;
  frame.kind = wire::FrameKind::Data;
  frame.length = 8;
  frame.tail = {};
  return frame;
}

std::optional<wire::MessageType> type_of(const wire::Frame& frame) {
  const auto identifier = wire::identify(classic(frame));
  return identifier ? std::optional(identifier->type) : std::nullopt;
}

bool has_counter(const wire::Frame& frame) {
  const auto type = type_of(frame);
  return type && wire::spec_of(*type).protection == wire::Protection::Counter;
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
  if (const auto identifier = wire::identify(classic(frame))) {
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
