#include "host/base/isolated.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <functional>
#include <new>
#include <optional>
#include <system_error>
#include <thread>

#include "host/base/write_all.hpp"

namespace pinjaw::base {
namespace {

#if defined(__SANITIZE_ADDRESS__)
constexpr bool kSanitized = true;  // its shadow takes terabytes of address space, its report is wanted
#elif defined(__has_feature)
constexpr bool kSanitized = __has_feature(address_sanitizer);
#else
constexpr bool kSanitized = false;
#endif

constexpr std::uint64_t kMegabyte = 1U << 20U;
constexpr int kExitNoMemory = 97;  // chosen: none that a shell or a sanitizer gives

// What goes through the pipe: messages, each with its kind, its length and a checksum before its content.

struct Message {
  enum class Kind : std::uint64_t { Stage = 1, Answer, Refusal };
  Kind kind = Kind::Refusal;
  std::string content;
};

struct Head {
  Message::Kind kind{};
  std::uint64_t length = 0;
  std::uint64_t checksum = 0;  ///< the same on both sides, which are one program
  friend bool operator==(const Head&, const Head&) = default;
};

Head head_of(Message::Kind kind, std::string_view content) {
  return {kind, content.size(), std::hash<std::string_view>{}(content)};
}

/// The message at the front of `bytes`, which is then gone; nothing where there is none, or a damaged one.
std::optional<Message> next_message(std::string_view& bytes) {
  Head head;
  if (bytes.size() < sizeof head) return std::nullopt;
  std::memcpy(&head, bytes.data(), sizeof head);
  const bool known = head.kind >= Message::Kind::Stage && head.kind <= Message::Kind::Refusal;
  if (!known || head.length > bytes.size() - sizeof head) return std::nullopt;
  const std::string_view content = bytes.substr(sizeof head, head.length);
  if (head_of(head.kind, content) != head) return std::nullopt;
  bytes.remove_prefix(sizeof head + head.length);
  return Message{head.kind, std::string(content)};
}

// The child's side.

bool send(int pipe, Message::Kind kind, std::string_view content) {
  const Head head = head_of(kind, content);
  std::array<char, sizeof head> bytes{};
  std::memcpy(bytes.data(), &head, sizeof head);
  return write_all(pipe, {bytes.data(), bytes.size()}) && write_all(pipe, content);
}

[[noreturn]] void end_without_memory() {
  ::_exit(kExitNoMemory);
}

void limit(__rlimit_resource_t resource, rlim_t soft, rlim_t hard) {
  const rlimit both{soft, hard};
  ::setrlimit(resource, &both);
}

/// A figure in kB of this process; 0 where the system does not tell.
std::uint64_t status_kb(const std::string& name) {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;) {
    std::uint64_t kb = 0;
    if (word == name && status >> kb) return kb;
  }
  return 0;
}

/// Bytes of address space that this process may come to.
std::uint64_t most_bytes(const IsolationLimits& limits) {
  return status_kb("VmSize:") * 1024 + limits.memory_mb * kMegabyte;
}

/// True where an eighth of the memory or less was left at some time. Libraries swallow a failed allocation,
/// and what they go on to give lacks something.
bool came_near(std::uint64_t most, const IsolationLimits& limits) {
  return !kSanitized && status_kb("VmPeak:") * 1024 + limits.memory_mb * kMegabyte / 8 > most;
}

void be_quiet() {
  const int nowhere = ::open("/dev/null", O_RDWR | O_CLOEXEC);
  if (nowhere < 0) return;
  for (const int standard : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) ::dup2(nowhere, standard);
}

/// Leaves behind what the caller set up for itself, and takes on the limits.
void settle(pid_t caller, const IsolationLimits& limits, std::uint64_t most) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != caller) ::_exit(EXIT_FAILURE);
  for (const int number : {SIGINT, SIGTERM, SIGHUP, SIGPIPE, SIGXCPU, SIGXFSZ, SIGSEGV, SIGBUS, SIGFPE,
                           SIGILL, SIGABRT, SIGALRM}) {
    std::signal(number, SIG_DFL);
  }
  sigset_t none;
  sigemptyset(&none);
  ::pthread_sigmask(SIG_SETMASK, &none, nullptr);
  const auto seconds = static_cast<rlim_t>(std::ceil(limits.seconds));
  limit(RLIMIT_CORE, 0, 0);
  limit(RLIMIT_CPU, seconds + 1, seconds + 2);  // where the caller is stopped; the hard one cannot be told
  if (!kSanitized) {
    limit(RLIMIT_AS, most, most);
    be_quiet();
  }
  std::set_new_handler(end_without_memory);
}

[[noreturn]] void be_the_child(int pipe, pid_t caller, const IsolationLimits& limits,
                               const IsolatedWork& work) {
  const std::uint64_t most = most_bytes(limits);
  settle(caller, limits, most);
  bool sent = false;
  try {
    const auto answer = work([pipe](std::string_view doing) { send(pipe, Message::Kind::Stage, doing); });
    if (came_near(most, limits)) end_without_memory();
    sent = answer ? send(pipe, Message::Kind::Answer, *answer)
                  : send(pipe, Message::Kind::Refusal, answer.error().message);
  } catch (const std::bad_alloc&) {
    end_without_memory();
  } catch (...) {
    std::abort();
  }
  ::_exit(sent ? EXIT_SUCCESS : EXIT_FAILURE);
}

