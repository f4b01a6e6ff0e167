#pragma once

#include <string>
#include <vector>

namespace pinjaw::bench {

/// What the operating system says of one finished run of a program and its children.
struct CommandCost {
  int exit_code = -1;
  double cpu_s = 0;
  double peak_mb = 0;  ///< largest resident set of the program or one of its children, 10^6 bytes
};

/// Runs `command` (program first), its output thrown away, and waits for it.
CommandCost cost_of(const std::vector<std::string>& command);

}  // namespace pinjaw::bench
