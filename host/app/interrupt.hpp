#pragma once

namespace pinjaw::app {

/// From now on SIGINT and SIGTERM end the program with exit code 130, at once, or where an output file is
/// being written as soon as that is whole.
void end_when_interrupted();

/// While one lives, an interrupt waits; it then ends the program where the guard does.
class Uninterrupted {
 public:
  Uninterrupted();
  ~Uninterrupted();
  Uninterrupted(const Uninterrupted&) = delete;
  Uninterrupted& operator=(const Uninterrupted&) = delete;
};

}  // namespace pinjaw::app
