#include "firmware_sim/app/options.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <charconv>
#include <cmath>

namespace pinjaw::jaw_app {
namespace {

constexpr const char* kAbout =
    "Simulates jaw controllers: the firmware, its pneumatics, and the world around them, in real time.";

constexpr const char* kExamples = R"(
Examples:
  pinjaw-jaw configs/controllers/pedestal.yaml --bus can:vcan0
  pinjaw-jaw configs/controllers/*.yaml --bus can:vcan0 --world world.sock --seed 7
  pinjaw-jaw arm.yaml pedestal.yaml --bus can:vcan0 --fault 2:leak=0.05 --fault 1:supply_lost@20

A machine without a CAN interface gets a virtual one by: ip link add vcan0 type vcan && ip link set vcan0 up
SIGTERM and SIGINT end it with exit code 0. Other exit codes: 2 usage, 3 bad file, 5 bus unavailable, 70 a bug.)";

constexpr std::string_view kBuses = "pinjaw-jaw runs on can:IFACE, Linux's CAN, e.g. can:vcan0";

template <class T>
std::optional<T> number(std::string_view text) {
  T value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

tl::unexpected<std::string> wrong(std::string why) {
  return tl::unexpected(std::move(why));
}

/// `NODE=REST` with a node from 1 to 14 and something after it.
std::optional<std::pair<int, std::string>> of_node(const std::string& text) {
  const auto equals = text.find('=');
  const auto node = number<int>(std::string_view(text).substr(0, equals));
  if (equals == std::string::npos || equals + 1 == text.size() || !node || *node < 1 || *node > 14)
    return std::nullopt;
  return std::pair{*node, text.substr(equals + 1)};
}

Ended usage(const std::string& why) {
  fmt::print(stderr, "pinjaw-jaw: {}\nRun with --help for more.\n", why);
  return {ExitCode::Usage};
}

}  // namespace

tl::expected<TimedFault, std::string> parse_timed_fault(const std::string& text) {
  const auto colon = text.find(':');
  const auto node = number<int>(std::string_view(text).substr(0, colon));
  if (colon == std::string::npos || !node || *node < 1 || *node > 14) {
    return wrong(
        fmt::format("--fault '{}': expected NODE:FAULT[=VALUE][@SECONDS] with a node from 1 to 14", text));
  }
  TimedFault fault{.node = *node, .text = text.substr(colon + 1)};
  if (const auto at = fault.text.find('@'); at != std::string::npos) {
    const auto at_s = number<double>(std::string_view(fault.text).substr(at + 1));
    if (!at_s || !std::isfinite(*at_s) || *at_s < 0) {
      return wrong(fmt::format("--fault '{}': expected seconds from the start after @", text));
    }
    fault.at_s = *at_s;
    fault.text.resize(at);
  }
  if (const auto known = node::parse_fault(fault.text); !known) {
    return wrong(fmt::format("--fault '{}': {}", text, known.error()));
  }
  return fault;
}

tl::expected<OuterBoard, std::string> parse_board(const std::string& text) {
  const auto read = of_node(text);
  if (!read) return wrong(fmt::format("--board '{}': expected NODE=SOCKET with a node from 1 to 14", text));
  return OuterBoard{.node = read->first, .socket = read->second};
}

tl::expected<std::pair<int, std::string>, std::string> parse_node_bus(const std::string& text) {
  const auto read = of_node(text);
  if (!read)
    return wrong(fmt::format("--node-bus '{}': expected NODE=can:IFACE with a node from 1 to 14", text));
  const auto interface = parse_bus(read->second);
  if (!interface) return tl::unexpected(interface.error());
  return std::pair{read->first, *interface};
}

tl::expected<std::string, std::string> parse_bus(const std::string& text) {
  if (text.starts_with("can:") && text.size() > 4) return text.substr(4);
  if (text.starts_with("sim:")) {
    return wrong(fmt::format("--bus {}: the bus in virtual time lives inside one command (pinjaw run); {}",
                             text, kBuses));
  }
  return wrong(fmt::format("--bus '{}': no such bus; {}", text, kBuses));
}

std::variant<Options, Ended> read_options(int argc, const char* const* argv) {
  CLI::App app(kAbout, "pinjaw-jaw");
  Options options;
  std::string bus;
  std::vector<std::string> faults;
  std::vector<std::string> boards;
  std::vector<std::string> node_buses;
  app.set_version_flag("--version", "pinjaw-jaw " PINJAW_VERSION);
  app.footer(kExamples);
  app.add_option("CONTROLLER", options.controllers, "controller files, one a node")->required();
  app.add_option("--bus", bus, "can:IFACE")->envname("PINJAW_BUS")->required();
  app.add_option("--node-bus", node_buses, "NODE=can:IFACE: this node is on another interface")
      ->allow_extra_args(false);
  app.add_option("--world", options.world, "serve the world on this Unix socket, for pinjaw run --world");
  app.add_option("--seed", options.seed, "of noise and of each specimen's errors")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  app.add_option("--fault", faults, "NODE:FAULT[=VALUE][@SECONDS]; FAULT is one of " + node::known_faults())
      ->allow_extra_args(false);
  app.add_option("--board", boards,
                 "NODE=SOCKET: a board of its own is the node's controller; SOCKET leads to its serial line")
      ->allow_extra_args(false);
  app.add_flag("--events", options.events, "tell the world's events on stderr");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& mistake) {
    return Ended{app.exit(mistake) == 0 ? ExitCode::Done : ExitCode::Usage};
  }
  const auto interface = parse_bus(bus);
  if (!interface) return usage(interface.error());
  options.interface = *interface;
  for (const std::string& text : faults) {
    const auto fault = parse_timed_fault(text);
    if (!fault) return usage(fault.error());
    options.faults.push_back(*fault);
  }
  for (const std::string& text : node_buses) {
    const auto node_bus = parse_node_bus(text);
    if (!node_bus) return usage(node_bus.error());
    options.interfaces.insert(*node_bus);
  }
  for (const std::string& text : boards) {
    const auto board = parse_board(text);
    if (!board) return usage(board.error());
    options.boards.push_back(*board);
  }
  return options;
}

}  // namespace pinjaw::jaw_app
