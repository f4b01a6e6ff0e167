#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "host/base/expected.hpp"
#include "host/model/design.hpp"
#include "host/model/disturbance.hpp"
#include "host/model/task.hpp"
#include "host/planner/force/disturbances.hpp"
#include "host/planner/plan/scene.hpp"

namespace pinjaw::planner {

/// How many fixtures are left after each phase, twins counted once (DESIGN 3).
struct Funnel {
  std::int64_t features = 0;
  std::int64_t planar = 0;
  std::int64_t heights = 0;
  std::int64_t loadable = 0;
  std::int64_t not_wedging = 0;  ///< neither wedge nor jam
  std::int64_t resistable = 0;
  std::int64_t strong = 0;
};

/// Why fixtures (or edges of the part) were left out: phase, then reason, then count.
using Losses = std::map<std::string, std::map<std::string, std::int64_t>>;

/// What a plan remembers of the part.
struct PartFacts {
  std::string file;
  std::string sha256;
  model::Vector3d up = model::Vector3d::UnitZ();
  double mass_kg = 0;
  model::Vector3d centroid_mm = model::Vector3d::Zero();  ///< part frame
};

/// Every design that holds the part, smallest required squeeze first, and how the others were lost.
struct Plan {
  std::string task;
  PartFacts part;
  model::Kit kit;
  model::Side side = model::Side::Below;
  std::vector<model::Obstacle> obstacles;
  std::optional<model::Attached> attached;
  double friction = 0;
  bool loading_2d = false;
  model::FrictionModel friction_model = model::FrictionModel::Pyramid;
  std::string random_algorithm;
  std::vector<model::Disturbance> disturbances;  ///< part frame, `always` included
  Funnel funnel;
  Losses losses;
  std::vector<Jet> jets;  ///< among which the worst sprays of certified designs are; none where none is
  std::optional<model::Ranges> ranges;  ///< where designs tell how robust they are
  bool ranked_by_worst = false;         ///< the designs that do come first, least worst squeeze first
  std::vector<model::Design> designs;
};

/// The task as far as a plan remembers it: enough to read the scene again. Its disturbances are the plan's.
model::Task task_of(const Plan& plan);

struct PlanOptions {
  model::FrictionModel friction = model::FrictionModel::Pyramid;
  bool loading_2d = false;
  std::size_t top = 100;      ///< designs kept in the plan; 0 keeps all
  std::size_t certify = 0;    ///< the best so many designs are told their worst spray
  int threads = 0;            ///< 0: as many as the machine has
  std::stop_token stop = {};  ///< asks the plan to end early, with a Failure
};

/// How far a plan has come; `total` is 0 where it cannot be told.
struct Progress {
  std::string phase;
  std::int64_t done = 0;
  std::int64_t total = 0;
};
using ProgressSink = std::function<void(const Progress&)>;

/// Phases 1 to 5 for `task` in its scene (BB 3.2). A plan without designs is a legitimate answer; a Failure
/// tells why the task cannot be planned at all. The result does not depend on the number of threads.
base::Expected<Plan> make_plan(const model::Task& task, const Scene& scene, const PlanOptions& options,
                               const ProgressSink& progress = {});

}  // namespace pinjaw::planner
