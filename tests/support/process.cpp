#include "tests/support/process.hpp"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <thread>
#include <utility>

namespace pinjaw::test {

namespace {

using Clock = std::chrono::steady_clock;
constexpr std::chrono::milliseconds kPoll(50);

/// `descriptor` writes to a file from now on, where one is named.
bool redirect(int descriptor, const std::string& path) {
  if (path.empty()) return true;
  constexpr mode_t kReadable = 0644;
  const int file = open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC, kReadable);
  return file >= 0 && dup2(file, descriptor) >= 0;
}

}  // namespace

Process::Process(std::vector<std::string> command, const std::string& output, const std::string& errors)
    : child_(fork()) {
  if (child_ != 0) return;
  if (!redirect(STDOUT_FILENO, output) || !redirect(STDERR_FILENO, errors)) _exit(126);
  std::vector<char*> arguments;
  arguments.reserve(command.size() + 1);
  for (std::string& word : command) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  execvp(arguments.front(), arguments.data());
  _exit(127);
}

Process::~Process() {
  if (child_ <= 0) return;
  kill(child_, SIGKILL);
  waitpid(child_, nullptr, 0);
}

void Process::signal(int number) const {
  if (child_ > 0) kill(child_, number);
}

int Process::wait(std::chrono::seconds patience) {
  const auto give_up = Clock::now() + patience;
  int status = 0;
  while (waitpid(child_, &status, WNOHANG) == 0) {
    if (Clock::now() > give_up) return -1;
    std::this_thread::sleep_for(kPoll);
  }
  child_ = 0;
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

bool shell(const std::string& command) {
  return std::system(("PATH=$PATH:/usr/sbin:/sbin; " + command).c_str()) == 0;
}

}  // namespace pinjaw::test
