#include <fmt/format.h>

#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>

#include "host/config/read.hpp"
#include "tests/host/planner/plan/stl_twin.hpp"

/// Prints how many of the geometrically sound designs of STEP parts their meshes have too, and the other way
/// round.
///
///     pinjaw_stl_share KIT.yaml PART.step [PART.stl] ...
///
/// Each STEP file is held against itself meshed at 0.01 and 0.05 mm, and against the STL files that follow
/// it.
namespace pinjaw::planner {
namespace {

void print_row(const std::string& part, const std::string& mesh, const Sound& step, const Sound& stl) {
  const Share there = share_of(step, stl);
  const Share back = share_of(stl, step);
  const auto percent = [](const Share& share) {
    return share.designs == 0
               ? 100.0
               : 100.0 * static_cast<double>(share.matched) / static_cast<double>(share.designs);
  };
  fmt::print("| {} | {} | {} | {} | {} | {:.1f} | {} | {:.1f} |\n", part, mesh, step.counts.funnel.features,
             stl.counts.funnel.features, there.designs, percent(there), back.designs, percent(back));
  for (const auto& [why, count] : there.lacking) fmt::print("    STL lacks {:6}: {}\n", count, why);
  for (const auto& [why, count] : back.lacking) fmt::print("    STEP lacks {:5}: {}\n", count, why);
  std::fflush(stdout);
}

void hold(const std::string& step_file, const std::vector<std::string>& stl_files, const model::Kit& kit) {
  const std::string name = std::filesystem::path(step_file).stem().string();
  const Sound step = sound_designs(step_file, kit);
  for (const double deflection_mm : {0.01, 0.05}) {
    const auto file =
        std::filesystem::temp_directory_path() / fmt::format("pinjaw-{}-{}.stl", name, deflection_mm);
    std::ofstream(file, std::ios::binary) << stl_of(shape_in(step_file), deflection_mm);
    print_row(name, fmt::format("{} mm", deflection_mm), step, sound_designs(file.string(), kit));
    std::filesystem::remove(file);
  }
  for (const std::string& file : stl_files) {
    print_row(name, std::filesystem::path(file).filename().string(), step, sound_designs(file, kit));
  }
}

int run(const std::vector<std::string>& arguments) {
  if (arguments.size() < 2) {
    fmt::print(stderr, "usage: pinjaw_stl_share KIT.yaml PART.step [PART.stl] ...\n");
    return 2;
  }
  const auto kit = config::read_kit(arguments.front());
  if (!kit) {
    fmt::print(stderr, "{}\n", base::render(kit.error(), "nothing was planned"));
    return 2;
  }
  fmt::print("| part | mesh | features STEP | STL | designs STEP | % in STL | designs STL | % in STEP |\n");
  fmt::print("| --- | --- | --- | --- | --- | --- | --- | --- |\n");
  for (std::size_t i = 1; i < arguments.size();) {
    std::vector<std::string> stl_files;
    std::size_t next = i + 1;
    while (next < arguments.size() && arguments[next].ends_with(".stl"))
      stl_files.push_back(arguments[next++]);
    hold(arguments[i], stl_files, *kit);
    i = next;
  }
  return 0;
}

}  // namespace
}  // namespace pinjaw::planner

int main(int argc, char** argv) {
  try {
    return pinjaw::planner::run({argv + 1, argv + argc});
  } catch (const std::exception& failure) {
    fmt::print(stderr, "{}\n", failure.what());
    return 1;
  }
}
