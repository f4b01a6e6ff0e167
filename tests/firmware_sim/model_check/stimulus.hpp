#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "protocol/wire/codes.hpp"
#include "tests/firmware_sim/model_check/network.hpp"

/// What may happen to one node.
namespace pinjaw::core::model {

enum class Happening : std::uint8_t {
  Step,    ///< core::step() with what the rest says; without a demand it says outcome `argument` - 1, or none
  Stored,  ///< the oldest record on its way is in memory
  Crash,   ///< power cut and back; `argument` records on their way were stored before
  Jaws,    ///< the jaws go where the valves let them
};

/// Timers that have run out in a step, as bits.
enum Fired : std::uint8_t { kStateTime = 1, kStable = 2, kPeerGood = 4, kBadHold = 8, kAllFired = 16 };

/// Frames that a host may say besides the commands.
enum class Demand : std::uint8_t { None, Command, GlobalHold, Write };

struct Stimulus {
  Happening what = Happening::Step;
  Demand demand = Demand::None;
  wire::Op op = wire::Op::Hold;
  std::uint8_t argument = 0;
  std::uint8_t fired = 0;
  bool host_alive = true;
  bool peer_holds = false;    ///< the sender's STATE comes too, and says that it holds well
  bool local_enable = false;  ///< for loading only
  std::int8_t message = -1;   ///< the custody frame that comes, or none

  /// Bad luck: what the way back to rest must not need.
  [[nodiscard]] bool is_mishap() const { return what == Happening::Crash || !host_alive; }
};

/// Every command of an adversarial host to a node with these `others`, with a valid session and sequence and
/// in the host's best interest: arguments that would be refused anyway are left out.
std::vector<Stimulus> demands(bool passive, const std::vector<std::uint8_t>& others);

std::string describe(const Stimulus& stimulus, const Network& network);

}  // namespace pinjaw::core::model