// The caller's side.

using Kind = Misfortune::Kind;
using Clock = std::chrono::steady_clock;

tl::unexpected<Misfortune> misfortune(Kind kind, std::string message) {
  return tl::unexpected(Misfortune{kind, std::move(message)});
}

Misfortune too_slow(const IsolationLimits& limits) {
  return {Kind::Time, fmt::format("takes longer than {:g} s", limits.seconds)};
}

/// A forked process; whatever happens, it does not outlive this.
class Child {
 public:
  Child(pid_t process, int pipe, const IsolationLimits& limits)
      : process_(process),
        pipe_(pipe),
        limits_(limits),
        until_(Clock::now() +
               std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(limits.seconds))) {}
  ~Child() {
    ::close(pipe_);
    if (process_ <= 0) return;
    ::kill(process_, SIGKILL);
    while (::waitpid(process_, nullptr, 0) < 0 && errno == EINTR) {
    }
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  /// Takes all that it writes into `bytes` until it closes its end; tells what kept that from happening.
  [[nodiscard]] std::optional<Misfortune> listen(std::string& bytes) const {
    std::array<char, 65536> piece{};
    while (bytes.size() <= limits_.memory_mb * kMegabyte) {
      const auto left = std::chrono::ceil<std::chrono::milliseconds>(until_ - Clock::now());
      if (left.count() <= 0) return too_slow(limits_);
      constexpr std::int64_t kMostMs = 1000;  // chosen: far from what poll can hold
      pollfd end{pipe_, POLLIN, 0};
      if (::poll(&end, 1, static_cast<int>(std::min(kMostMs, std::int64_t{left.count()}))) <= 0) continue;
      const ssize_t count = ::read(pipe_, piece.data(), piece.size());
      if (count < 0 && errno == EINTR) continue;
      if (count <= 0) return std::nullopt;
      bytes.append(piece.data(), static_cast<std::size_t>(count));
    }
    return Misfortune{Kind::Garbled, "gave an endless answer"};
  }

  /// Waits for its end; nothing where it came to that by itself and in order.
  [[nodiscard]] std::optional<Misfortune> end() {
    int status = 0;
    pid_t ended = 0;
    while ((ended = ::waitpid(process_, &status, WNOHANG)) == 0 || (ended < 0 && errno == EINTR)) {
      if (Clock::now() > until_) return too_slow(limits_);
      std::this_thread::sleep_for(std::chrono::microseconds(100));
    }
    process_ = -1;
    if (ended < 0) return std::nullopt;  // somebody else waited for it; its messages must do
    if (WIFSIGNALED(status)) return ended_by(WTERMSIG(status));
    if (WEXITSTATUS(status) == EXIT_SUCCESS) return std::nullopt;
    if (WEXITSTATUS(status) == kExitNoMemory) {
      return Misfortune{Kind::Memory, fmt::format("needs more than {} MB of memory", limits_.memory_mb)};
    }
    return Misfortune{Kind::Crashed, fmt::format("ended early (exit code {})", WEXITSTATUS(status))};
  }

 private:
  [[nodiscard]] Misfortune ended_by(int signal) const {
    if (signal == SIGXCPU) return too_slow(limits_);
    const char* name = ::sigabbrev_np(signal);
    const std::string called =
        name == nullptr ? fmt::format("signal {}", signal) : fmt::format("SIG{}", name);
    const bool killed = signal == SIGKILL || signal == SIGTERM || signal == SIGINT;
    return {Kind::Crashed, fmt::format("{} ({})", killed ? "was killed" : "crashed", called)};
  }

  pid_t process_;
  int pipe_;
  IsolationLimits limits_;
  Clock::time_point until_;
};

/// The child's messages: its last stage, and its answer or refusal where all of them are whole.
struct Said {
  std::string doing;
  std::optional<Message> last;
};

Said sorted(std::string_view bytes) {
  Said said;
  while (auto message = next_message(bytes)) {
    if (message->kind == Message::Kind::Stage) {
      said.doing = " while " + message->content;
    } else {
      said.last = std::move(message);
      break;
    }
  }
  if (!bytes.empty()) said.last.reset();
  return said;
}

}  // namespace

Expected<std::string, Misfortune> run_isolated(const IsolationLimits& limits, const IsolatedWork& work) {
  std::array<int, 2> ends{};
  const auto not_started = [] {
    return misfortune(Kind::NotStarted, "cannot be started: " + std::generic_category().message(errno));
  };
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) return not_started();
  const pid_t caller = ::getpid();
  const pid_t process = ::fork();
  if (process == 0) {
    ::close(ends[0]);
    be_the_child(ends[1], caller, limits, work);
  }
  auto failed = not_started();
  ::close(ends[1]);
  Child child(process, ends[0], limits);
  if (process < 0) return failed;

  std::string bytes;
  std::optional<Misfortune> wrong = child.listen(bytes);
  if (!wrong) wrong = child.end();
  Said said = sorted(bytes);
  if (!wrong && !said.last) wrong = Misfortune{Kind::Garbled, "gave a garbled answer"};
  if (wrong) return misfortune(wrong->kind, wrong->message + said.doing);
  if (said.last->kind == Message::Kind::Refusal) return misfortune(Kind::Refused, said.last->content);
  return std::move(said.last->content);
}

}  // namespace pinjaw::base
