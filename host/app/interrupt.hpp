#pragma once

namespace pinjaw::app {

/// From now on SIGINT, SIGTERM and SIGHUP end the program with exit code 130: at once, or where an output
/// file is being written as soon as that is whole. A second one ends it at once in any case; then the
/// unfinished file is gone. Too large a file is an error of its writing and no signal.
void end_when_interrupted();

/// Whether a live line stands on the terminal, which an interrupt is to erase.
void shows_live_line(bool shown);

/// While one lives, an interrupt waits; it then ends the program where the guard does.
class Uninterrupted {
 public:
  Uninterrupted();
  ~Uninterrupted();
  Uninterrupted(const Uninterrupted&) = delete;
  Uninterrupted& operator=(const Uninterrupted&) = delete;
};

}  // namespace pinjaw::app
