#pragma once

#include <array>
#include <variant>
#include <vector>

#include "host/planner/force/ray_program.hpp"
#include "host/planner/force/squeeze.hpp"

namespace pinjaw::planner {

/// An optimal basic solution: value and the columns' amounts.
struct TableauOptimum {
  double value = 0;
  std::array<double, 4 * Grasp::kMaxContacts> x{};
};

using TableauOutcome = std::variant<TableauOptimum, Unresistable, Unbounded>;

/// The squeeze program by a two-phase tableau in quadruple precision under Bland's rule: a thousand times
/// slower than the kernel, finite on every input and with no condition on the costs. For the answers that the
/// kernel does not certify. A load within 1e-10 of the cone counts as inside, as in the kernel.
TableauOutcome solve_in_quadruple_precision(const RayProgram& program, const RightHandSide& b);

}  // namespace pinjaw::planner
