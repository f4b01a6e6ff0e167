#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "host/model/cell.hpp"

namespace pinjaw::model {

struct PlaceStep {
  std::string on;
};
struct RemoveStep {
  std::string from;
};
struct HandoffStep {
  std::string from;
  std::string to;
  double within_s = 30;
};
struct MoveStep {
  std::string station;
  double seconds = 0;
  double peak_g = 0;
  Vector3d along = Vector3d::UnitX();
};
struct RotateStep {
  std::string station;
  double angle_rad = 0;
  double seconds = 0;
  double peak_g = 0;
};
struct SprayStep {
  std::string on;
  double seconds = 0;
  double force_n = 0;
  std::uint64_t seed = 1;
};
struct WaitStep {
  double seconds = 0;
};

using Step = std::variant<PlaceStep, RemoveStep, HandoffStep, MoveStep, RotateStep, SprayStep, WaitStep>;

/// A fault that the script injects, at the start of a step (1-based) or at a time.
struct ScriptedFault {
  std::optional<int> at_step;
  std::optional<double> at_s;
  bool kill_host = false;
  double drop_share = 0;  ///< share of frames lost, 0..1
  double seconds = 0;     ///< how long frames are lost
};

/// A scripted list of picks, handoffs, disturbances and waits run on a cell.
struct Sequence {
  std::string name;
  Cell cell;
  std::string design = "best";
  std::vector<Step> steps;
  std::vector<ScriptedFault> faults;
};

}  // namespace pinjaw::model
