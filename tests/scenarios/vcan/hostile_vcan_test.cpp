// Promises: E2E-VCAN, I2.
// Handoffs of pinjaw and pinjaw-jaw on real interfaces while somebody does his worst to the bus: error
// frames, garbage and replays by other programs, a babbler at a real bus's full rate, and a gateway (can-gw)
// between host and controllers that loses, changes, misaddresses and cuts frames. Only the world's truth is
// asserted, never a time and not that a run comes to its end: nobody lets go of the part, and no force passes
// its limit.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <csignal>
#include <regex>
#include <thread>

#include "tests/scenarios/vcan/programs.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/places.hpp"

namespace pinjaw::scenario {
namespace {

using std::chrono::seconds;

constexpr double kLimit_n = 140;

/// A program that disturbs, until this ends.
struct Disturbance {
  explicit Disturbance(const std::string& command)
      : process({"/bin/sh", "-c", "exec " + command}, "/dev/null") {}
  bool goes_on() { return process.wait(seconds(0)) == -1; }
  Process process;
};

/// Frames that an interface carried since it is there.
long frames_on(const std::string& interface) {
  return std::stol(content("/sys/class/net/" + interface + "/statistics/tx_packets"));
}
using Disturbances = std::vector<std::unique_ptr<Disturbance>>;

/// The handoffs begun on a host of their own, and the controllers on `interface`.
class Hostile : public testing::Test {
 protected:
  void begin(const std::string& interface = "vcan0", const std::vector<std::string>& options = {}) {
    controllers_ = std::make_unique<Controllers>(kThree, interface, options);
    host_ = std::make_unique<Process>(run_command(handoffs(), *controllers_), "/dev/null");
    ASSERT_TRUE(controllers_->comes_true(arm_touches, seconds(60))) << "the first handoff never began";
  }

  /// Lets the host play on, or give up, and ends it.
  void play_on(seconds patience = seconds(40)) {
    exit_code_ = host_->wait(patience);
    if (exit_code_ < 0) host_->signal(SIGKILL);
  }

  void expect_held_within_limit(const std::string& under) {
    const bench::Truth truth = controllers_->truth();
    expect_held(truth, under);
    double most_n = 0;
    for (const bench::NodeTruth& node : truth.nodes) {
      EXPECT_LE(node.max_steady_n, kLimit_n) << under << ", node " << node.node;
      EXPECT_LE(node.max_squeeze_n, 1.05 * kLimit_n) << under << ", node " << node.node;
      most_n = std::max(most_n, node.max_squeeze_n);
    }
    test::figure("E2E-VCAN", under + ": exit code of the run", exit_code_);
    test::figure("E2E-VCAN", under + ": most force", most_n, "N");
  }

  /// Every controller answers a host anew.
  void expect_answers() {
    for (const std::string node : {"1", "2", "3"}) {
      int code = -1;
      for (int tries = 0; tries < 10 && code != 0; ++tries)
        code = pinjaw({"jaw", "status", "--node", node}, "/dev/null");
      EXPECT_EQ(code, 0) << node;
    }
  }

  /// `disturb` acts on the bus from the first handoff on, until the host has ended.
  void endure(const std::string& under, const std::function<void(Disturbances&)>& disturb) {
    begin();
    if (HasFatalFailure()) return;
    {
      Disturbances disturbances;
      const long before = frames_on("vcan0");
      const auto began = std::chrono::steady_clock::now();
      disturb(disturbances);
      play_on();
      expect_held_within_limit(under);
      for (const auto& one : disturbances) EXPECT_TRUE(one->goes_on()) << under << " ended before the run";
      const std::chrono::duration<double> lasted = std::chrono::steady_clock::now() - began;
      const double frames_per_s = static_cast<double>(frames_on("vcan0") - before) / lasted.count();
      test::figure("E2E-VCAN", under + ": frames on the bus", std::round(frames_per_s), "1/s");
    }
    expect_answers();
    expect_held_within_limit(under + ", afterwards");
  }

  void end() {
    host_.reset();
    controllers_.reset();
  }

