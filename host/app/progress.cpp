#include "host/app/progress.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

namespace pinjaw::app {
namespace {

constexpr double kShownAgainAfterS =
    0.1;                                // chosen: the eye follows ten a second, and the plan is not held up
constexpr double kLeastToJudgeS = 0.2;  // chosen: a rate of less time is noise

/// Printable, and cut to so many characters of the screen: names come from files.
std::string fitted(std::string_view text, int columns) {
  std::string line;
  int width = 0;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    const bool begins_character = (byte & 0xC0U) != 0x80U;
    if (begins_character && ++width >= std::max(columns, 2)) break;
    line += byte < 0x20 || byte == 0x7F ? '?' : c;
  }
  return line;
}

/// `8.4/s`, `310/s`, `12.3k/s`, `4.56M/s`.
std::string rate_text(double per_s) {
  if (per_s >= 1e6) return fmt::format("{:.3g}M/s", per_s / 1e6);
  if (per_s >= 1e4) return fmt::format("{:.3g}k/s", per_s / 1e3);
  return per_s >= 10 ? fmt::format("{:.0f}/s", per_s) : fmt::format("{:.2g}/s", per_s);
}

std::string named(const planner::Progress& progress) {
  return fmt::format("{:<12}", progress.phase);
}

}  // namespace

std::string duration_text(double seconds) {
  if (!(seconds > 0)) return "0 s";
  if (seconds < 9.95) return fmt::format("{:.1f} s", seconds);
  constexpr double kMostS = 3.6e6;  // chosen: a thousand hours say enough
  const auto whole = std::llround(std::min(seconds, kMostS));
  if (whole < 60) return fmt::format("{} s", whole);
  if (whole < 3600) return fmt::format("{} min {} s", whole / 60, whole % 60);
  return fmt::format("{} h {} min", whole / 3600, whole / 60 % 60);
}

std::string live_line(const planner::Progress& progress, double elapsed_s, int columns) {
  std::string line = named(progress);
  if (progress.total > 0 || progress.done > 0) line += fmt::format(" {:>9}", progress.done);
  if (progress.total > 0) {
    const double share = static_cast<double>(progress.done) / static_cast<double>(progress.total);
    line += fmt::format(" of {}   {:.0f} %", progress.total, std::floor(100 * std::clamp(share, 0.0, 1.0)));
  }
  if (progress.done > 0 && elapsed_s >= kLeastToJudgeS) {
    const double per_s = static_cast<double>(progress.done) / elapsed_s;
    line += "   " + rate_text(per_s);
    if (progress.total > progress.done) {
      line += fmt::format("   {} left",
                          duration_text(static_cast<double>(progress.total - progress.done) / per_s));
    }
  } else {
    line += " ...";
  }
  return fitted(line, columns);
}

std::string finished_line(const planner::Progress& progress, double elapsed_s, int columns) {
  const std::string count = progress.done == 0 ? ""
                            : progress.done < progress.total
                                ? fmt::format("{} of {}", progress.done, progress.total)
                                : std::to_string(progress.done);
  return fitted(fmt::format("{} {:>9}   {}", named(progress), count, duration_text(elapsed_s)), columns);
}

std::string LiveDisplay::show(const planner::Progress& progress, double now_s, int columns) {
  std::string bytes;
  const bool begins = !last_ || last_->phase != progress.phase;
  if (begins) {
    bytes = finish(now_s, columns);
    started_s_ = now_s;
  }
  last_ = progress;
  if (!begins && now_s - shown_s_ < kShownAgainAfterS) return bytes;
  shown_s_ = now_s;
  if (redraws_) bytes += "\r" + live_line(progress, now_s - started_s_, columns) + "\033[K";
  return bytes;
}

std::string LiveDisplay::finish(double now_s, int columns) {
  if (!last_) return {};
  const std::string line = finished_line(*last_, now_s - started_s_, columns);
  last_.reset();
  return erased() + line + "\n";
}

std::string JsonDisplay::show(const planner::Progress& progress, double now_s) {
  const bool begins = !last_ || last_->phase != progress.phase;
  if (begins) started_s_ = now_s;
  last_ = progress;
  if (!begins && progress.done != progress.total && now_s - shown_s_ < kShownAgainAfterS) return {};
  shown_s_ = now_s;
  const double elapsed_s = std::round((now_s - started_s_) * 1e3) / 1e3;
  const nlohmann::ordered_json line = {{"phase", progress.phase},
                                       {"done", progress.done},
                                       {"total", progress.total},
                                       {"elapsed_s", elapsed_s}};
  return line.dump() + "\n";
}

}  // namespace pinjaw::app
