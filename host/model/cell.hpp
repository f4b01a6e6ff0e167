#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "host/model/authentication.hpp"
#include "host/model/task.hpp"

namespace pinjaw::model {

/// Bounds of a station's frame in the handoff frame (DESIGN 2); nothing: fixed at 0.
struct Adjust {
  Interval x_mm{0, 0};
  Interval y_mm{0, 0};
  Interval theta_rad{0, 0};
};

struct Station {
  std::string name;
  int node = 0;
  Task task;
  Adjust adjust;
  bool grips = true;  ///< false: a pallet, three pins on one jaw locate, nothing squeezes
};

struct Handoff {
  std::string giver;
  std::string receiver;
};

/// The grippers, pallets and adjustments of one workcell.
struct Cell {
  std::string name;
  PartSource part;
  std::vector<Station> stations;
  std::vector<Handoff> handoffs;
  std::optional<Authentication> authentication;  ///< nothing: whoever is on the bus may command
};

}  // namespace pinjaw::model