  std::unique_ptr<Controllers> controllers_;
  std::unique_ptr<Process> host_;
  int exit_code_ = -1;
};

std::unique_ptr<Disturbance> disturbance(const std::string& command) {
  return std::make_unique<Disturbance>(command);
}

/// Error frames of every kind that a driver makes, bus-off and restart among them.
void inject_errors() {
  for (const std::string frame :
       {"20000004#0001000000000000", "20000004#0004000000000000", "20000004#0020000000000000",
        "20000004#0010000000000000", "20000020#0000000000000000", "20000040#0000000000000000",
        "20000002#0300000000000000", "20000008#0000020000000000", "20000001#0000000000000000"}) {
    EXPECT_TRUE(shell("cansend vcan0 " + frame));
  }
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  EXPECT_TRUE(shell("cansend vcan0 20000100#0000000000000000"));
}

TEST_F(Hostile, error_frames_and_bus_off_in_a_handoff_lose_no_part) {
  endure("error frames", [](Disturbances&) {
    for (int i = 0; i < 2; ++i) inject_errors();
  });
  for (const std::string node : {"1", "2", "3"}) {
    const std::regex counted("bus of node " + node + ": .*bus-off 2, restarts 2");
    EXPECT_TRUE(std::regex_search(controllers_->said(), counted)) << node << ": " << controllers_->said();
  }
}

TEST_F(Hostile, garbage_and_old_frames_of_another_program_lose_no_part) {
  endure("garbage", [](Disturbances& disturbances) {
    disturbances.push_back(disturbance("/usr/bin/python3 " +
                                       test::source_dir("tests/scenarios/vcan/garbage.py") + " vcan0 600 1"));
  });
}

TEST_F(Hostile, a_recorded_run_played_back_into_the_next_loses_no_part) {
  const std::string heard = kOut + "/hostile.log";
  const std::string recorded = kOut + "/recorded.log";
  Candump candump(heard);
  endure("nothing", [](Disturbances&) {});
  EXPECT_EQ(exit_code_, 0);
  candump.stop();
  ASSERT_TRUE(shell("grep -v '#R' " + heard + " > " + recorded));
  end();
  endure("replay", [&recorded](Disturbances& disturbances) {
    disturbances.push_back(disturbance("canplayer -l i -I " + recorded));
  });
}

TEST_F(Hostile, a_babbler_at_full_rate_loses_no_part) {
  for (const std::string id : {"000", "065", "100"}) {
    SCOPED_TRACE(id);
    endure("babbler " + id, [&id](Disturbances& disturbances) {
      disturbances.push_back(disturbance("cangen vcan0 -g 1 -c 4 -i -I " + id + " -L 8 -D 0000000000000000"));
    });
    end();
  }
}

/// Host on vcan0, controllers on vcan1, a gateway between them by can-gw's rules.
class Gateway : public Hostile {
 protected:
  void SetUp() override { ASSERT_TRUE(open_wide()) << "can-gw's rules need root of the machine"; }
  void TearDown() override { shell("cangw -F"); }

  static bool open_wide() { return rules(""); }
  /// What passes is `filter` and `modification`, both ways.
  static bool rules(const std::string& how) {
    shell("cangw -F");
    return shell("cangw -A -s vcan0 -d vcan1 -e " + how) && shell("cangw -A -s vcan1 -d vcan0 -e " + how);
  }

