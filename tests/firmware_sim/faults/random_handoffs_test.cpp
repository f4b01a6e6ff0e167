// Promises: I2, I2c, HANDOFFS.
//
// Handoffs in random directions over a bus that loses a fifth of all frames, doubles some and lets some be
// overtaken; now and then the host falls silent or gives up in the middle. The oracle looks at the jaws,
// never at what anyone says.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>

#include "protocol/wire/names.hpp"
#include "tests/firmware_sim/core/bench.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/nightly.hpp"

namespace pinjaw::core::test {
namespace {

constexpr std::int32_t kNeeded_dn = 400;  // F_req of every layout
constexpr int kTries = 100;               // chosen: on such a bus most attempts find somebody stale
constexpr wire::SqueezeForces kForces{520, 1400};

/// A part that goes from jaw to jaw.
class Relay {
 public:
  explicit Relay(std::uint64_t seed, bool can_fd = false) : engine_(seed) {
    constexpr wire::Key kKey{3, 1, 4, 1, 5, 9, 2, 6, 5, 3, 5, 8, 9, 7, 9, 3};
    if (can_fd) bench_.share_key(kKey, true);
    bench_.load_all();
    if (can_fd) bench_.run(700);  // until all know each other
    bench_.load_gripper(kArm);
    bench_.loss_percent = 20;
    bench_.duplicate_percent = 2;
    bench_.late_percent = 2;
    bench_.after_step = [this] { look(); };
  }

  /// One handoff to a random other station; false where it comes to no end.
  bool hand_over() {
    const std::uint8_t to = other_than(holder_);
    for (int i = 0; i < kTries; ++i) {
      if (attempt(to)) {
        bench_.bring_part(holder_, false);
        holder_ = to;
        return true;
      }
      ++failed_attempts_;
    }
    return false;
  }

  [[nodiscard]] bool dropped() const { return dropped_; }
  Bench& bench() { return bench_; }
  [[nodiscard]] int failed_attempts() const { return failed_attempts_; }
  [[nodiscard]] double time_s() const { return bench_.now_ms * 1e-3; }

  std::string told() {
    std::string text =
        std::string("from ") + std::to_string(holder_) + " at " + std::to_string(bench_.now_ms) + " ms:";
    for (const std::uint8_t node : {kArm, kPedestal, kPallet}) {
      text += std::string(" ") + wire::to_string(bench_.at(node).id()) + " " +
              std::to_string(bench_.at(node).jaw.squeeze_dn());
    }
    return text;
  }

 private:
  bool one_in(int count) { return engine_() % static_cast<unsigned>(count) == 0; }

  std::uint8_t other_than(std::uint8_t node) {
    const auto step = static_cast<std::uint8_t>(1 + engine_() % 2);
    return static_cast<std::uint8_t>((node - 1 + step) % 3 + 1);
  }

  /// The truth: somebody holds the part with what it needs, or it lies on its seats.
  void look() {
    const bool lies = bench_.pallet().jaw.part_on_seats;
    const bool held = std::ranges::any_of(std::array{kArm, kPedestal}, [this](std::uint8_t node) {
      return bench_.at(node).jaw.squeeze_dn() >= kNeeded_dn;
    });
    if (!lies && !held) dropped_ = true;
  }

  bool arm(std::uint8_t node) {
    if (bench_.at(node).core.gate.armed() && bench_.at(node).id() != StateId::Loaded) return true;
    const auto answer = bench_.arm_session(node);
    return answer && answer->result == wire::CommandResult::Ok;
  }

  /// A refused session is opened anew, as a host does: an ARM that comes late, after others, ends the one it
  /// opened.
  bool ask(std::uint8_t node, const wire::Command& command) {
    const wire::CommandResult result = bench_.result_of(node, command);
    if (result == wire::CommandResult::BadSession) bench_.arm_session(node);
    return result == wire::CommandResult::Ok;
  }

  /// The receiver holds alone. The giver may have lost its host meanwhile.
  bool over(std::uint8_t to) {
    return bench_.at(to).id() == StateId::Hold && is_free(bench_.at(holder_).id());
  }

  static bool is_free(StateId state) { return state == StateId::Ready || state == StateId::Loaded; }

