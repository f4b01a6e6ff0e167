#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "tests/firmware_sim/core/bench.hpp"

/// Controllers met in each of their states, with what they hear there, to be played again with disturbances.
namespace pinjaw::core::test {

/// One controller in one state on a bus that goes on without it: what it hears is as recorded.
struct Scene {
  StateId state = StateId::Boot;  ///< in which it is when it hears the first frame after `before`
  std::uint8_t node = kArm;
  std::uint8_t peer = kPedestal;  ///< the other of its handoff
  Station station;
  std::vector<wire::Frame> before;              ///< heard first of all, in the first millisecond
  std::vector<std::vector<wire::Frame>> heard;  ///< what the bus brings it, each millisecond
  std::vector<wire::Frame> history;             ///< what it heard until now, oldest first
};

constexpr int kSceneLength_ms = 400;

/// One for each state, in their order. In none does a transition by the bus fall due within the first 100 ms.
const std::vector<Scene>& scenes();

/// What a controller does in one millisecond.
struct Moment {
  StateId state = StateId::Boot;
  Valves valves;
  std::optional<NvmWrite> nvm;
  Announcement announced;
  std::vector<wire::Frame> said;  ///< without acknowledgements, which tell who asks what came of it
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

}  // namespace pinjaw::core::test
