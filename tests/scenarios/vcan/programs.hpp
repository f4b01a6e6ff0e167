#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "protocol/bench/unix_socket.hpp"
#include "tests/support/folder.hpp"
#include "tests/support/process.hpp"

/// pinjaw, pinjaw-jaw and candump as processes on vcan0. Times are patience only, never asserted.
namespace pinjaw::scenario {

inline const std::string kOut = OUT_DIR;  ///< where the plans are that the tests start from

/// The controllers of the cell.
inline const std::vector<std::string> kThree = {"arm", "pedestal", "pallet"};

using test::Process;
using test::shell;

/// Runs `pinjaw ARGUMENTS --bus can:vcan0` to its end and gives its exit code.
int pinjaw(std::vector<std::string> arguments, const std::string& output = {},
           const std::string& errors = {});

/// candump -L of vcan0 into a file, until it is stopped.
class Candump {
 public:
  explicit Candump(const std::string& file);
  void stop();

 private:
  Process program_;
};

/// pinjaw-jaw with controllers on an interface, and its world.
class Controllers {
 public:
  /// `names`: files of configs/controllers, such as "arm", or paths. `options`: more of pinjaw-jaw's.
  /// `under`: a program and its arguments that starts pinjaw-jaw.
  explicit Controllers(const std::vector<std::string>& names, const std::string& interface = "vcan0",
                       const std::vector<std::string>& options = {}, std::vector<std::string> under = {});
  Controllers(const Controllers&) = delete;
  Controllers& operator=(const Controllers&) = delete;
  ~Controllers();

  [[nodiscard]] std::string world_path() const { return folder_.path("world"); }
  /// What pinjaw-jaw told on stderr so far.
  [[nodiscard]] std::string said() const;
  /// Whether it comes to tell that. It does once a second.
  bool tells(const std::string& text, std::chrono::seconds patience = std::chrono::seconds(20)) const;
  /// Throws where the world does not do it.
  bench::Reply ask(const bench::Request& request);
  bench::Truth truth() { return std::get<bench::Truth>(ask(bench::AskTruth{})); }
  /// Whether `condition` comes to hold of the truth.
  bool comes_true(const std::function<bool(const bench::Truth&)>& condition,
                  std::chrono::seconds patience = std::chrono::seconds(30));

 private:
  test::Folder folder_;
  Process program_;
  std::unique_ptr<bench::SocketWorld> world_;
};

/// The command that plays a sequence with the cell's plan on vcan0. `report`: the file for its report, if
/// any.
std::vector<std::string> run_command(const std::string& sequence, const Controllers& controllers,
                                     const std::string& report = {});
/// handoffs.yaml beside this.
std::string handoffs();
/// The report of a run that must have come to its end in so many steps, the part held all the time; null
/// where there is none.
nlohmann::json finished_report(const std::string& file, std::size_t steps);

bool arm_touches(const bench::Truth& truth);
/// Somebody holds the part, and somebody always has, without a slip. `when`: said where that fails.
void expect_held(const bench::Truth& truth, const std::string& when = {});

std::string config(const std::string& name);
std::string content(const std::string& path);

}  // namespace pinjaw::scenario
