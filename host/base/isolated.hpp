#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

#include "host/base/expected.hpp"

/// Work that may crash, hang or eat memory, in a process of its own.
namespace pinjaw::base {

/// What isolated work may use. What the process already holds does not count.
struct IsolationLimits {
  double seconds = 120;
  std::uint64_t memory_mb =
      2048;  ///< of address space, in 2^20 bytes; not enforced under the address sanitizer
};

/// What isolated work is doing now, as it follows "while", e.g. "reading its edges": told where it fails.
using IsolatedStage = std::function<void(std::string_view doing)>;

/// Bytes, or why the work itself has none.
using IsolatedWork = std::function<Expected<std::string>(const IsolatedStage&)>;

/// Why isolated work gave nothing.
struct Misfortune {
  enum class Kind {
    Refused,  ///< the work ran and says so itself
    Crashed,  ///< ended by a signal or early
    Memory,   ///< needs more than it may have
    Time,     ///< takes longer than it may
    Garbled,  ///< what it gave is damaged
    NotStarted
  };
  Kind kind = Kind::Refused;
  std::string message;  ///< e.g. "crashed (SIGSEGV) while reading its edges"; of Refused the work's own
};

/// Runs `work` in a forked child and gives the bytes that it gives.
///
/// The child ends with its caller, also where that is killed; it prints nothing, dumps no core and takes an
/// interrupt as everyone. Only the calling thread lives on in it: `work` may use memory, files, and libraries
/// that no other thread of this process uses; no threads, and no locks that others may hold.
Expected<std::string, Misfortune> run_isolated(const IsolationLimits& limits, const IsolatedWork& work);

}  // namespace pinjaw::base
