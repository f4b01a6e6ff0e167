#pragma once

#include <optional>
#include <string>

#include "host/model/disturbance.hpp"
#include "host/planner/force/grasp.hpp"

/// Other people's solvers for the squeeze program, and ours written a second time, slowly: referees.
namespace pinjaw::planner::peers {

enum class Status { Optimal, Infeasible, Unbounded, Failed };

struct Result {
  Status status = Status::Failed;
  double value = 0;
};

/// GLPK on the rays of the pyramids: 6 rows.
Result glpk(const Grasp& grasp, const model::Wrench& wrench);
/// GLPK on BB's own program: 3n unit wrenches and 4n friction rows.
Result glpk_paper_form(const Grasp& grasp, const model::Wrench& wrench);
/// CLP on the rays.
Result clp(const Grasp& grasp, const model::Wrench& wrench);
/// The rays in quadruple precision: two-phase tableau, Bland's rule. `half_width`: of the pyramid, mu/sqrt 2
/// for BB's.
Result quadruple(const Grasp& grasp, const model::Wrench& wrench,
                 std::optional<double> half_width = std::nullopt);

std::string to_string(const Result& result);

}  // namespace pinjaw::planner::peers
