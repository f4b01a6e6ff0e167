#pragma once

#include <optional>
#include <string>
#include <vector>

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

/// --threads alone.
void add_threads(CLI::App& command, int& threads);

/// The design of that id, or the first where it is "best"; nothing where there is none.
const model::Design* find_design(const std::vector<model::Design>& designs, const std::string& id);

/// Reports that find_design found nothing in `file`; exit code 1.
void fail_without_design(Context& context, const std::string& id, const std::string& file,
                         std::size_t designs);

/// A task and what it speaks of.
struct Job {
  model::Task task;
  planner::Scene scene;
  planner::PlanOptions options;
};

/// Reads the task and its files. Nothing where that failed, which has been reported.
std::optional<Job> read_job(Context& context, const std::string& task_file, const PlanningOptions& options);

/// Plans it. Nothing where that failed, which has been reported.
std::optional<planner::Plan> plan_job(Context& context, const Job& job, const std::string& task_file);

/// Reads the task and plans it. Nothing where that failed, which has been reported.
std::optional<planner::Plan> plan_task(Context& context, const std::string& task_file,
                                       const PlanningOptions& options);

}  // namespace pinjaw::app
