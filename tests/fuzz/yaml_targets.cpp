#include <cmath>

#include "host/base/json_fields.hpp"
#include "host/config/materials.hpp"
#include "host/config/read.hpp"
#include "host/planner/plan/json_values.hpp"
#include "tests/fuzz/answers.hpp"

namespace pinjaw::fuzz {
namespace {

template <class T>
using Reader = config::Read<T> (*)(const std::filesystem::path&);

/// A target that reads a YAML file and gives each value that comes out to `holds`.
template <class T>
Target yaml(const std::string& name, Reader<T> read, std::vector<std::string> seeds,
            const std::function<void(const T&)>& holds = {}) {
  seeds.push_back("tests/bad_files/" + name);
  return {name,
          [read, holds](std::string_view bytes) {
            const config::Read<T> value = read(written(bytes, ".yaml"));
            if (!value) return must_tell(value.error());
            if (holds) holds(*value);
          },
          std::move(seeds), "yaml.dict"};
}

/// What a plan says of a good kit is a good kit again, and the same.
void survives_a_plan(const model::Kit& kit) {
  const std::string text = planner::kit_json(kit).dump();
  const auto parsed = base::parse_json(text, "kit.json");
  must(parsed.has_value(), "a kit that is no JSON: " + text);
  base::Diagnostics mistakes;
  const std::string file = "kit.json";
  const model::Kit again = planner::read_kit_json(base::JsonField(&*parsed, "kit", &file, &mistakes));
  must(mistakes.empty(), "a good kit that a plan refuses: " + base::render(mistakes, text));
  must(planner::kit_json(again).dump() == text, "a kit that a plan changes: " + text);
}

void has_finite_edges(const model::Profile& profile) {
  must(!profile.loops.empty() && std::isfinite(profile.thickness_mm), "a profile without a shape");
  for (const auto& loop : profile.loops) {
    must(!loop.empty(), "a loop without edges");
    for (const auto& edge : loop) {
      must(std::isfinite(geometry::length_mm(edge.curve)), "an edge without a length");
    }
  }
}

}  // namespace

std::vector<Target> yaml_targets() {
  return {yaml<model::Kit>("kit", config::read_kit, {"configs/kits"}, survives_a_plan),
          yaml<model::Profile>("profile", config::read_profile,
                               {"configs/parts/cam.yaml", "configs/parts/l-plate.yaml"}, has_finite_edges),
          yaml<model::Task>("task", config::read_task, {"configs/tasks"}),
          yaml<config::Materials>("materials", config::read_materials, {"configs/materials.yaml"}),
          yaml<model::Cell>("cell", config::read_cell, {"configs/cells"}),
          yaml<model::Sequence>("sequence", config::read_sequence, {"configs/sequences"}),
          yaml<model::Controller>("controller", config::read_controller, {"configs/controllers"})};
}

}  // namespace pinjaw::fuzz
