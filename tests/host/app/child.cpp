#include "tests/host/app/child.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
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
    const int failed = posix_spawn(&process_, words.front().c_str(), &actions, nullptr,
                                   pointers_to(words).data(), pointers_to(variables).data());
    posix_spawn_file_actions_destroy(&actions);
    if (failed != 0) throw std::runtime_error("cannot start " + words.front());
  }

  void send(int signal) const { ::kill(process_, signal); }

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
  std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
  child.send(signal);
  return child.wait();
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
