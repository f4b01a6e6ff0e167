#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "host/base/expected.hpp"
#include "host/part/part.hpp"

/// Which of a file's solids a selection means. Private to host/part.
namespace pinjaw::part {

/// Largest part file. Chosen: reading takes some twenty times as much memory.
inline constexpr std::size_t kMostFileBytes = 512U << 20U;

std::string lower_case(std::string text);

/// Of solids with names, those that make the part.
template <class Named>
base::Expected<std::vector<Named>> selected(const std::vector<Named>& solids, const Selection& selection,
                                            const std::string& file) {
  if (selection.base.empty()) return solids;
  std::vector<Named> base;
  std::vector<Named> rest;
  std::string names;
  for (const Named& solid : solids) {
    const bool wanted = base.empty() && lower_case(solid.name) == lower_case(selection.base);
    (wanted ? base : rest).push_back(solid);
    names += (names.empty() ? "\"" : ", \"") + solid.name + "\"";
  }
  if (base.empty()) {
    return base::failure(file + ": no solid is named \"" + selection.base + "\"; it holds " + names);
  }
  if (selection.rest && rest.empty()) {
    return base::failure(file + ": holds nothing but \"" + selection.base + "\"");
  }
  return selection.rest ? rest : base;
}

}  // namespace pinjaw::part
