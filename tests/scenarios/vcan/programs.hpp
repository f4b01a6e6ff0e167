#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "protocol/bench/unix_socket.hpp"
#include "tests/support/process.hpp"

/// pinjaw, pinjaw-jaw and candump as processes on vcan0. Times are patience only, never asserted.
namespace pinjaw::scenario {

inline const std::string kOut = OUT_DIR;  ///< where the plans are that the tests start from

using test::Process;

/// Runs `pinjaw ARGUMENTS --bus can:vcan0` to its end and gives its exit code.
int pinjaw(std::vector<std::string> arguments, const std::string& output = {},
           const std::string& errors = {});

/// Whether a shell, as root of the machine, did it.
bool shell(const std::string& command);

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

  [[nodiscard]] const std::string& world_path() const { return path_; }
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
  std::string path_;
  Process program_;
  std::unique_ptr<bench::SocketWorld> world_;
};

/// A new folder for temporary files, short, as the path of a socket must be, and nobody else's, also where
/// process numbers repeat (User-Mode Linux).
std::string new_folder();

std::string config(const std::string& name);
std::string content(const std::string& path);

}  // namespace pinjaw::scenario
