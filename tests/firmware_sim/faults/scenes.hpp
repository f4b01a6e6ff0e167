#pragma once

#include <map>
#include <vector>

#include "tests/firmware_sim/core/bench.hpp"

/// Controllers met in each of their states, with what they hear there, to be played again with disturbances.
namespace pinjaw::core::test {

/// How a cell's frames travel: as they are, its commands under a key, or every one sealed on CAN FD.
enum class Framing : std::uint8_t { Plain, Sealed, CanFd };
constexpr wire::Key kSceneKey{7, 1, 8, 2, 8, 1, 8, 2, 8, 4, 5, 9, 0, 4, 5, 2};

/// One controller in one state on a bus that goes on without it: what it hears is as recorded.
struct Scene {
  StateId state = StateId::Boot;  ///< in which it is when it hears the first frame after `before`
  std::uint8_t node = kArm;
  std::uint8_t peer = kPedestal;  ///< the other of its handoff
  Framing framing = Framing::Plain;
  Station station;
  std::vector<wire::Frame> before;              ///< heard first of all, in the first millisecond
  std::vector<std::vector<wire::Frame>> heard;  ///< what the bus brings it, each millisecond
  std::vector<wire::Frame> history;             ///< what it heard until now, oldest first
  /// What is not in `heard` as it would change the scene: a right GLOBAL_HOLD, a command that the state obeys
  /// and a question, each as it is said for the first, second and third time.
  std::map<wire::MessageType, std::vector<wire::Frame>> besides;

  /// BOOT and RECOVER last until the end of the first millisecond.
  [[nodiscard]] bool is_brief() const { return state == StateId::Boot || state == StateId::Recover; }
};

constexpr int kSceneLength_ms = 400;

/// One for each state, in their order. In none does a transition by the bus fall due within the first 100 ms,
/// and in that time every message of the table is heard, but for those in `besides`.
const std::vector<Scene>& scenes(Framing framing = Framing::Plain);

/// A passive station in each state of a handoff in which it stays.
const std::vector<Scene>& passive_scenes();

/// `command` as the host says it to the scene's controller, which has become `station`: of its session, the
/// next in its sequence after `waiting` others, with the MAC that is asked for. ARM is for its layout.
wire::Command right_command(const Scene& scene, const Station& station, wire::Command command,
                            std::size_t waiting = 0);

/// A command that a scene's controller obeys; ARM where it has no session.
wire::Command told_in(const Scene& scene);

}  // namespace pinjaw::core::test
