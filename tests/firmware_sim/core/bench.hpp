#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "firmware_sim/core/core.hpp"
#include "protocol/wire/codec.hpp"
#include "protocol/wire/commands.hpp"
#include "protocol/wire/layout.hpp"
#include "protocol/wire/secured_link.hpp"
#include "protocol/wire/session.hpp"
#include "tests/firmware_sim/core/toy_jaw.hpp"

/// Cores, toy jaws, a toy bus and a host, for tests.
namespace pinjaw::core::test {

constexpr std::uint8_t kArm = 1;
constexpr std::uint8_t kPedestal = 2;
constexpr std::uint8_t kPallet = 3;

/// F_req 40 N, F_limit 140 N, contact at 30 mm; every station names the other two.
wire::Layout layout_for(std::uint8_t node, std::uint16_t f_required_dn = 400);

/// A controller with its jaw and memory.
struct Station {
  explicit Station(std::uint8_t node);

  Config config;
  NvmImage memory;
  NvmStatus stored;
  ToyJaw jaw;
  State core;
  Outputs outputs;
  bool powered = true;
  bool memory_fails = false;
  BusHealth bus;  ///< while off, nothing comes or goes

  [[nodiscard]] StateId id() const { return core.id; }
  void power_off();
  void power_on_again();
  /// One millisecond.
  void step(const std::vector<wire::Frame>& frames);
};

/// Three stations, a host and the bus between them.
class Bench {
 public:
  Bench();

  Station& at(std::uint8_t node) { return stations_[node - 1]; }
  Station& arm() { return at(kArm); }
  Station& pedestal() { return at(kPedestal); }
  Station& pallet() { return at(kPallet); }

  /// Lets time pass.
  void run(int ms);
  /// Lets time pass until `condition`; false where it took longer than `most_ms`.
  bool run_until(int most_ms, const std::function<bool()>& condition);
  bool reaches(std::uint8_t node, StateId state, int most_ms = 4000);

  /// Gives a frame to all stations with the next step.
  void inject(const wire::Frame& frame) { injected_.push_back(frame); }

  /// Sends a command, repeating it like a host, until it is answered; nothing where it never is.
  std::optional<wire::Acknowledge> command(std::uint8_t node, wire::Command command);
  /// `command` with the MAC that `node` asks for now, where the stations have a key.
  wire::Command sealed_for(std::uint8_t node, const wire::Command& command);
  /// ARM with the station's layout.
  std::optional<wire::Acknowledge> arm_session(std::uint8_t node);
  wire::CommandResult result_of(std::uint8_t node, const wire::Command& wanted);

  /// Commits its layout at a station as if it had been stored before, and restarts it.
  void load(std::uint8_t node, const wire::Layout& layout);
  void load_all();

  /// All stations are given `key` and started again; commands are sealed with it from now on. With `can_fd`
  /// every frame is.
  void share_key(const wire::Key& key, bool can_fd = false);
  /// `frame` as the host says it.
  wire::Frame from_host(const wire::Frame& frame) {
    return host_link_ ? host_link_->seal(*key_, frame) : frame;
  }

  /// The part lies on the pallet and the pallet answers for it: HOLD.
  void load_pallet();
  /// A part in `node`'s jaws, held: READY, CLOSE_LIGHT, SQUEEZE, HOLD.
  void load_gripper(std::uint8_t node);
  /// From HOLD at `giver` to HOLD at `receiver`; false where it does not end so.
  bool hand_over(std::uint8_t giver, std::uint8_t receiver);
  /// Its first half: OFFER at `giver`, ACCEPT at `receiver`, which gets SEATED.
  bool seat(std::uint8_t giver, std::uint8_t receiver);
  /// SQUEEZE at a seated `receiver`, which begins to take the part.
  bool squeeze(std::uint8_t receiver);
  /// The part comes between the jaws of `node` (or onto its seats), or leaves.
  void bring_part(std::uint8_t node, bool there);

  bool host_alive = true;
  std::uint16_t host_permit = 0x3FFF;
  std::uint16_t epoch = 77;
  int loss_percent = 0;
  bool duplicates = false;    ///< as many frames come twice as are lost
  int duplicate_percent = 0;  ///< besides
  int late_percent = 0;       ///< come up to 30 ms late, after others
  /// Called with what a station is about to hear, which it may change.
  std::function<void(std::uint8_t to, std::vector<wire::Frame>& frames)> on_delivery;
  /// Called after each millisecond.
  std::function<void()> after_step;
  std::vector<wire::Frame> heard;          ///< what stations said in the last step
  std::vector<wire::Frame> heard_by_host;  ///< the same, opened
  int now_ms = 0;

 private:
  void beat(std::vector<wire::Frame>& frames);
  bool chance(int percent);
  bool lost() { return chance(loss_percent); }
  /// What of `frames` gets to `to`; its own do not come back.
  std::vector<wire::Frame> delivered(const std::vector<wire::Frame>& frames, std::uint8_t to);
  struct Late {
    wire::Frame frame;
    std::uint8_t to = 0;
    int due_ms = 0;
  };
  /// Takes out what comes later, adds what is due.
  void reorder(std::vector<wire::Frame>& frames, std::uint8_t to);
  std::uint32_t random();
  std::vector<Late> late_;
  std::vector<Station> stations_;
  std::vector<wire::Frame> injected_;
  std::array<wire::SequenceIssuer, 16> sequence_{};
  std::array<std::uint16_t, 16> session_{};
  std::optional<wire::Key> key_;
  std::optional<wire::SecuredLink<wire::kLastNode>> host_link_;
  std::uint8_t beat_counter_ = 0;
  std::uint8_t arm_sequence_ = 0;
  std::uint32_t random_ = 12345;
};

}  // namespace pinjaw::core::test
