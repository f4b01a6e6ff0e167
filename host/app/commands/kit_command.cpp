#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>

#include "host/app/commands/commands.hpp"
#include "host/base/files.hpp"
#include "host/config/read.hpp"

namespace pinjaw::app {

namespace {

namespace fs = std::filesystem;

struct Options {
  std::string folder = "configs/kits";
  std::vector<std::string> files;
};

std::string one_line(const model::Kit& kit) {
  return fmt::format("{:<16} {} x {} holes at {:g} mm, pins {:g} mm, jaws {:g}..{:g} mm, {:g} N", kit.name,
                     kit.grid.columns, kit.grid.rows, kit.grid.spacing_mm, 2 * kit.pins.radius_mm,
                     kit.jaws.separation_mm.lo, kit.jaws.separation_mm.hi, kit.actuator.max_squeeze_n);
}

void run_list(Context& context, const Options& options) {
  std::error_code none;
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(options.folder, none)) {
    if (entry.path().extension() == ".yaml") files.push_back(entry.path());
  }
  if (none) return context.fail(ExitCode::BadFile, options.folder + ": " + none.message());
  std::ranges::sort(files);
  for (const fs::path& file : files) {
    const auto kit = config::read_kit(file);
    context.print(kit ? one_line(*kit) : fmt::format("{}: has mistakes; see pinjaw kit check", file.string()));
  }
}

void run_show(Context& context, const Options& options) {
  const auto kit = config::read_kit(options.files.front());
  if (!kit) return context.fail(kit.error(), "nothing to show");
  context.print(one_line(*kit));
  std::string lengths = "any length";
  if (!kit->pins.lengths_mm.empty()) lengths = fmt::format("{:g} mm long", fmt::join(kit->pins.lengths_mm, ", "));
  context.print(fmt::format("  pins {}; engage {:g} mm, stand out {:g} mm, clear by {:g} mm", lengths,
                            kit->pins.min_engagement_mm, kit->pins.protrusion_mm, kit->pins.clearance_mm));
  context.print(fmt::format("  plates {:g} mm below the part, {:g} mm thick", kit->jaws.plate_gap_mm,
                            kit->jaws.plate_thickness_mm));
  context.print(fmt::format("  usable squeeze {:g} N (limit {:g} N, uncertain by {:g} N)",
                            kit->actuator.usable_squeeze_n(), kit->actuator.max_squeeze_n,
                            kit->actuator.force_uncertainty_n));
  context.print(fmt::format("  sha256 {}", kit->sha256));
}

void run_check(Context& context, const Options& options) {
  base::Diagnostics mistakes;
  for (const std::string& file : options.files) {
    if (const auto kit = config::read_kit(file); !kit) mistakes.add(kit.error());
  }
  if (!mistakes.empty()) return context.fail(mistakes, "the other kits are good");
  context.print(fmt::format("{} good", options.files.size() == 1 ? "the kit is" : "all kits are"));
}

}  // namespace

void add_kit(CLI::App& app, Context& context) {
  CLI::App* command = app.add_subcommand("kit", "pin kits");
  command->require_subcommand(1);
  auto options = std::make_shared<Options>();
  CLI::App* list = command->add_subcommand("list", "the kits of a folder");
  list->add_option("FOLDER", options->folder, "where the kits are")->capture_default_str();
  list->callback([&context, options] { run_list(context, *options); });
  CLI::App* show = command->add_subcommand("show", "one kit");
  show->add_option("KIT", options->files, "kit file")->required()->expected(1);
  show->callback([&context, options] { run_show(context, *options); });
  CLI::App* check = command->add_subcommand("check", "every mistake in kit files");
  check->add_option("KIT", options->files, "kit files")->required();
  check->callback([&context, options] { run_check(context, *options); });
}

}  // namespace pinjaw::app
