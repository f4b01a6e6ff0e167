#include "host/part/selected.hpp"

#include <algorithm>
#include <cctype>

#include "host/part/brep.hpp"

namespace pinjaw::part {
namespace {

std::string ending_of(const std::filesystem::path& file) {
  return lower_case(file.extension().string());
}

base::Expected<std::vector<NamedShape>> solids_of(const model::PartSource& source, const std::string& bytes) {
  if (source.profile) {
    return prism_of(*source.profile).map([&](const Shape& shape) {
      return std::vector<NamedShape>{{source.profile->name, shape}};
    });
  }
  if (ending_of(source.file) != ".step" && ending_of(source.file) != ".stp") {
    return base::failure(source.file.string() +
                         ": not a part file; expected .step, .stp, .stl or a profile in .yaml");
  }
  return read_step(bytes, source.file.string());
}

}  // namespace

std::string lower_case(std::string text) {
  std::ranges::transform(text, text.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

bool has_brep(const model::PartSource& source) {
  return source.profile || ending_of(source.file) != ".stl";
}

base::Expected<ChosenSolids> chosen_solids(const model::PartSource& source, const std::string& bytes,
                                           const Selection& selection) {
  auto solids = solids_of(source, bytes);
  if (!solids) return tl::unexpected(solids.error());
  auto chosen = selected(*solids, selection, source.file.string());
  if (!chosen) return tl::unexpected(chosen.error());
  return ChosenSolids{std::move(*solids), std::move(*chosen)};
}

}  // namespace pinjaw::part
