#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <variant>
#include <vector>

#include "host/model/task.hpp"
#include "host/planner/force/closure.hpp"
#include "host/planner/force/disturbances.hpp"
#include "host/planner/force/grasp.hpp"
#include "host/planner/force/squeeze.hpp"

/// Phase 5: the squeeze force a design needs (BB 3.5). It is what can balance the load, not a guarantee.
namespace pinjaw::planner {

/// F_max and the wrench that needs it: the first in the list among equals.
struct Holds {
  double required_n = 0;  ///< at least 0
  std::size_t critical = 0;
};

/// One jaw's contacts alone are in planar frictional force closure.
struct Wedges {
  model::JawSide jaw = model::JawSide::Left;
};

/// A contact that sliding cannot close (see jamming_contact()).
struct Jams {
  int pin = 0;
};

/// No squeeze holds wrench `critical`, the first such in the list.
struct NotResistable {
  std::size_t critical = 0;
};

/// Needs more than the usable force.
struct TooStrong {
  double required_n = 0;  ///< F_max, or less where evaluation stopped early
  std::size_t critical = 0;
};

/// One outcome a design: held, or why it is discarded, tested in this order: wedges, jams, not resistable,
/// too strong. (A grasp that does not jam cannot wedge, all forces of a jaw then having a part along its
/// motion; so wedging comes first.)
using ForceVerdict = std::variant<Holds, Wedges, Jams, NotResistable, TooStrong>;

struct ForceOptions {
  model::FrictionModel friction = model::FrictionModel::Pyramid;
  double usable_n = std::numeric_limits<double>::infinity();  ///< Actuator::usable_squeeze_n()
  /// Stop as soon as F_max is known to exceed this; the verdict is then TooStrong, whatever later wrenches
  /// would have said. Nothing: every wrench is solved, so that the funnel's counts are exact.
  std::optional<double> stop_above_n;
};

/// The verdict on one grasp under `wrenches` (turned by the task's side; see turned_wrenches()).
ForceVerdict evaluate(const Grasp& grasp, std::span<const model::Wrench> wrenches,
                      const ForceOptions& options);

/// The verdicts on many grasps, in their order, on `threads` threads (0: as many as there are). The same bits
/// for any number of threads.
std::vector<ForceVerdict> evaluate_all(std::span<const Grasp> grasps, std::span<const model::Wrench> wrenches,
                                       const ForceOptions& options, int threads = 0);

}  // namespace pinjaw::planner
