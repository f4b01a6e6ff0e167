#include "tests/host/app/child.hpp"

#include <fcntl.h>
#include <poll.h>
#include <pty.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <csignal>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <thread>

#include "tests/support/places.hpp"

extern char** environ;

namespace pinjaw::app_test {

namespace fs = std::filesystem;

namespace {

std::string content_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream bytes;
  bytes << file.rdbuf();
  return bytes.str();
}

std::vector<std::string> split(const std::string& text) {
  std::istringstream words(text);
  std::vector<std::string> parts;
  for (std::string word; words >> word;) parts.push_back(word == "''" ? "" : word);
  return parts;
}

std::vector<char*> pointers_to(std::vector<std::string>& texts) {
  std::vector<char*> pointers;
  for (std::string& text : texts) pointers.push_back(text.data());
  pointers.push_back(nullptr);
  return pointers;
}

/// Our environment without what would change the programs' behaviour.
std::vector<std::string> plain_environment() {
  std::vector<std::string> kept;
  for (char** entry = environ; *entry != nullptr; ++entry) {
    const std::string_view text(*entry);
    if (!text.starts_with("PINJAW_") && !text.starts_with("NO_COLOR")) kept.emplace_back(text);
  }
  return kept;
}

/// A program that runs with its output caught in two files beside the test's folder.
class Child {
 public:
  Child(const fs::path& folder, const std::string& program, const std::string& arguments,
        const std::vector<std::string>& environment)
      : out_(folder.string() + ".out"), err_(folder.string() + ".err") {
    std::vector<std::string> words = split(arguments);
    words.insert(words.begin(), program.starts_with('/') ? program : test::program(program));
    std::vector<std::string> variables = plain_environment();
    variables.insert(variables.end(), environment.begin(), environment.end());
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addchdir_np(&actions, folder.c_str());
    posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    constexpr int kNew = O_WRONLY | O_CREAT | O_TRUNC;
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, out_.c_str(), kNew, 0600);
    posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, err_.c_str(), kNew, 0600);
    posix_spawnattr_t attributes;  // a shell's background job ignores interrupts; these are sent to it
    posix_spawnattr_init(&attributes);
    sigset_t usual;
    sigemptyset(&usual);
    for (const int number : {SIGINT, SIGTERM, SIGHUP}) sigaddset(&usual, number);
    posix_spawnattr_setsigdefault(&attributes, &usual);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGDEF);
    const int failed = posix_spawn(&process_, words.front().c_str(), &actions, &attributes,
                                   pointers_to(words).data(), pointers_to(variables).data());
    posix_spawn_file_actions_destroy(&actions);
    posix_spawnattr_destroy(&attributes);
    if (failed != 0) throw std::runtime_error("cannot start " + words.front());
  }

  void send(int signal) const { ::kill(process_, signal); }

  /// Waits until it has said something on stderr, or has ended.
  void wait_for_words() const {
    const auto has_ended = [this] {
      siginfo_t state{};
      return ::waitid(P_PID, static_cast<id_t>(process_), &state, WEXITED | WNOHANG | WNOWAIT) == 0 &&
             state.si_pid != 0;
    };
    std::error_code ignored;
    while (fs::file_size(err_, ignored) == 0 && !has_ended()) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }

  Ran wait() {
    int status = 0;
    while (::waitpid(process_, &status, 0) < 0) {
    }
    Ran ran{WIFEXITED(status) ? WEXITSTATUS(status) : -1, content_of(out_), content_of(err_)};
    fs::remove(out_);
    fs::remove(err_);
    return ran;
  }

 private:
  fs::path out_;
  fs::path err_;
  pid_t process_ = -1;
};

}  // namespace

Bench::Bench() {
  std::string name = (fs::temp_directory_path() / "pinjaw-app-XXXXXX").string();
  if (::mkdtemp(name.data()) == nullptr) throw std::runtime_error("cannot make " + name);
  folder_ = name;
}

Bench::~Bench() {
  std::error_code ignored;
  fs::remove_all(folder_, ignored);
}

Ran Bench::run(const std::string& program, const std::string& arguments) const {
  return Child(folder_, program, arguments, environment_).wait();
}

Ran Bench::interrupted(const std::string& arguments, int signal, double seconds) const {
  Child child(folder_, "pinjaw", arguments, environment_);
  child.wait_for_words();
  std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
  child.send(signal);
  return child.wait();
}

Ran Bench::on_terminal(const std::string& arguments, int columns, const std::string& typed,
                       double seconds) const {
  std::vector<std::string> words = split(arguments);
  words.insert(words.begin(), test::program("pinjaw"));
  std::vector<std::string> variables = plain_environment();
  std::erase_if(variables, [](const std::string& each) { return each.starts_with("TERM="); });
  variables.insert(variables.end(), environment_.begin(), environment_.end());
  variables.emplace_back("TERM=xterm");  // where a test has set none, which comes first
  const std::vector<char*> argv = pointers_to(words);
  const std::vector<char*> environment = pointers_to(variables);
  winsize size{};
  size.ws_row = 24;
  size.ws_col = static_cast<unsigned short>(columns);
  int terminal = -1;
  const pid_t process = ::forkpty(&terminal, nullptr, nullptr, &size);
  if (process < 0) throw std::runtime_error("no terminal");
  if (process == 0) {
    for (const int number : {SIGINT, SIGTERM, SIGHUP}) std::signal(number, SIG_DFL);
    if (::chdir(folder_.c_str()) == 0) ::execve(argv.front(), argv.data(), environment.data());
    ::_exit(127);
  }
  Ran ran;
  bool has_typed = typed.empty();
  const auto type_at = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
  std::array<char, 4096> piece{};
  while (true) {
    if (!has_typed && std::chrono::steady_clock::now() >= type_at) {
      has_typed = ::write(terminal, typed.data(), typed.size()) > 0;
    }
    pollfd end{terminal, POLLIN, 0};
    constexpr int kOftenMs = 5;
    if (::poll(&end, 1, has_typed ? -1 : kOftenMs) <= 0) continue;
    const ssize_t count = ::read(terminal, piece.data(), piece.size());
    if (count <= 0) break;  // EIO: its other end is closed
    ran.out.append(piece.data(), static_cast<std::size_t>(count));
  }
  int status = 0;
  while (::waitpid(process, &status, 0) < 0) {
  }
  ::close(terminal);
  ran.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return ran;
}

std::string Bench::write(const std::string& name, std::string_view bytes) const {
  fs::create_directories((folder_ / name).parent_path());
  std::ofstream file(folder_ / name, std::ios::binary);
  file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  return name;
}

std::string Bench::read(const std::string& name) const {
  return content_of(folder_ / name);
}

std::vector<std::string> Bench::names() const {
  std::vector<std::string> found;
  for (const auto& entry : fs::directory_iterator(folder_)) found.push_back(entry.path().filename().string());
  std::ranges::sort(found);
  return found;
}

std::string shipped(const std::string& path) {
  return test::source_dir(path);
}

}  // namespace pinjaw::app_test
