#include "host/app/interrupt.hpp"

#include <unistd.h>

#include <atomic>
#include <csignal>
#include <cstdlib>
#include <string_view>

#include "host/app/exit_code.hpp"
#include "host/base/files.hpp"

namespace pinjaw::app {

namespace {

std::atomic<bool> writing = false;
std::atomic<bool> interrupted = false;
std::atomic<bool> live_line = false;
static_assert(std::atomic<bool>::is_always_lock_free);

/// Calls only what a signal handler may.
[[noreturn]] void end() {
  base::drop_unfinished_file();
  constexpr std::string_view kErased = "\r\033[K";
  if (live_line) (void)!::write(STDERR_FILENO, kErased.data(), kErased.size());
  std::_Exit(static_cast<int>(ExitCode::Interrupted));
}

void take(int /*signal*/) {
  // a second one ends even a write that hangs
  if (!writing || interrupted.exchange(true)) end();
}

}  // namespace

void end_when_interrupted() {
  for (const int number : {SIGINT, SIGTERM, SIGHUP}) {
    if (std::signal(number, take) == SIG_IGN) std::signal(number, SIG_IGN);  // as nohup wants it
  }
  std::signal(SIGXFSZ, SIG_IGN);
}

void shows_live_line(bool shown) {
  live_line = shown;
}

Uninterrupted::Uninterrupted() {
  writing = true;
}

Uninterrupted::~Uninterrupted() {
  writing = false;
  if (interrupted) end();
}

}  // namespace pinjaw::app