  /// `unfinished`: what must get through to finish does not. A rule that does nothing fails.
  void endure_rules(const std::string& under, const std::string& how, bool unfinished = true) {
    SCOPED_TRACE(under);
    ASSERT_TRUE(open_wide());
    begin("vcan1");
    if (HasFatalFailure()) return;
    ASSERT_TRUE(rules(how)) << how;
    play_on(seconds(15));
    if (unfinished) {
      EXPECT_NE(exit_code_, 0) << under << " changed nothing";
    }
    expect_held_within_limit(under);
    ASSERT_TRUE(open_wide());
    expect_answers();
    expect_held_within_limit(under + ", afterwards");
    end();
  }
};

TEST_F(Gateway, that_lets_all_pass_lets_a_run_come_to_its_end) {
  begin("vcan1");
  play_on(seconds(60));
  EXPECT_EQ(exit_code_, 0);
  expect_held_within_limit("open gateway");
}

TEST_F(Gateway, that_loses_one_kind_of_message_loses_no_part) {
  endure_rules("no HOST_HB", "-f 0F0~7FF");
  endure_rules("no STATE", "-f 060~7F0");
  endure_rules("no CUSTODY", "-f 040~7F0", false);  // the controllers' own bus has it
  endure_rules("no ACK", "-f 140~7F0");
  endure_rules("nothing passes", "-f 7FF:7FF");
}

TEST_F(Gateway, that_changes_bits_loses_no_part) {
  endure_rules("one bit of every frame", "-m XOR:D:0.0.0000010000000000");
  endure_rules("three bits of every frame", "-m XOR:D:0.0.0100000080000002");
  endure_rules("all data ones", "-m OR:D:0.0.FFFFFFFFFFFFFFFF");
}

TEST_F(Gateway, that_misaddresses_frames_loses_no_part) {
  endure_rules("neighbour's id", "-m XOR:I:3.0.0000000000000000");
  endure_rules("another message's id", "-m XOR:I:20.0.0000000000000000");
}

TEST_F(Gateway, that_cuts_frames_loses_no_part) {
  endure_rules("7 bytes", "-m SET:L:0.7.0000000000000000");
  endure_rules("no data", "-m SET:L:0.0.0000000000000000");
}

/// Host and pallet on vcan0, the arm on vcan1, the pedestal on vcan2, and a gateway between each two: what
/// giver and receiver say to each other passes it.
class Apart : public Hostile {
 protected:
  void SetUp() override {
    shell("ip link show vcan2 >/dev/null 2>&1 || (ip link add dev vcan2 type vcan && ip link set vcan2 up)");
    ASSERT_TRUE(joined()) << "can-gw's rules need root of the machine";
  }
  void TearDown() override { shell("cangw -F"); }

  static bool join(const std::string& from, const std::string& to, const std::string& how = "") {
    return shell("cangw -A -s " + from + " -d " + to + " -e " + how);
  }
  /// Everything passes, but `how` between the arm and the pedestal.
  static bool joined(const std::string& how = "") {
    shell("cangw -F");
    bool done = join("vcan1", "vcan2", how) && join("vcan2", "vcan1", how);
    for (const std::string one : {"vcan1", "vcan2"}) done = done && join("vcan0", one) && join(one, "vcan0");
    return done;
  }

  /// `finishes`: the rule takes nothing away that a handoff needs.
  void endure_between(const std::string& under, const std::string& how, bool finishes = false) {
    SCOPED_TRACE(under);
    ASSERT_TRUE(joined());
    begin("vcan0", {"--node-bus", "1=can:vcan1", "--node-bus", "2=can:vcan2"});
    if (HasFatalFailure()) return;
    ASSERT_TRUE(joined(how)) << how;
    play_on(seconds(finishes ? 60 : 15));
    EXPECT_EQ(exit_code_ == 0, finishes);
    expect_held_within_limit(under);
    ASSERT_TRUE(joined());
    expect_answers();
    expect_held_within_limit(under + ", afterwards");
    end();
  }
};

TEST_F(Apart, giver_and_receiver_whose_words_all_pass_come_to_an_end) {
  endure_between("between peers: all passes", "", true);
}

TEST_F(Apart, giver_and_receiver_who_do_not_hear_all_of_each_other_lose_no_part) {
  endure_between("between peers: no CUSTODY", "-f 040~7F0");
  endure_between("between peers: no STATE", "-f 060~7F0");
  endure_between("between peers: nothing", "-f 7FF:7FF");
}

TEST_F(Apart, giver_and_receiver_whose_words_are_changed_lose_no_part) {
  endure_between("between peers: one bit", "-m XOR:D:0.0.0000010000000000");
  endure_between("between peers: neighbour's id", "-m XOR:I:3.0.0000000000000000");
}

}  // namespace
}  // namespace pinjaw::scenario
