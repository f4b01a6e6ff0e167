#include "host/app/interrupt.hpp"

#include <atomic>
#include <csignal>
#include <cstdlib>

#include "host/app/exit_code.hpp"

namespace pinjaw::app {

namespace {

std::atomic<bool> writing = false;
std::atomic<bool> interrupted = false;
static_assert(std::atomic<bool>::is_always_lock_free);

[[noreturn]] void end() {
  std::_Exit(static_cast<int>(ExitCode::Interrupted));
}

void take(int /*signal*/) {
  // a second one ends even a write that hangs
  if (!writing || interrupted.exchange(true)) end();
}

}  // namespace

void end_when_interrupted() {
  std::signal(SIGINT, take);
  std::signal(SIGTERM, take);
}

Uninterrupted::Uninterrupted() {
  writing = true;
}

Uninterrupted::~Uninterrupted() {
  writing = false;
  if (interrupted) end();
}

}  // namespace pinjaw::app
