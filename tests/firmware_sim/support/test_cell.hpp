#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "firmware_sim/world/world.hpp"
#include "protocol/bus/sim_bus.hpp"
#include "tests/firmware_sim/support/scripted_host.hpp"

namespace pinjaw::test {

/// How one station of a test cell grips the test part.
struct TestGrip {
  int node = 1;
  bool passive = false;
  double separation_mm = 30;
  double needed_n = 40;
  double limit_n = 140;            ///< of the layout
  double max_squeeze_n = 140;      ///< of the gripper
  double uncertainty_n = 12;       ///< of its force
  double keeper_n = 0;             ///< of the spring behind its catch; 0: none
  std::optional<wire::Key> key{};  ///< the controller asks for; the scripted host knows none
  bool can_fd = false;
  std::optional<wire::Layout> layout{};  ///< of a plan; nothing: one of the figures above
};

/// A passive station 3 and two grippers 1 and 2, all of them peers of each other.
std::vector<TestGrip> arm_pedestal_pallet();

/// The layout of a grip before peers are added.
wire::Layout bare_layout(const TestGrip& grip, std::uint16_t kit_id);

/// WRITE and COMMIT of a layout, as layout services.
std::vector<std::uint8_t> write_request(std::uint8_t transaction, const wire::Layout& layout);
std::vector<std::uint8_t> commit_request(std::uint8_t transaction, const wire::Layout& layout);

/// Thrown out of a script when its host has been killed.
struct HostKilled {};

/// Stations, bus, world and a scripted host in virtual time.
class TestCell {
 public:
  explicit TestCell(std::vector<TestGrip> grips, std::uint64_t seed = 1);

  /// One millisecond of everything; more of one only while nothing happens.
  void advance(int elapsed_ms = 1);
  /// Called after every advance().
  void on_step(std::function<void()> after) { after_ = std::move(after); }
  /// Off: neither log grows from now on.
  void keep_logs(bool on) { keeps_logs_ = on; }
  void run_ms(int duration_ms);
  /// Whether `condition` came true within `at_most_ms`.
  bool run_until(const std::function<bool()>& condition, int at_most_ms);
  /// From now_ms() == `at_ms` on the host says nothing and scripts end with HostKilled.
  void kill_host_at(int at_ms) { kill_at_ms_ = at_ms; }
  /// When now_ms() == `at_ms`, does `act`, whatever a script waits for.
  void at(int at_ms, std::function<void()> act) { planned_[at_ms] = std::move(act); }

  /// Boots, transfers and commits every layout; false where one is refused.
  bool commission();
  std::optional<wire::TransferStatus> send_layout(const TestGrip& grip);
  /// The answer, or a default with Busy where none came.
  wire::Acknowledge command(int node, const wire::Command& command);
  bool arm(int node);
  bool wait_for(int node, wire::State state, int at_most_ms);

  /// The part onto the passive station `on`, whose custody begins by CLOSE_LIGHT and SQUEEZE as an operator
  /// loads.
  bool load(int on);
  /// OFFER, ACCEPT, SQUEEZE, and waits until the nodes have done the rest.
  bool hand_over(int giver, int receiver);
  bool squeeze(int node);

  bench::Reply ask(const bench::Request& request) { return world_->handle(request); }
  [[nodiscard]] bench::Truth truth() const { return world_->truth(); }
  [[nodiscard]] const bench::NodeTruth& truth_of(int node);
  [[nodiscard]] wire::State state_of(int node) const;
  [[nodiscard]] int now_ms() const { return static_cast<int>(now_ms_); }
  world::World& world() { return *world_; }
  ScriptedHost& host() { return *host_; }
  bus::SimBus& bus() { return bus_; }
  /// What crossed the bus, what happened in the world.
  [[nodiscard]] const std::string& frame_log() const { return frame_log_; }
  [[nodiscard]] const std::string& event_log() const { return event_log_; }

  [[nodiscard]] wire::Layout layout_of(const TestGrip& grip) const;

 private:
  bus::SimBus bus_;
  std::vector<TestGrip> grips_;
  std::vector<std::unique_ptr<bus::Bus>> ends_;
  std::unique_ptr<bus::Bus> host_end_;
  std::unique_ptr<world::World> world_;
  std::unique_ptr<ScriptedHost> host_;
  bench::Truth last_truth_;
  std::optional<int> kill_at_ms_;
  std::map<int, std::function<void()>> planned_;
  std::int64_t now_ms_ = 0;
  bool keeps_logs_ = true;
  std::function<void()> after_;
  std::string frame_log_;
  std::string event_log_;
};

}  // namespace pinjaw::test
