#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "firmware_sim/app/options.hpp"
#include "firmware_sim/node/figures.hpp"
#include "firmware_sim/world/world.hpp"
#include "protocol/bench/unix_socket.hpp"
#include "protocol/bus/bus.hpp"

namespace pinjaw::jaw_app {

/// Filters for what a controller listens to, so that its receive buffer is not filled by the rest.
std::vector<bus::Filter> filters_of(int node, bool can_fd = false);

/// The cell in real time: one world stepped each millisecond of CLOCK_MONOTONIC, its socket served in
/// between.
class Program {
 public:
  /// `buses` are the nodes' ends, in the order of `members`; `server` may be null.
  Program(const std::vector<node::Figures>& members, std::vector<std::unique_ptr<bus::Bus>> buses,
          std::unique_ptr<bench::SocketServer> server, const Options& options);

  /// `board`, which must outlive the program, is the controller of that node. Precondition: there is one.
  void hand_to(int node, node::ExternalBoard& board) { world_.find(node)->hand_to(board); }

  /// Runs until `stop`. Tells on stderr when the bus fails and when it comes back, and, once a second at
  /// most, what was lost and went wrong on it.
  void run(const std::atomic<bool>& stop);

 private:
  void step();
  /// Answers requests to the world; where there are none, waits for one so long.
  void serve(std::int64_t patience_ns);
  void start_faults();
  /// Tells of each node's bus what has gone wrong there, where that is more than was told last.
  void tell_troubles();

  std::vector<std::unique_ptr<bus::Bus>> buses_;
  std::unique_ptr<bench::SocketServer> server_;
  world::World world_;
  std::vector<TimedFault> faults_;
  bool bus_failed_ = false;
  std::vector<int> nodes_;             ///< number of each bus's node
  std::vector<std::string> troubles_;  ///< told last, of each bus
};

}  // namespace pinjaw::jaw_app
