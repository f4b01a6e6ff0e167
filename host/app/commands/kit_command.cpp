#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "host/app/choices.hpp"
#include "host/app/commands/commands.hpp"
#include "host/config/read.hpp"
#include "host/planner/plan/json_values.hpp"

namespace pinjaw::app {

namespace {

namespace fs = std::filesystem;

struct KitOptions {
  std::string folder = "configs/kits";
  std::vector<std::string> files;
};

std::string one_line(const model::Kit& kit) {
  return fmt::format("{:<16} {} x {} holes at {:g} mm, pins {:g} mm, jaws {:g}..{:g} mm, {:g} N", kit.name,
                     kit.grid.columns, kit.grid.rows, kit.grid.spacing_mm, 2 * kit.pins.radius_mm,
                     kit.jaws.separation_mm.lo, kit.jaws.separation_mm.hi, kit.actuator.max_squeeze_n);
}

/// The kit files of a folder, by name; nothing, with exit code 3, where it cannot be listed.
std::optional<std::vector<fs::path>> files_in(Context& context, const std::string& folder) {
  std::error_code error;
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    if (entry.path().extension() == ".yaml") files.push_back(entry.path());
  }
  if (error) {
    context.fail(ExitCode::BadFile,
                 fmt::format("{}: {}; expected a folder of kit files", folder, error.message()));
    return std::nullopt;
  }
  std::ranges::sort(files);
  return files;
}

void run_kit_list(Context& context, const KitOptions& options) {
  const auto files = files_in(context, options.folder);
  if (!files) return;
  base::Diagnostics mistakes;
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  std::string text;
  for (const fs::path& file : *files) {
    const auto kit = config::read_kit(file);
    if (!kit) {
      mistakes.add(kit.error());
      continue;
    }
    nlohmann::ordered_json entry = planner::kit_json(*kit);
    entry["file"] = file.string();
    list.push_back(std::move(entry));
    text += one_line(*kit) + "\n";
  }
  if (context.json) {
    context.print(list.dump(1));
  } else if (!text.empty()) {
    context.print(text);
  }
  if (files->empty()) context.note("no kit files (*.yaml) in " + options.folder);
  if (!mistakes.empty())
    context.fail(mistakes, fmt::format("{} of {} kits are good", list.size(), files->size()));
}

std::string kit_text(const model::Kit& kit) {
  std::string lengths = "any length";
  if (!kit.pins.lengths_mm.empty())
    lengths = fmt::format("{:g} mm long", fmt::join(kit.pins.lengths_mm, ", "));
  return one_line(kit) +
         fmt::format("\n  pins {}; engage {:g} mm, stand out {:g} mm, clear by {:g} mm", lengths,
                     kit.pins.min_engagement_mm, kit.pins.protrusion_mm, kit.pins.clearance_mm) +
         fmt::format("\n  plates {:g} mm below the part, {:g} mm thick", kit.jaws.plate_gap_mm,
                     kit.jaws.plate_thickness_mm) +
         (kit.jaws.bodies.empty() ? "" : fmt::format(", {} bodies on each jaw", kit.jaws.bodies.size())) +
         fmt::format("\n  usable squeeze {:g} N (limit {:g} N, uncertain by {:g} N)",
                     kit.actuator.usable_squeeze_n(), kit.actuator.max_squeeze_n,
                     kit.actuator.force_uncertainty_n) +
         fmt::format("\n  sha256 {}", kit.sha256);
}

void run_kit_show(Context& context, const KitOptions& options) {
  const auto kit = config::read_kit(options.files.front());
  if (!kit) return context.fail(kit.error(), "nothing to show");
  context.print(context.json ? planner::kit_json(*kit).dump(1) : kit_text(*kit));
}

void run_kit_check(Context& context, const KitOptions& options) {
  base::Diagnostics mistakes;
  std::size_t good = 0;
  for (const std::string& file : options.files) {
    if (const auto kit = config::read_kit(file)) {
      ++good;
    } else {
      mistakes.add(kit.error());
    }
  }
  const std::string verdict = fmt::format("{} of {} kits are good", good, options.files.size());
  if (context.json) {
    const nlohmann::ordered_json document = {{"kits", options.files.size()}, {"good", good}};
    context.print(document.dump(1));
  } else if (mistakes.empty()) {
    context.print(options.files.size() == 1 ? "the kit is good" : "all kits are good");
  }
  if (!mistakes.empty()) context.fail(mistakes, verdict);
}

}  // namespace

void add_kit(CLI::App& app, Context& context) {
  CLI::App* command = app.add_subcommand("kit", "pin kits");
  command->require_subcommand(1);
  auto options = std::make_shared<KitOptions>();
  CLI::App* list = command->add_subcommand("list", "the kits of a folder");
  list->add_option("FOLDER", options->folder, "where the kits are")
      ->type_name("")
      ->check(file_name())
      ->capture_default_str();
  list->callback([&context, options] { run_kit_list(context, *options); });
  CLI::App* show = command->add_subcommand("show", "one kit");
  show->add_option("KIT", options->files, "kit file")
      ->type_name("")
      ->check(file_name())
      ->required()
      ->expected(1);
  show->callback([&context, options] { run_kit_show(context, *options); });
  CLI::App* check = command->add_subcommand("check", "every mistake in kit files");
  check->add_option("KIT", options->files, "kit files")->type_name("")->check(file_name())->required();
  check->callback([&context, options] { run_kit_check(context, *options); });
}

}  // namespace pinjaw::app
