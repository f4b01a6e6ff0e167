#include "host/app/context.hpp"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <random>

#include "host/app/interrupt.hpp"
#include "host/app/progress.hpp"
#include "host/base/files.hpp"
#include "host/config/key_file.hpp"

namespace pinjaw::app {

namespace {

bool is_terminal(std::FILE* stream) {
  return ::isatty(::fileno(stream)) == 1;
}

bool in_color() {
  return is_terminal(stderr) && std::getenv("NO_COLOR") == nullptr;
}

/// Columns of the terminal that stderr is.
int columns() {
  winsize size{};
  constexpr int kUsual = 80;
  return ::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : kUsual;
}

double now_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// All at once, so that a terminal never shows half a line.
void put_on_stderr(std::string_view bytes) {
  if (bytes.empty()) return;
  std::fwrite(bytes.data(), 1, bytes.size(), stderr);
  std::fflush(stderr);
}

/// A display on the terminal, which it leaves tidy.
class Screen {
 public:
  explicit Screen(bool redraws) : display_(redraws) { shows_live_line(redraws); }
  ~Screen() {
    shows_live_line(false);
    put_on_stderr(display_.finish(now_s(), columns()));
  }
  Screen(const Screen&) = delete;
  Screen& operator=(const Screen&) = delete;
  void show(const planner::Progress& progress) { put_on_stderr(display_.show(progress, now_s(), columns())); }

 private:
  LiveDisplay display_;
};

bool can_redraw() {
  const char* kind = std::getenv("TERM");
  return kind != nullptr && std::string_view(kind) != "dumb";
}

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
    return [lines = std::make_shared<JsonDisplay>()](const planner::Progress& at) {
      put_on_stderr(lines->show(at, now_s()));
    };
  }
  if (!is_terminal(stderr)) return {};
  return [screen = std::make_shared<Screen>(can_redraw())](const planner::Progress& at) { screen->show(at); };
}

std::optional<jaw_client::Client::Settings> Context::host_settings(
    const std::optional<model::Authentication>& fallback) {
  constexpr unsigned kEpochs = 0xFFFF;
  std::random_device random;
  jaw_client::Client::Settings settings{
      .epoch = static_cast<std::uint16_t>(random() % kEpochs + 1),
      .nonces = std::uint64_t{random()} << 32 | random(),
  };
  if (fallback) settings.key = fallback->key;
  settings.can_fd = can_fd || (fallback && fallback->can_fd);
  if (!key_file.empty()) {
    const auto key = config::read_key_file(key_file);
    if (!key) {
      fail(ExitCode::BadFile, key.error().message);
      return std::nullopt;
    }
    settings.key = *key;
  }
  if (settings.can_fd && !settings.key) {
    fail(ExitCode::Usage, "--can-fd needs a key: name its file with --key-file");
    return std::nullopt;
  }
  return settings;
}

}  // namespace pinjaw::app
