#pragma once

#include <nlohmann/json.hpp>
#include <numbers>

#include "host/base/json_fields.hpp"
#include "host/model/design.hpp"
#include "host/model/disturbance.hpp"
#include "host/model/kit.hpp"
#include "host/model/task.hpp"
#include "host/planner/plan/plan.hpp"

/// Model values as JSON, and back: what plans and cell plans share. Units stand in every key.
namespace pinjaw::planner {

inline constexpr double kDegree = std::numbers::pi / 180;  ///< angles are told in degrees

nlohmann::ordered_json vector_json(const model::Vector3d& v);
nlohmann::ordered_json pose_json(const geometry::Pose2& pose);
/// A friction coefficient and the model it was used with.
struct Friction {
  double mu = 0;
  model::FrictionModel model = model::FrictionModel::Pyramid;
};
nlohmann::ordered_json funnel_json(const Funnel& funnel);
nlohmann::ordered_json friction_json(const Friction& friction);
nlohmann::ordered_json kit_json(const model::Kit& kit);
nlohmann::ordered_json design_json(const model::Design& design);

model::Vector3d read_vector3(const base::JsonField& field);
geometry::Pose2 read_pose(const base::JsonField& field);
Friction read_friction(const base::JsonField& field);
/// Mistakes where a number is out of the range a kit file may have.
model::Kit read_kit_json(const base::JsonField& field);
model::Design read_design(const base::JsonField& field);

}  // namespace pinjaw::planner
