#include "host/app/context.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <memory>

#include "host/base/files.hpp"

namespace pinjaw::app {

namespace {

bool is_terminal(std::FILE* stream) { return ::isatty(::fileno(stream)) == 1; }

bool in_color() { return is_terminal(stderr) && std::getenv("NO_COLOR") == nullptr; }

/// One line that is written over and over: phase, count, share, time left.
class LiveLine {
 public:
  void show(const planner::Progress& progress) {
    const auto now = std::chrono::steady_clock::now();
    if (progress.phase != phase_) {
      finish();
      phase_ = progress.phase;
      started_ = now;
    } else if (now - shown_ < std::chrono::milliseconds(100) && progress.done != progress.total) {
      return;
    }
    shown_ = now;
    std::string line = fmt::format("\r{:<12} {:>9}", progress.phase, progress.done);
    if (progress.total > 0) {
      line += fmt::format(" of {} ({} %)", progress.total, 100 * progress.done / progress.total);
      const double elapsed_s = std::chrono::duration<double>(now - started_).count();
      if (progress.done > 0 && progress.done < progress.total) {
        const double rate = static_cast<double>(progress.done) / elapsed_s;
        line += fmt::format(", {:.0f} s left", static_cast<double>(progress.total - progress.done) / rate);
      }
    }
    fmt::print(stderr, "{}\033[K", line);
    std::fflush(stderr);
  }
  ~LiveLine() { finish(); }

 private:
  void finish() const {
    if (!phase_.empty()) fmt::print(stderr, "\r\033[K");
  }

  std::string phase_;
  std::chrono::steady_clock::time_point started_;
  std::chrono::steady_clock::time_point shown_;
};

}  // namespace

void Context::print(std::string_view text) const { fmt::print("{}\n", text); }

void Context::note(std::string_view text) const {
  if (!quiet) fmt::print(stderr, "{}\n", text);
}

void Context::fail(ExitCode code, std::string_view message) {
  const char* start = in_color() ? "\033[31mpinjaw:\033[0m" : "pinjaw:";
  fmt::print(stderr, "{} {}\n", start, message);
  exit_code = code;
}

void Context::fail(const base::Diagnostics& mistakes, std::string_view consequence) {
  fmt::print(stderr, "{}", base::render(mistakes, consequence));
  exit_code = ExitCode::BadFile;
}

bool Context::write_result(const std::filesystem::path& path, std::string_view bytes) {
  if (path.empty() || path == "-") {
    std::fwrite(bytes.data(), 1, bytes.size(), stdout);
    return true;
  }
  if (const auto written = base::write_file_whole(path, bytes); !written) {
    fail(ExitCode::BadFile, fmt::format("{}: {}", path.string(), written.error().message));
    return false;
  }
  return true;
}

planner::ProgressSink Context::progress_sink() const {
  if (quiet || progress == ProgressMode::None) return {};
  if (progress == ProgressMode::Json) {
    return [](const planner::Progress& at) {
      fmt::print(stderr, "{{\"phase\":\"{}\",\"done\":{},\"total\":{}}}\n", at.phase, at.done, at.total);
    };
  }
  if (!is_terminal(stderr)) return {};
  return [line = std::make_shared<LiveLine>()](const planner::Progress& at) { line->show(at); };
}

}  // namespace pinjaw::app
