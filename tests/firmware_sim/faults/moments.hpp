#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "tests/firmware_sim/faults/scenes.hpp"

/// Scenes played again, and what their controllers do in them.
namespace pinjaw::core::test {

/// What a controller does in one millisecond.
struct Moment {
  StateId state = StateId::Boot;
  Valves valves;
  std::optional<NvmWrite> nvm;
  Announcement announced;
  /// Opened, without acknowledgements, which tell who asks what came of it, and without the numbers that a
  /// link asks or answers with, which count those.
  std::vector<wire::Frame> said;
};

/// Nothing, or what differs first.
std::optional<std::string> difference(const Moment& one, const Moment& other);

/// Steps `station` with `frames` and says what it did.
Moment moment_of(Station& station, const std::vector<wire::Frame>& frames);

/// Changes what is heard in a millisecond.
using Disturbance = std::function<void(int ms, std::vector<wire::Frame>& frames)>;

/// A scene from its beginning.
std::vector<Moment> play(const Scene& scene, int ms, const Disturbance& disturb = {});

/// The last CTR of a (message, node) in what a scene's controller heard before millisecond `ms`.
std::optional<std::uint8_t> last_counter(const Scene& scene, int ms, const wire::Frame& like);

/// `frame` with another CTR and the checksum that belongs to it.
wire::Frame with_counter(wire::Frame frame, std::uint8_t counter);
/// `frame` with the checksum that belongs to it.
wire::Frame sealed(wire::Frame frame);

bool has_counter(const wire::Frame& frame);

/// The classic frame in a sealed one, whether it is authentic or not.
wire::Frame classic(wire::Frame frame);
/// What kind of message it is; nothing for a frame of the link itself.
std::optional<wire::MessageType> type_of(const wire::Frame& frame);

}  // namespace pinjaw::core::test
