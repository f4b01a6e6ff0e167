#pragma once

#include <nlohmann/json.hpp>

#include "host/base/json_fields.hpp"
#include "host/model/robust.hpp"

/// How robust a design is as JSON, and back.
namespace pinjaw::planner {

nlohmann::ordered_json ranges_json(const model::Ranges& ranges);
nlohmann::ordered_json robust_json(const model::Robust& robust);

model::Ranges read_ranges_json(const base::JsonField& field);
model::Robust read_robust(const base::JsonField& field);

}  // namespace pinjaw::planner
