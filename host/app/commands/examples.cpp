#include <CLI/CLI.hpp>
#include <array>
#include <string_view>

#include "host/app/choices.hpp"
#include "host/app/commands/commands.hpp"

namespace pinjaw::app {

namespace {

struct Example {
  std::string_view command;
  std::string_view lines;
};

constexpr std::array kExamples = {
    Example{"plan",
            "  pinjaw plan configs/tasks/valve-pedestal.yaml -o plan.json\n"
            "  pinjaw plan configs/tasks/cam.yaml --top all --friction cone > plan.json\n"
            "  pinjaw plan configs/tasks/l-plate.yaml --robust 20 --rank robust -o plan.json"},
    Example{"planar",
            "  pinjaw planar configs/parts/cam.yaml --kit configs/kits/acc-pedestal.yaml -o fixtures.json"},
    Example{"features",
            "  pinjaw features configs/tasks/valve-pedestal.yaml -o features.svg\n"
            "  pinjaw features configs/tasks/valve-pedestal.yaml -o features.json"},
    Example{"why",
            "  pinjaw why configs/tasks/valve-pedestal.yaml\n"
            "  pinjaw why configs/tasks/valve-pedestal.yaml --design best"},
    Example{"check",
            "  pinjaw check plan.json\n  pinjaw check plan.json --design best --all\n  pinjaw check "
            "plan.json --exact all"},
    Example{"cell", "  pinjaw cell configs/cells/acc.yaml -o cell.json"},
    Example{"sheet", "  pinjaw sheet plan.json --design best -o sheet.pdf"},
    Example{"kit", "  pinjaw kit list\n  pinjaw kit check configs/kits/*.yaml"},
    Example{"kit list", "  pinjaw kit list configs/kits"},
    Example{"kit show", "  pinjaw kit show configs/kits/acc-pedestal.yaml"},
    Example{"kit check", "  pinjaw kit check configs/kits/*.yaml"},
    Example{"send", "  pinjaw send plan.json --design best --node 2 --bus can:can0"},
    Example{"jaw", "  pinjaw jaw status --node 2 --bus can:can0"},
    Example{"jaw hold", "  pinjaw jaw hold --node 2 --bus can:can0"},
    Example{"jaw close", "  pinjaw jaw close --node 2 --bus can:can0"},
    Example{"jaw squeeze", "  pinjaw jaw squeeze --node 2 --force-n 60 --permit-n 100 --bus can:can0"},
    Example{"jaw offer", "  pinjaw jaw offer --node 2 --to 1 --bus can:can0"},
    Example{"jaw accept", "  pinjaw jaw accept --node 1 --from 2 --bus can:can0"},
    Example{"jaw abort", "  pinjaw jaw abort --node 1 --bus can:can0"},
    Example{"jaw release", "  pinjaw jaw release --node 2 --bus can:can0"},
    Example{"jaw clear", "  pinjaw jaw clear --node 2 --bus can:can0"},
    Example{"jaw status", "  pinjaw jaw status --node 2 --bus can:can0"},
    Example{"run",
            "  pinjaw run configs/sequences/acc-cleaning.yaml --report run.json --log run.log\n"
            "  pinjaw run configs/sequences/acc-cleaning.yaml --dry"},
    Example{"dbc", "  pinjaw dbc -o pinjaw.dbc\n  pinjaw dbc --nodes 1,2,3 -o cell.dbc"},
    Example{"explain", "  pinjaw explain OVER_FORCE\n  pinjaw explain 0x7020"}};

void add_to(CLI::App& parent, const std::string& prefix) {
  for (CLI::App* command : parent.get_subcommands({})) {
    const std::string name = prefix + command->get_name();
    std::string lines;
    for (const Example& entry : kExamples) {
      if (entry.command == name) lines = entry.lines;
    }
    command->footer(example(lines));
    add_to(*command, name + " ");
  }
}

}  // namespace

void add_examples(CLI::App& app) {
  add_to(app, "");
}

}  // namespace pinjaw::app
