#include "host/planner/plan/design_names.hpp"

#include <fmt/format.h>

#include <set>
#include <string>

#include "host/base/sha256.hpp"

namespace pinjaw::planner {

namespace {

std::string id_of(const model::Design& design, std::string_view kind) {
  std::string text = fmt::format("{} {:.6f}", kind, design.part_pose.theta_rad);
  for (const model::PinDesign& pin : design.pins) {
    text += fmt::format(" {}{},{}:{}", pin.hole.jaw == model::JawSide::Left ? 'L' : 'R', pin.hole.column,
                        pin.hole.row, pin.feature);
  }
  constexpr std::size_t kDigits = 8;  // chosen: short to type; 10^4 designs meet once in 80 plans
  return base::sha256(text).substr(0, kDigits);
}

}  // namespace

void name_designs(std::vector<model::Design>& designs, std::string_view kind) {
  std::set<std::string> taken;
  for (model::Design& design : designs) {
    const std::string id = id_of(design, kind);
    design.id = id;
    for (int again = 2; !taken.insert(design.id).second; ++again) design.id = fmt::format("{}-{}", id, again);
  }
}

}  // namespace pinjaw::planner
