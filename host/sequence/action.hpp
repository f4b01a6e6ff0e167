#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <variant>
#include <vector>

#include "host/jaw_client/client.hpp"
#include "protocol/bench/bench.hpp"

/// The small steps a script is made of. Each is begun once, then polled until it is over.
namespace pinjaw::sequence {

/// What an action may use: the controllers over the bus, and the bench beside it.
struct Stage {
  jaw_client::Client& client;
  bench::WorldPort* world = nullptr;  ///< nothing: nobody simulates a world, the bench is not asked
};

struct StillGoing {};
struct Finished {};

enum class Trouble {
  Refused,     ///< a controller said no, or has a fault
  ForceLimit,  ///< it said no because of a force
  Silent,      ///< the bus, a controller or the world does not answer, or not in time
  World,       ///< the world said no
};

/// Why an action failed, for a person.
struct Failed {
  Trouble trouble = Trouble::Refused;
  std::string sentence;
};

using ActionState = std::variant<StillGoing, Finished, Failed>;

struct Action {
  std::string name;
  std::int64_t limit_us = 0;                 ///< over this it ends
  bool ends_well_at_limit = false;           ///< true: a pause; false: it fails as silent
  std::function<ActionState(Stage&)> begin;  ///< may already be the end
  std::function<ActionState(Stage&)> poll;   ///< asked after every step of the bus
};

/// Says `request` to the world; done where there is none.
Action tell(bench::Request request);

/// Runs one operation of the client on `node`.
Action operate(std::string name, std::uint8_t node, std::function<void(jaw_client::Client&)> begin);

/// Waits until `condition` holds; fails with `otherwise` after `limit_us`.
Action until(std::string otherwise, std::int64_t limit_us,
             std::function<bool(const jaw_client::Client&)> condition);

/// Lets time pass.
Action pause(double seconds);

/// `action` on `node`, begun again after `arm` where the node refuses it because its session is over: a
/// silence of this host has ended it, as on a busy machine, and the node has done nothing. Three times at
/// most.
Action rearming(Action action, Action arm, std::uint8_t node);

/// `action`, but its failure does not matter: for clearing up.
Action attempt(Action action);

}  // namespace pinjaw::sequence
