// Promises: FUZZ, AUTH-FD.
//
// step() on CAN FD under a key with streams of frames, sealed or not, from every state: what the link opens
// was sealed with the key and is opened once, or asks to hold.
#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "firmware_sim/core/authentication.hpp"
#include "protocol/wire/secured_link.hpp"
#include "tests/firmware_sim/faults/moments.hpp"
#include "tests/fuzz/byte_source.hpp"
#include "tests/fuzz/invariants.hpp"
#include "tests/fuzz/targets.hpp"

namespace pinjaw::fuzz {
namespace {

using core::test::kSceneKey;
using core::test::Scene;
using core::test::Station;
using wire::FrameNumber;

/// Whose frame it says it is; nothing for a frame of no message.
std::optional<std::uint8_t> source_of(const wire::Frame& frame) {
  const auto identifier = wire::identify(core::test::classic(frame));
  if (!identifier) return std::nullopt;
  return wire::detail::sender_of(*identifier);
}

/// The number that `frame` is sealed with: one of those that its sender can have come to in a scene. By
/// search, as only its low 8 bits travel: no MAC is right by chance more than once in 2^24.
std::optional<FrameNumber> number_of(const wire::Frame& frame) {
  constexpr FrameNumber kMost = 1U << 13;  // more than anybody says in a scene or on the way to it
  constexpr std::array<FrameNumber, 2> kFrom = {1, FrameNumber{1} << 40};  // of nodes, of the host
  constexpr FrameNumber kBlocks = 8;  // of 2^20 numbers, one for each start
  const auto matches = [&frame](FrameNumber number) {
    return wire::detail::frame_tail(kSceneKey, frame.id, frame.data, number) == frame.tail;
  };
  for (FrameNumber block = 0; block < kBlocks; ++block) {
    for (FrameNumber from : kFrom) {
      from = (from + (block << 20)) / 256 * 256 + frame.tail[0];
      for (FrameNumber number = from; number < from + kMost; number += 256) {
        if (matches(number)) return number;
      }
    }
  }
  return std::nullopt;
}

/// Everything of a frame that a link tells apart.
using Likeness = std::vector<std::uint8_t>;

Likeness likeness_of(const wire::Frame& frame) {
  Likeness bytes{static_cast<std::uint8_t>(frame.id & 0xFFU), static_cast<std::uint8_t>(frame.id >> 8)};
  bytes.insert(bytes.end(), frame.data.begin(), frame.data.end());
  bytes.insert(bytes.end(), frame.tail.begin(), frame.tail.end());
  return bytes;
}

/// What a scene's bus says.
struct Said {
  std::map<std::uint8_t, FrameNumber> newest;  ///< of each sender, in the end
  std::set<Likeness> before;                   ///< the scene begins
  std::set<Likeness> in_it;
};

Said said_in(const Scene& scene) {
  Said said;
  std::map<std::uint8_t, wire::Frame> last;
  const auto look = [&](const std::vector<wire::Frame>& frames, std::set<Likeness>& into) {
    for (const wire::Frame& frame : frames) {
      const auto source = source_of(frame);
      if (!source || frame.kind != wire::FrameKind::Fd) continue;
      last[*source] = frame;
      into.insert(likeness_of(frame));
    }
  };
  look(scene.history, said.before);
  look(scene.before, said.in_it);
  for (const auto& heard : scene.heard) look(heard, said.in_it);
  for (const auto& [source, frame] : last) {
    const auto number = number_of(frame);
    must(number.has_value(), "a scene's frame that is not sealed");
    said.newest[source] = *number;
  }
  return said;
}

const Said& known_of(const Scene& scene) {
  static std::map<const Scene*, Said> known;
  const auto found = known.find(&scene);
  return found != known.end() ? found->second : known[&scene] = said_in(scene);
}

/// A controller on CAN FD, and somebody on its bus who may or may not know the key.
class Listening {
 public:
  Listening(const Scene& scene, ByteSource& source)
      : scene_(scene),
        source_(source),
        station_(scene.station),
        said_(known_of(scene)),
        newest_(said_.newest) {}

  void run() {
    constexpr int kMost_ms = 600;
    next_ = scene_.before;
    while (!source_.empty() && ms_ < kMost_ms) {
      const std::uint8_t choice = source_.byte();
      if ((choice & 0x80U) == 0) hear_the_scene();
      say(choice & 7U);
      for (std::uint8_t wait = choice >> 3 & 0xFU;; --wait) {
        step();
        if (wait == 0) break;
        if ((choice & 0x80U) == 0) hear_the_scene();
      }
    }
  }

 private:
  void hear_the_scene() {
    const auto at = static_cast<std::size_t>(ms_);
    if (at < scene_.heard.size()) next_.insert(next_.end(), scene_.heard[at].begin(), scene_.heard[at].end());
  }

