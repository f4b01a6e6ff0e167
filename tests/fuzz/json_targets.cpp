#include "host/base/files.hpp"
#include "host/cell/read_cell.hpp"
#include "host/planner/plan/layout.hpp"
#include "host/planner/plan/plan_json.hpp"
#include "host/report/sheet.hpp"
#include "tests/fuzz/answers.hpp"

namespace pinjaw::fuzz {
namespace {

/// Whatever a plan says of a design, a sheet can be drawn and a layout is made or refused with a sentence.
void can_be_used(const model::Kit& kit, const model::Design& design, const std::string& part_sha256) {
  report::Sheet sheet;
  sheet.part_sha256 = part_sha256;
  sheet.kit = kit;
  sheet.design = design;
  const auto picture = report::written(report::sheet_picture(sheet), report::PictureFormat::Svg);
  must(picture.has_value() || !picture.error().message.empty(), "no sheet, and no reason");
  const auto layout = planner::layout_of({kit, design, part_sha256, false});
  must(layout.has_value() || !layout.error().message.empty(), "no layout, and no reason");
}

void answer_plan(std::string_view bytes) {
  const auto plan = planner::read_plan(written(bytes, ".json"));
  if (!plan) return must_tell(plan.error());
  const std::string text = planner::to_json(*plan);
  const auto again = planner::read_plan(written(text, ".json"));
  if (!again) return must(false, base::render(again.error(), "a plan that was read is not read again"));
  must(planner::to_json(*again) == text, "a plan changes when it is read and written");
  if (!plan->designs.empty()) can_be_used(plan->kit, plan->designs.front(), plan->part.sha256);
}

void answer_cell_plan(std::string_view bytes) {
  const auto plan = cell::read_cell_plan(written(bytes, ".json"));
  if (!plan) return must_tell(plan.error());
  for (const cell::CellDesign& design : plan->designs) {
    must(design.stations.size() == plan->stations.size(), "a design without a station");
  }
  if (plan->designs.empty() || plan->stations.empty()) return;
  can_be_used(plan->stations.front().kit, plan->designs.front().stations.front().design, plan->part_sha256);
}

}  // namespace

std::vector<Target> json_targets() {
  return {{"plan", answer_plan, {}, "json.dict"}, {"cell-plan", answer_cell_plan, {}, "json.dict"}};
}

}  // namespace pinjaw::fuzz