  /// The host falls silent for a while, or gives up: at a random moment of every tenth handoff.
  void trouble() {
    if (!one_in(40)) return;
    if (one_in(2)) {
      bench_.host_alive = false;
      bench_.run(static_cast<int>(engine_() % 600));
      bench_.host_alive = true;
      bench_.run(250);
    } else {
      ask(holder_, wire::plain_command(wire::Op::Abort));
    }
  }

  /// As a host does it, from wherever the last attempt ended.
  bool attempt(std::uint8_t to) {
    const std::uint8_t from = holder_;
    if (!settle(from, to) || over(to)) return over(to);
    bench_.bring_part(to, true);
    if (!arm(from) || !arm(to) || !ask(from, wire::offer_command(to))) return false;
    bench_.run(60);
    trouble();
    if (!ask(to, wire::accept_command(from))) return false;
    trouble();
    if (!bench_.reaches(to, StateId::Seated, 3000)) return false;
    trouble();
    const auto forces = to == kPallet ? wire::SqueezeForces{0, 0} : kForces;
    if (!ask(to, wire::squeeze_command(forces))) return false;
    trouble();
    return bench_.run_until(4000, [&] { return over(to); });
  }

  /// Both are where a handoff begins, or it turns out to be over.
  bool settle(std::uint8_t from, std::uint8_t to) {
    for (int i = 0; i < 20; ++i) {
      const StateId giver = bench_.at(from).id();
      const StateId receiver = bench_.at(to).id();
      if (over(to) || (giver == StateId::Hold && is_free(receiver) && open(to))) return true;
      if (giver == StateId::Offered) ask(from, wire::plain_command(wire::Op::Abort));
      give_up(to);
      bench_.run(300);
    }
    return false;
  }

  bool open(std::uint8_t node) { return bench_.at(node).config.passive || !bench_.at(node).jaw.touches(); }

  void give_up(std::uint8_t node) {
    switch (bench_.at(node).id()) {
      case StateId::Loaded:  // its host was lost before its jaws were open
      case StateId::Ready:
      case StateId::Seating:
      case StateId::Seated:
      case StateId::FaultEmpty:
        arm(node);
        ask(node, wire::plain_command(wire::Op::Abort));
        return;
      default:
        return;
    }
  }

  std::mt19937_64 engine_;
  Bench bench_;
  std::uint8_t holder_ = kArm;
  bool dropped_ = false;
  int failed_attempts_ = 0;
};

TEST(Relay, sees_a_part_that_a_jaw_lets_go) {
  Relay relay(1);
  relay.bench().run(100);
  EXPECT_FALSE(relay.dropped());
  relay.bench().arm().jaw.close_mbar = 1000;
  relay.bench().run(1);
  EXPECT_TRUE(relay.dropped());
}

constexpr int kPlain = 10;
constexpr int kSealed = 2;  // of whom twice as much CPU is used

/// By seed; the last ones on CAN FD under a key.
class RandomHandoffs : public testing::TestWithParam<int> {
 protected:
  static bool is_sealed() { return GetParam() >= kPlain; }
};

TEST_P(RandomHandoffs, drop_no_part_and_come_to_an_end) {
  const int handoffs = pinjaw::test::by_night(10'000, 50);
  Relay relay(static_cast<std::uint64_t>(GetParam()), is_sealed());
  for (int i = 0; i < handoffs; ++i) {
    ASSERT_TRUE(relay.hand_over()) << "stuck in handoff " << i << ", " << relay.told();
    ASSERT_FALSE(relay.dropped()) << "dropped in handoff " << i << ", " << relay.told();
  }
  const char* what = is_sealed() ? "random handoffs on CAN FD under a key, 20 % loss; none dropped or stuck"
                                 : "random handoffs, 20 % loss, doubled, overtaken; none dropped or stuck";
  pinjaw::test::figure("HANDOFFS", what, handoffs, "handoffs");
  std::printf("%d attempts came to nothing, %.0f s of virtual time\n", relay.failed_attempts(),
              relay.time_s());
}

INSTANTIATE_TEST_SUITE_P(Seeds, RandomHandoffs, testing::Range(0, kPlain + kSealed));

}  // namespace
}  // namespace pinjaw::core::test
