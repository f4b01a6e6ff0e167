#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "host/planner/plan/plan.hpp"

/// How far a command has come, as text. The clock and the terminal are the caller's.
namespace pinjaw::app {

/// `0.4 s`, `12 s`, `2 min 5 s`, `1 h 12 min`; less than nothing is nothing.
std::string duration_text(double seconds);

/// A phase that has taken `elapsed_s` so far:
/// `planar         1234 of 5000   24 %   310/s   12 s left`, as far as it is known, in at most `columns`.
std::string live_line(const planner::Progress& progress, double elapsed_s, int columns);

/// A phase that has come to its end: `planar         5000   16 s`.
std::string finished_line(const planner::Progress& progress, double elapsed_s, int columns);

/// What a terminal is sent: one live line that is written over, which the phases that are finished leave
/// behind, each as a line with its count and time.
class LiveDisplay {
 public:
  /// `redraws`: the terminal can erase a line; where it cannot, it shows the finished phases alone.
  explicit LiveDisplay(bool redraws) : redraws_(redraws) {}

  /// The bytes to write when `progress` is told at `now_s`; often none, so that nothing flickers.
  std::string show(const planner::Progress& progress, double now_s, int columns);
  /// The bytes that leave the last phase as a line.
  std::string finish(double now_s, int columns);

 private:
  [[nodiscard]] std::string erased() const { return redraws_ ? "\r\033[K" : ""; }

  bool redraws_;
  std::optional<planner::Progress> last_;
  double started_s_ = 0;
  double shown_s_ = 0;
};

/// What a script is sent: JSON objects, one a line, of each phase the first and the last and a few a second
/// between.
class JsonDisplay {
 public:
  std::string show(const planner::Progress& progress, double now_s);

 private:
  std::optional<planner::Progress> last_;
  double started_s_ = 0;
  double shown_s_ = 0;
};

}  // namespace pinjaw::app
