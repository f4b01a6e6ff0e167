#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "tests/firmware_sim/model_check/local.hpp"
#include "tests/firmware_sim/model_check/network.hpp"
#include "tests/firmware_sim/model_check/stimulus.hpp"

/// One node as an automaton over its packed states, worked out by the compiled core as far as it is asked
/// for. Nodes share nothing but the network, so that the search over all of them looks each step() up, once
/// done.
namespace pinjaw::core::model {

using LocalId = std::uint32_t;

/// What one node does wrong by itself, whatever the others do.
enum class Fault : std::uint8_t { None, OpensUndecided, TakesUnlatched };

struct Move {
  LocalId next = 0;
  Said said = 0;
  Stimulus stimulus;
  Fault fault = Fault::None;
};

/// What the invariants ask of a node in a state.
struct Traits {
  struct Record {
    Custody custody = Custody::Empty;
    std::uint8_t peer = 0;
    std::uint16_t token = 0;
    std::array<Outcome, 4> outcomes{};
  };
  bool grips = false;          ///< its jaws hold the part with F_req
  bool holds = false;          ///< grips and answers for it
  bool rests_holding = false;  ///< quiescent, with the part
  bool rests_empty = false;    ///< quiescent, without it
  Record stored;               ///< what a power cut leaves
  Record wanted;               ///< what the core believes
};

struct NodeSetup {
  std::uint8_t node = kArm;
  std::vector<std::uint8_t> nodes;  ///< all of the cell
  std::uint16_t tokens = 1;         ///< offers that this node may make
  bool release_guard = true;
  std::uint8_t misfit = 0;  ///< node with a layout of another part
  const StateTable* table = &kStateTable;
};

class NodeModel {
 public:
  NodeModel(NodeSetup setup, Network& network);

  /// After power on with a committed layout, armed: READY, jaws open.
  LocalId ready();
  /// Loaded by the operator: HOLD, sole.
  LocalId loaded();

  /// All that changes something, when the custody frame `message` (-1: none) comes in the same step, with or
  /// without its sender's STATE.
  const std::vector<Move>& moves(LocalId id, int message, bool peer_holds);

  [[nodiscard]] const Traits& traits(LocalId id) const { return traits_[id]; }
  /// What the node may say as often as it likes without change to itself.
  Said chatter(LocalId id);
  /// What the node repeats by itself in this state.
  Said repeats(LocalId id);
  [[nodiscard]] std::string describe(LocalId id) const;
  [[nodiscard]] std::size_t states() const { return packed_.size(); }
  [[nodiscard]] std::uint64_t steps() const { return steps_; }
  [[nodiscard]] std::uint8_t node() const { return setup_.node; }

  /// What `stimulus` makes of `local`; its frames and its own mistakes.
  struct Effect {
    Said said = 0;
    Fault fault = Fault::None;
  };
  Effect apply(Local& local, const Stimulus& stimulus);
  [[nodiscard]] Local local(LocalId id) const;
  LocalId intern(Local& local);

 private:
  std::vector<wire::Frame> frames(const Stimulus& stimulus) const;
  Effect step(Local& local, const Stimulus& stimulus);
  void restart(Local& local, unsigned stored) const;
  std::vector<Move> work_out(LocalId id, int message, bool peer_holds);
  Said listen(const SendQueue& queue);
  Traits traits_of(const Local& local) const;
  void run(Local& local, Stimulus stimulus);

  NodeSetup setup_;
  Network& network_;
  Config config_;
  LayoutBlob layout_;
  Local base_;  ///< what packing leaves out
  HostLink lost_host_;
  std::array<Measurement, 3> measured_{};  ///< at each grip
  std::vector<Stimulus> demands_;
  std::unordered_map<Packed, LocalId> ids_;
  std::vector<const Packed*> packed_;
  std::vector<Traits> traits_;
  std::vector<std::optional<Said>> chatter_;
  std::vector<std::optional<Said>> repeats_;
  std::unordered_map<std::uint64_t, std::vector<Move>> moves_;
  std::uint64_t steps_ = 0;
};

}  // namespace pinjaw::core::model
