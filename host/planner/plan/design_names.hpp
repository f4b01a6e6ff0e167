#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "host/model/design.hpp"

namespace pinjaw::planner {

/// Gives designs their ids: by what each is, not by its rank, so that a plan made again calls it the same.
/// An id is the start of a SHA-256 over `kind`, the design's pins, what they touch and how the part lies;
/// equal ones are told apart in the order in which they come.
class DesignNames {
 public:
  explicit DesignNames(std::string_view kind) : kind_(kind) {}
  [[nodiscard]] std::string next(const model::Design& design);

 private:
  std::string kind_;
  std::unordered_map<std::uint32_t, int> given_;  ///< by the id's digits: how often
};

/// The same for designs that are all there.
void name_designs(std::vector<model::Design>& designs, std::string_view kind);

}  // namespace pinjaw::planner