  void say(unsigned what) {
    switch (what) {
      case 1:
        return next_.push_back(heard_before());
      case 2:
        return next_.push_back(fd(source_.frame()));
      case 3: {
        wire::Frame frame = heard_before();
        frame.data[source_.below(8)] = source_.byte();
        frame.id ^= source_.below(8);
        return next_.push_back(core::test::sealed(frame));
      }
      case 4:
        return next_.push_back(synchronisation());
      case 5:
        return next_.push_back(sealed(core::test::sealed(heard_before())));
      case 6:
        return next_.push_back(source_.frame());
      case 7:
        if (source_.below(8) == 0) station_.power_on_again();
        return;
      default:
        return;
    }
  }

  wire::Frame heard_before() { return scene_.history[source_.below(scene_.history.size())]; }

  wire::Frame fd(wire::Frame frame) {
    frame.kind = wire::FrameKind::Fd;
    frame.length = source_.below(16) == 0 ? source_.byte() : wire::kFdLength;
    source_.fill(frame.tail);
    return frame;
  }

  /// A question or an answer, with the right MAC or another.
  wire::Frame synchronisation() {
    constexpr std::uint8_t kFollowing = 16;
    const auto source = static_cast<std::uint8_t>(source_.below(16));
    const auto known = newest_.find(source);
    FrameNumber number = known == newest_.end() ? source_.below(0x10000) : known->second + source_.byte();
    if (source_.below(kFollowing) == 0) number = source_.below(0x10000);
    const wire::Synchronisation said{
        .source = source, .receiver = static_cast<std::uint8_t>(source_.below(16)), .number = number};
    const FrameNumber asked = station_.core.link.next_number() - source_.below(4);
    wire::Frame frame = wire::detail::synchronisation_frame(kSceneKey, said, asked);
    if (source_.below(2) == 0) source_.fill(frame.tail);
    return frame;
  }

  /// As its sender would say it next, or a little later or earlier.
  wire::Frame sealed(wire::Frame frame) {
    const auto source = source_of(frame);
    if (!source) return frame;
    FrameNumber& newest = newest_[*source];
    const FrameNumber number = newest + 1 + source_.below(64) - source_.below(32);
    newest = std::max(newest, number);
    frame = fd(core::test::classic(frame));
    frame.tail = wire::detail::frame_tail(kSceneKey, frame.id, frame.data, number);
    ours_.insert(likeness_of(frame));
    return frame;
  }

  void step() {
    const std::vector<wire::Frame> frames = std::exchange(next_, {});
    core::State listener = station_.core;  // hears the same, so that it is seen what the link opens
    core::keep_link(listener);
    for (const wire::Frame& frame : frames) opens_only_what_is_right(listener.link, frame);
    station_.step(frames);
    must(station_.core.link.refused() == listener.link.refused(),
         "a controller opens what its link does not");
    keeps_its_invariants(station_);
    ++ms_;
  }

  template <class Link>
  void opens_only_what_is_right(Link& link, const wire::Frame& frame) {
    const auto opened = link.open(kSceneKey, frame);
    if (!opened) return;
    must(opened->kind != wire::FrameKind::Fd, "what is opened is no classic frame");
    must(opened->id == frame.id && opened->data == frame.data, "what is opened is another frame");
    if (wire::detail::asks_to_hold(*opened)) return;
    must(frame.kind == wire::FrameKind::Fd && frame.length == wire::kFdLength, "an unsealed frame is opened");
    const Likeness likeness = likeness_of(frame);
    // a fuzzer that sees what is compared may guess a MAC
    must(ours_.contains(likeness) || said_.in_it.contains(likeness) || number_of(frame).has_value(),
         "a forged frame is opened");
    must(opened_.insert(likeness).second, "a frame is opened twice");
    must(!said_.before.contains(likeness), "a recorded frame is opened");
  }

  const Scene& scene_;
  ByteSource& source_;
  Station station_;
  const Said& said_;
  std::map<std::uint8_t, FrameNumber> newest_;
  std::set<Likeness> ours_;
  std::set<Likeness> opened_;
  std::vector<wire::Frame> next_;
  int ms_ = 0;
};

/// First byte: the scene. Then what happens, one choice a millisecond.
void answer_link(std::string_view bytes) {
  ByteSource source(bytes);
  const Scene& scene = core::test::scenes(core::test::Framing::CanFd)[source.below(core::kStates)];
  Listening(scene, source).run();
}

}  // namespace

std::vector<Target> link_targets() {
  return {{"link", answer_link, {}, "bus.dict"}};
}

}  // namespace pinjaw::fuzz
