#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "firmware_sim/node/fault_spec.hpp"

namespace pinjaw::jaw_app {

/// What the shell learns; users script against these.
enum class ExitCode : int {
  Done = 0,  ///< ended by SIGTERM or SIGINT
  Usage = 2,
  BadFile = 3,
  Unavailable = 5,  ///< the bus or the world's socket
  Bug = 70,
};

/// A fault that a node's hardware gets at a time.
struct TimedFault {
  int node = 0;
  std::string text;  ///< as node::parse_fault reads it
  double at_s = 0;   ///< after the start
};

/// A node whose firmware runs on a board of its own, and the Unix socket that leads to the board's serial
/// line.
struct OuterBoard {
  int node = 0;
  std::string socket;
};

struct Options {
  std::vector<std::filesystem::path> controllers;
  std::string interface;                  ///< of Linux's CAN
  std::map<int, std::string> interfaces;  ///< of nodes that are on another one
  std::string world;                      ///< path of the Unix socket; empty: the world is not served
  std::uint64_t seed = 1;
  std::vector<TimedFault> faults;
  std::vector<OuterBoard> boards;
  bool events = false;  ///< the world's events on stderr
};

/// Help or version was asked for and printed, or the usage was wrong and told.
struct Ended {
  ExitCode code = ExitCode::Done;
};

/// Reads the command line.
std::variant<Options, Ended> read_options(int argc, const char* const* argv);

/// Reads `NODE:FAULT[=VALUE][@SECONDS]`, or gives a sentence on what is wrong.
tl::expected<TimedFault, std::string> parse_timed_fault(const std::string& text);

/// Reads `NODE=SOCKET`, or gives a sentence on what is wrong.
tl::expected<OuterBoard, std::string> parse_board(const std::string& text);

/// Reads `NODE=can:IFACE`, or gives a sentence on what is wrong.
tl::expected<std::pair<int, std::string>, std::string> parse_node_bus(const std::string& text);

/// The interface of `can:IFACE`, or a sentence that says which buses there are.
tl::expected<std::string, std::string> parse_bus(const std::string& text);

}  // namespace pinjaw::jaw_app
