#pragma once

#include <optional>
#include <string>

#include "host/app/context.hpp"
#include "host/planner/plan/plan.hpp"

/// What the commands that plan share.
namespace pinjaw::app {

struct PlanningOptions {
  planner::PlanOptions plan;
  std::string top = "100";
};

/// --top, --friction, --loading, --threads.
void add_planning_options(CLI::App& command, PlanningOptions& options);

/// Reads the task and plans it. Nothing where that failed, which has been reported.
std::optional<planner::Plan> plan_task(Context& context, const std::string& task_file, const PlanningOptions& options);

}  // namespace pinjaw::app
