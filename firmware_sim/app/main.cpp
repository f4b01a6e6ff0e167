// pinjaw-jaw: simulated jaw controllers and their world on a real CAN interface, in real time.
#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <csignal>
#include <exception>

#include "firmware_sim/app/board_line.hpp"
#include "firmware_sim/app/members.hpp"
#include "firmware_sim/app/options.hpp"
#include "firmware_sim/app/program.hpp"
#include "protocol/socketcan/lasting_bus.hpp"

namespace {

using namespace pinjaw;
using jaw_app::ExitCode;

std::atomic<bool> stop_requested = false;
static_assert(std::atomic<bool>::is_always_lock_free);

void request_stop(int /*signal*/) {
  stop_requested = true;
}

void catch_signals() {
  struct sigaction action {};
  action.sa_handler = request_stop;
  sigaction(SIGTERM, &action, nullptr);
  sigaction(SIGINT, &action, nullptr);
}

ExitCode fail(ExitCode code, const std::string& why) {
  fmt::print(stderr, "pinjaw-jaw: {}\n", why);
  return code;
}

/// Whether one of the files describes that node.
bool has_node(const std::vector<node::Figures>& members, int node) {
  return std::ranges::find(members, node, &node::Figures::node) != members.end();
}

/// A fault for a node that none of the files describes.
const jaw_app::TimedFault* homeless(const std::vector<jaw_app::TimedFault>& faults,
                                    const std::vector<node::Figures>& members) {
  const auto found =
      std::ranges::find_if(faults, [&](const auto& fault) { return !has_node(members, fault.node); });
  return found == faults.end() ? nullptr : &*found;
}

std::string greeting(const std::vector<node::Figures>& members, const jaw_app::Options& options) {
  std::string nodes;
  for (const node::Figures& member : members) nodes += fmt::format(" {}", member.node);
  std::string apart;
  for (const auto& [node, interface] : options.interfaces)
    apart += fmt::format(", node {} on can:{}", node, interface);
  const std::string world = options.world.empty() ? "" : ", world at " + options.world;
  return fmt::format("ready: node{} on can:{}{}, seed {}{}", nodes, options.interface, apart, options.seed,
                     world);
}

ExitCode simulate(const jaw_app::Options& options) {
  catch_signals();  // first: whoever sees the world's socket may already end us
  const auto members = jaw_app::read_members(options.controllers);
  if (!members) {
    fmt::print(stderr, "{}", base::render(members.error(), "nothing was simulated"));
    return ExitCode::BadFile;
  }
  if (const auto* fault = homeless(options.faults, *members)) {
    return fail(ExitCode::Usage, fmt::format("--fault {}:{}: no controller file is of node {}", fault->node,
                                             fault->text, fault->node));
  }
  for (const auto& [node, interface] : options.interfaces) {
    if (!has_node(*members, node)) {
      return fail(ExitCode::Usage, fmt::format("--node-bus {}=can:{}: no controller file is of node {}", node,
                                               interface, node));
    }
  }
  std::vector<std::unique_ptr<bus::Bus>> buses;
  for (const node::Figures& member : *members) {
    const auto own = options.interfaces.find(member.node);
    auto opened = socketcan::LastingBus::open(
        own == options.interfaces.end() ? options.interface : own->second,
        {.filters = jaw_app::filters_of(member.node, member.can_fd), .patient = true});
    if (!opened) return fail(ExitCode::Unavailable, opened.error().message);
    buses.push_back(std::move(*opened));
  }
  std::vector<std::unique_ptr<jaw_app::BoardLine>> boards;
  for (const jaw_app::OuterBoard& board : options.boards) {
    if (!has_node(*members, board.node)) {
      return fail(ExitCode::Usage,
                  fmt::format("--board {}=...: no controller file is of node {}", board.node, board.node));
    }
    auto line = jaw_app::BoardLine::connect(board.socket);
    if (!line) return fail(ExitCode::Unavailable, line.error());
    boards.push_back(std::move(*line));
  }
  std::unique_ptr<bench::SocketServer> server;
  if (!options.world.empty()) {
    auto listening = bench::SocketServer::listen(options.world);
    if (!listening) return fail(ExitCode::Unavailable, listening.error().message);
    server = std::move(*listening);
  }
  jaw_app::Program program(*members, std::move(buses), std::move(server), options);
  for (std::size_t i = 0; i < boards.size(); ++i) program.hand_to(options.boards[i].node, *boards[i]);
  fmt::print(stderr, "pinjaw-jaw: {}\n", greeting(*members, options));
  program.run(stop_requested);
  return ExitCode::Done;
}

ExitCode run(int argc, char** argv) {
  const auto asked = jaw_app::read_options(argc, argv);
  if (const auto* ended = std::get_if<jaw_app::Ended>(&asked)) return ended->code;
  return simulate(std::get<jaw_app::Options>(asked));
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return static_cast<int>(run(argc, argv));
  } catch (const std::exception& error) {
    fmt::print(stderr, "pinjaw-jaw: a bug: {}\n", error.what());
  }
  return static_cast<int>(ExitCode::Bug);
}
