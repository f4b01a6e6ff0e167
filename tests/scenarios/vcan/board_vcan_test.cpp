// Promises: T-BOARD.
// The firmware's image on an emulated board with an SJA1000, on a real vcan: it is the pedestal of a cell
// whose other stations pinjaw-jaw simulates, and the jaws of all. pinjaw plays handoffs with it and candump
// listens.
//
// An emulator, the simulated cell and their host do not fit into the one processor of User-Mode Linux in real
// time: every program's clock runs at a sixteenth of its speed.
#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "tests/scenarios/vcan/programs.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/places.hpp"

namespace pinjaw::scenario {
namespace {

constexpr int kBoard = 2;
// The library without its program, which would stand between us and what we stop. ld.so knows $LIB.
const std::vector<std::string> kSlowly = {"env", "LD_PRELOAD=/usr/$LIB/faketime/libfaketimeMT.so.1",
                                          "FAKETIME=+0 x0.0625"};
constexpr std::chrono::seconds kLong(600);

/// Throws where ld.so would only say that it goes without.
std::vector<std::string> slowly(const std::vector<std::string>& command) {
  if (!shell("ls /usr/lib*/*/faketime/libfaketimeMT.so.1 >/dev/null"))
    throw std::runtime_error("libfaketime is not installed");
  std::vector<std::string> whole = kSlowly;
  whole.insert(whole.end(), command.begin(), command.end());
  return whole;
}

/// The emulator with the board's image on vcan0, its serial line a socket.
class Board {
 public:
  Board() : emulator_(slowly(command()), folder_.path("said"), folder_.path("said")) {
    for (int tries = 0; tries < 1000 && !std::filesystem::exists(line()); ++tries)
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }

  [[nodiscard]] std::string line() const { return folder_.path("line"); }
  [[nodiscard]] std::string said() const { return content(folder_.path("said")); }
  void lose_power() { emulator_.signal(SIGKILL); }

 private:
  [[nodiscard]] std::vector<std::string> command() const {
    const std::string line_socket = "socket,id=line,path=" + line() + ",server=on,wait=off";
    return {"qemu-system-arm",
            "-M",
            "virt,highmem=off",
            "-cpu",
            "cortex-a15",
            "-m",
            "64M",
            "-kernel",
            test::program("../firmware/bin/board-virt.elf"),
            "-display",
            "none",
            "-monitor",
            "none",
            "-nic",
            "none",
            "-chardev",
            line_socket,
            "-serial",
            "chardev:line",
            "-object",
            "can-bus,id=bus0",
            "-object",
            "can-host-socketcan,id=host0,if=vcan0,canbus=bus0",
            "-device",
            "kvaser_pci,canbus=bus0"};
  }

  test::Folder folder_;
  Process emulator_;
};

/// The cell: a board for the pedestal, pinjaw-jaw for all else.
struct Cell {
  Board board;
  Controllers controllers{kThree, "vcan0", {"--board", std::to_string(kBoard) + "=" + board.line()}, kSlowly};
};

/// States that the board reported in a step.
std::set<std::string> board_states(const nlohmann::json& step) {
  std::set<std::string> states;
  for (const auto& change : step.at("states")) {
    if (change.at("node") == kBoard) states.insert(change.at("state").get<std::string>());
  }
  return states;
}

/// Frames with this 11-bit id, as candump -L writes them.
int frames_in(const std::string& log, const std::string& id) {
  int count = 0;
  for (std::size_t at = log.find(" " + id + "#"); at != std::string::npos;
       at = log.find(" " + id + "#", at + 1))
    ++count;
  return count;
}

TEST(BoardOnVcan, is_the_pedestal_of_handoffs_there_and_back) {
  Cell cell;
  Candump candump(kOut + "/board.log");
  const std::string report_file = kOut + "/board.json";
  EXPECT_EQ(Process(slowly(run_command(handoffs(), cell.controllers, report_file))).wait(kLong), 0)
      << cell.board.said();
  candump.stop();

  const nlohmann::json report = finished_report(report_file, 6);
  ASSERT_FALSE(report.is_null());
  std::set<std::string> states;
  int handoffs_of_board = 0;
  for (const auto& step : report.at("steps")) {
    std::set<std::string> in_step = board_states(step);
    if (in_step.contains("TAKEN") || in_step.contains("RELAX")) ++handoffs_of_board;  // took, or gave
    states.merge(in_step);
  }
  EXPECT_EQ(handoffs_of_board, 2);
  for (const char* state : {"SEATING", "SQUEEZING", "TAKEN", "HOLD", "OFFERED", "RELAX", "OPENING", "READY"})
    EXPECT_TRUE(states.contains(state)) << state;
  const double squeeze_n = report.at("plant").at("max_squeeze_n").at(std::to_string(kBoard));
  EXPECT_GT(squeeze_n, 10);
  EXPECT_LE(squeeze_n, 1.05 * 140);
  const std::string log = content(kOut + "/board.log");
  const int board_frames = frames_in(log, "042");
  EXPECT_GT(board_frames, 100) << "custody facts of the board, heard by somebody else";
  test::figure("T-BOARD", "handoffs with the board as pedestal", handoffs_of_board);
  test::figure("T-BOARD", "its squeeze at most", squeeze_n, "N");
  test::figure("T-BOARD", "its custody facts that candump heard", board_frames);
}

TEST(BoardOnVcan, that_loses_power_while_it_holds_alone_keeps_its_part) {
  Cell cell;
  Process host(slowly(run_command(handoffs(), cell.controllers, kOut + "/board-never.json")));
  const auto board_alone = [](const bench::Truth& truth) { return truth.holders == std::vector{kBoard}; };
  ASSERT_TRUE(cell.controllers.comes_true(board_alone, kLong)) << cell.board.said();
  host.signal(SIGKILL);
  cell.board.lose_power();
  const double squeeze_n = cell.controllers.truth().nodes.at(1).squeeze_n;
  const double from_s = cell.controllers.truth().time_s;
  ASSERT_TRUE(cell.controllers.comes_true(
      [from_s](const bench::Truth& truth) { return truth.time_s > from_s + 3; }, kLong));

  const bench::Truth truth = cell.controllers.truth();
  EXPECT_EQ(truth.holders, std::vector{kBoard});
  EXPECT_FALSE(truth.dropped);
  EXPECT_EQ(truth.slip_mm, 0);
  EXPECT_GT(truth.nodes.at(1).squeeze_n, 0.9 * squeeze_n) << "behind its check valve";
}

}  // namespace
}  // namespace pinjaw::scenario
