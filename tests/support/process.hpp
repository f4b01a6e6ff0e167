#pragma once

#include <sys/types.h>

#include <chrono>
#include <string>
#include <vector>

namespace pinjaw::test {

/// A program of its own, killed where it outlives this.
class Process {
 public:
  /// `output`, `errors`: files for stdout and stderr; empty: this one's.
  explicit Process(std::vector<std::string> command, const std::string& output = {},
                   const std::string& errors = {});
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;
  ~Process();

  void signal(int number) const;
  /// Exit code, 128 + n where signal n ended it, -1 where it does not end within `patience`.
  int wait(std::chrono::seconds patience = std::chrono::seconds(120));

 private:
  pid_t child_;
};

/// Whether a shell, which finds what only root of the machine may do, did it.
bool shell(const std::string& command);

}  // namespace pinjaw::test
