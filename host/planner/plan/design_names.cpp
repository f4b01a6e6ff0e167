#include "host/planner/plan/design_names.hpp"

#include <fmt/format.h>

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

std::string DesignNames::next(const model::Design& design) {
  constexpr int kHexadecimal = 16;
  std::string id = id_of(design, kind_);
  const int count = ++given_[static_cast<std::uint32_t>(std::stoul(id, nullptr, kHexadecimal))];
  return count == 1 ? id : fmt::format("{}-{}", id, count);
}

void name_designs(std::vector<model::Design>& designs, std::string_view kind) {
  DesignNames names(kind);
  for (model::Design& design : designs) design.id = names.next(design);
}

}  // namespace pinjaw::planner
