#pragma once

#include <cstdint>
#include <set>
#include <string>

#include "protocol/wire/messages.hpp"

/// A handoff from node 1 to node 2 in which a fault of the hardware strikes.
namespace pinjaw::test {

/// Of a gripper and its force's uncertainty.
struct Size {
  double max_squeeze_n = 140;
  double uncertainty_n = 12;
};

/// Where the fault strikes: a node in a state of the handoff.
struct Moment {
  int node = 1;
  wire::State state = wire::State::Hold;
  int after_ms = 5;  ///< in that state
};

/// What is seen of one run.
struct Outcome {
  bool struck = false;
  double peak_n = 0;
  bool dropped = false;
  int min_holders = 0;
  int known_after_ms = -1;    ///< the controller has raised a sensor's fault
  int unguarded_ms = 0;       ///< longest that sensor B was over the limit and the guard had not cut
  int unshut_ms = 0;          ///< longest that the true main valve still fed the close side after a decision
  bool told_to_feed = false;  ///< a decision did not reach what the main valve is told
  std::set<int> faults;       ///< that the struck node raised
};

/// The grippers, and how the receiver comes to its part.
struct Cell {
  Size size{};
  double separation_mm = 36;
  bool opened_before = false;  ///< it gave a part away just now: air is left on its open side
  bool soft_start = true;
  double keeper_n = 0;         ///< of the spring behind its catch; 0: none
  std::uint64_t specimen = 0;  ///< seed of drawn plants; 0: the study's figures
};

/// To RESQUEEZE leads an ABORT in RELAX.
Outcome strike(const Moment& moment, const std::string& fault, const Cell& given = {});

}  // namespace pinjaw::test
