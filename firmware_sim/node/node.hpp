#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "firmware_sim/core/core.hpp"
#include "firmware_sim/node/fault_spec.hpp"
#include "firmware_sim/node/figures.hpp"
#include "firmware_sim/node/nvm.hpp"
#include "firmware_sim/plant/plant.hpp"
#include "protocol/bus/bus.hpp"

namespace pinjaw::node {

/// What is around one station in one millisecond; the world says it.
struct Surroundings {
  plant::Contact contact;      ///< of an active station
  bool seats_pressed = false;  ///< of a passive one: the part rests on all its switches
  bool local_enable = false;
  bool neighbour_moves = false;  ///< the common supply droops
};

/// The truth of one station after a step. A passive one has no jaws.
struct Truth {
  double separation_mm = 0;
  double left_n = 0;
  double right_n = 0;
  double squeeze_n = 0;
  double least_n = 0;  ///< squeeze within the last step
  double most_n = 0;   ///< the same
};

/// A controller outside this process that is wired to a node's sensors and valves and has a bus end of its
/// own.
class ExternalBoard {
 public:
  ExternalBoard() = default;
  ExternalBoard(const ExternalBoard&) = delete;
  ExternalBoard& operator=(const ExternalBoard&) = delete;
  virtual ~ExternalBoard() = default;

  /// Shows it what the sensors read now; gives what it last told the valves.
  virtual core::Valves exchange(const core::Sensors& sensors) = 0;
};

/// One simulated controller: firmware, pneumatics, permanent memory, one end of a bus. Its caller steps it
/// each millisecond of whatever time it keeps.
class Node {
 public:
  /// Jaws fully open, powered, the memory never written. `bus` must outlive the node.
  Node(const Figures& figures, std::uint64_t seed, bus::Bus& bus);

  /// Takes the frames that came, steps the firmware once, sends, and runs the plant for `elapsed_ms`. A
  /// failure of the bus is handed back after all else was done: pneumatics do not wait for a bus. More than 1
  /// ms is for nodes at which nothing happens: the firmware sees only the end of the step.
  bus::Expected<void> step(const Surroundings& surroundings, unsigned elapsed_ms = 1);

  /// Off: the valves fall to rest and the firmware forgets what is not in its memory. On: it starts.
  void set_power(bool on);
  void apply(const Fault& fault);
  /// From now on `board`, which must outlive the node, decides in place of the node's own firmware.
  void hand_to(ExternalBoard& board) { board_ = &board; }

  [[nodiscard]] int number() const { return figures_.node; }
  [[nodiscard]] const Figures& figures() const { return figures_; }
  [[nodiscard]] bool powered() const { return powered_; }
  [[nodiscard]] const Truth& truth() const { return truth_; }
  /// The jaws move under air: others on the same supply feel it.
  [[nodiscard]] bool moves() const;
  /// For logs and tests; no run may decide by it.
  [[nodiscard]] const core::State& firmware() const { return firmware_; }
  [[nodiscard]] const core::Valves& told_valves() const { return valves_; }
  [[nodiscard]] const plant::State& plant_state() const { return plant_; }
  [[nodiscard]] const Nvm& memory() const { return memory_; }

  /// For tests only: what the firmware believes of its hardware, to switch a guard off.
  core::Config& config_for_tests() { return config_; }
  /// Whether the plant takes 1 ms in one step while it is at rest, which saves fifty; off: never.
  void let_coast(bool on) { coasts_ = on; }
  /// For tests only: what the firmware knows, to start its counters near their ends.
  core::State& firmware_for_tests() { return firmware_; }
  /// For tests only: the hardware, before the first step.
  plant::Parameters& plant_for_tests() { return parameters_; }
  /// For tests only: its state, before the first step.
  plant::State& plant_state_for_tests() { return plant_; }

 private:
  bus::Expected<void> take_frames();
  [[nodiscard]] core::Sensors read_sensors(const Surroundings& surroundings);
  bus::Expected<void> run_firmware(const Surroundings& surroundings, unsigned elapsed_ms);
  void mind_watchdog(unsigned elapsed_ms);
  void run_plant(const Surroundings& surroundings, unsigned elapsed_ms);
  void run_plant_for_1_ms(const plant::Inputs& inputs);

  Figures figures_;
  core::Config config_;
  plant::Parameters parameters_;
  bus::Bus* bus_;
  ExternalBoard* board_ = nullptr;
  bool powered_ = true;
  bool hangs_ = false;      ///< the processor does nothing: the valves stay as they were told
  unsigned silent_ms_ = 0;  ///< since it last served its watchdog
  bool coasts_ = true;
  Nvm memory_;  // before the firmware, which reads it
  core::State firmware_;
  core::Valves valves_;
  plant::State plant_;
  plant::Faults faults_;
  std::vector<wire::Frame> received_;
  Truth truth_;
};

}  // namespace pinjaw::node
