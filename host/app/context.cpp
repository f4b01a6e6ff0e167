#include "host/app/context.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <nlohmann/json.hpp>

#include "host/app/interrupt.hpp"
#include "host/base/files.hpp"

namespace pinjaw::app {

namespace {

bool is_terminal(std::FILE* stream) {
  return ::isatty(::fileno(stream)) == 1;
}

bool in_color() {
  return is_terminal(stderr) && std::getenv("NO_COLOR") == nullptr;
}

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

/// One JSON object a line, of each phase the first and the last and a few a second between.
class JsonLines {
 public:
  void show(const planner::Progress& progress) {
    const auto now = std::chrono::steady_clock::now();
    const bool news = progress.phase != phase_ || progress.done == progress.total;
    if (!news && now - shown_ < std::chrono::milliseconds(100)) return;
    phase_ = progress.phase;
    shown_ = now;
    const nlohmann::ordered_json line = {
        {"phase", progress.phase}, {"done", progress.done}, {"total", progress.total}};
    fmt::print(stderr, "{}\n", line.dump());
  }

 private:
  std::string phase_;
  std::chrono::steady_clock::time_point shown_;
};

}  // namespace

void Context::print(std::string_view text) const {
  put(text);
  if (!text.ends_with('\n')) put("\n");
}

void Context::put(std::string_view bytes) const {
  if (std::fwrite(bytes.data(), 1, bytes.size(), stdout) != bytes.size() && stdout_error_ == 0)
    stdout_error_ = errno;
}

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
    put(bytes);
    return true;
  }
  const Uninterrupted writing;
  if (const auto written = base::write_file_whole(path, bytes); !written) {
    fail(ExitCode::BadFile, written.error().message);
    return false;
  }
  return true;
}

bool Context::deliver(const std::filesystem::path& path, std::string_view document,
                      std::string_view summary) {
  if (!write_result(path, document)) return false;
  if (path.empty() || path == "-") {
    note(summary);
  } else {
    print(json ? document : summary);
  }
  return true;
}

bool Context::can_write(const std::filesystem::path& path, const std::filesystem::path& input) {
  if (path.empty() || path == "-") return true;
  std::error_code ignored;
  if (!input.empty() && std::filesystem::equivalent(path, input, ignored)) {
    fail(ExitCode::Usage, fmt::format("{} is what is read; write the result elsewhere", path.string()));
    return false;
  }
  const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : ".";
  std::string reason;
  if (std::filesystem::is_directory(path, ignored)) {
    reason = "it is a folder";
  } else if (!std::filesystem::is_directory(folder, ignored)) {
    reason = fmt::format("there is no folder {}", folder.string());
  } else if (const auto& checked = std::filesystem::exists(path, ignored) ? path : folder;
             ::access(checked.c_str(), W_OK) != 0) {
    reason = fmt::format("{}: {}", checked.string(), std::generic_category().message(errno));
  }
  if (reason.empty()) return true;
  fail(ExitCode::BadFile, fmt::format("cannot write {}: {}", path.string(), reason));
  return false;
}

void Context::finish() {
  if (std::fflush(stdout) != 0 && stdout_error_ == 0) stdout_error_ = errno;
  if (stdout_error_ == 0) return;
  fail(ExitCode::BadFile,
       fmt::format("cannot write the result to stdout: {}", std::generic_category().message(stdout_error_)));
}

planner::ProgressSink Context::progress_sink() const {
  if (quiet || progress == ProgressMode::None) return {};
  if (progress == ProgressMode::Json) {
    return [lines = std::make_shared<JsonLines>()](const planner::Progress& at) { lines->show(at); };
  }
  if (!is_terminal(stderr)) return {};
  return [line = std::make_shared<LiveLine>()](const planner::Progress& at) { line->show(at); };
}

}  // namespace pinjaw::app
