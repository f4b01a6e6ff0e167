#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <memory>
#include <nlohmann/json.hpp>

#include "host/app/commands/commands.hpp"
#include "host/base/diagnostics.hpp"
#include "protocol/describe/fault_help.hpp"
#include "protocol/wire/names.hpp"

namespace pinjaw::app {

namespace {

nlohmann::ordered_json json_of(const describe::FaultHelp& help) {
  return {{"name", wire::to_string(help.code)},
          {"code", fmt::format("0x{:04x}", static_cast<unsigned>(help.code))},
          {"meaning", help.meaning},
          {"cause", help.cause},
          {"remedy", help.remedy},
          {"simulated", help.simulated}};
}

void list_all(const Context& context) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  std::string text;
  for (const describe::FaultHelp& help : describe::fault_helps()) {
    list.push_back(json_of(help));
    text += fmt::format("0x{:04x} {:<18} {}\n", static_cast<unsigned>(help.code), wire::to_string(help.code),
                        help.meaning);
  }
  context.print(context.json ? list.dump(1) : text);
}

void run_explain(Context& context, const std::string& code) {
  if (code.empty()) return list_all(context);
  const auto help = describe::find_fault(code);
  if (!help) {
    std::vector<std::string> names;
    for (const describe::FaultHelp& known : describe::fault_helps())
      names.emplace_back(wire::to_string(known.code));
    std::string upper = code;
    std::ranges::transform(upper, upper.begin(),
                           [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
    return context.fail(ExitCode::Usage, fmt::format("there is no fault {}{}; pinjaw explain lists all", code,
                                                     base::did_you_mean(upper, names)));
  }
  if (context.json) return context.print(json_of(*help).dump(1));
  context.print(
      fmt::format("{} (0x{:04x}): {}\n  usual cause: {}\n  what to do:  {}{}", wire::to_string(help->code),
                  static_cast<unsigned>(help->code), help->meaning, help->cause, help->remedy,
                  help->simulated ? "" : "\n  for other controllers; the simulated one does not report it"));
}

}  // namespace

void add_explain(CLI::App& app, Context& context) {
  auto code = std::make_shared<std::string>();
  CLI::App* command =
      app.add_subcommand("explain", "a controller's fault: what it means, why it comes, what to do");
  command->add_option("CODE", *code, "name or hexadecimal number of a fault; without it all are listed")
      ->type_name("");
  command->callback([&context, code] { run_explain(context, *code); });
}

}  // namespace pinjaw::app
