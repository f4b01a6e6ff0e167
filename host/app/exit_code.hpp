#pragma once

namespace pinjaw::app {

/// What the shell learns; users script against these.
enum class ExitCode : int {
  Done = 0,
  No = 1,  ///< ran, and the answer is no: no design, check failed, sequence aborted
  Usage = 2,
  BadFile = 3,
  Refused = 4,      ///< a controller refused, or has a fault
  Unavailable = 5,  ///< bus or node unavailable, or a timeout
  ForceLimit = 6,   ///< refused because force would exceed a limit
  Bug = 70,
  Interrupted = 130,
};

}  // namespace pinjaw::app
