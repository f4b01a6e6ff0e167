#include "host/base/isolated.hpp"

#include <gmock/gmock.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <stdexcept>
#include <thread>
#include <vector>

namespace pinjaw::base {
namespace {

using testing::HasSubstr;
using Kind = Misfortune::Kind;

#if defined(__SANITIZE_ADDRESS__)
constexpr bool kSanitized = true;
#else
constexpr bool kSanitized = false;
#endif

constexpr IsolationLimits kLimits{.seconds = 60, .memory_mb = 64};

Misfortune misfortune_of(const IsolatedWork& work, const IsolationLimits& limits = kLimits) {
  const auto answer = run_isolated(limits, work);
  EXPECT_FALSE(answer) << "it gave " << answer->size() << " bytes";
  return answer ? Misfortune{} : answer.error();
}

bool has_children() {
  return ::waitpid(-1, nullptr, WNOHANG) >= 0 || errno != ECHILD;
}

/// After each test nothing is left of its child.
class Isolated : public testing::Test {
 protected:
  void TearDown() override { EXPECT_FALSE(has_children()); }
};

TEST_F(Isolated, work_gives_its_bytes_back_whatever_they_are) {
  const std::string zeros(3, '\0');
  for (const std::string& bytes : {std::string(), zeros, std::string(3'000'000, 'x')}) {
    const auto answer = run_isolated(kLimits, [&](const IsolatedStage& stage) {
      stage("copying");
      return bytes;
    });
    ASSERT_TRUE(answer) << answer.error().message;
    EXPECT_TRUE(*answer == bytes);
  }
}

TEST_F(Isolated, work_leaves_the_callers_memory_alone) {
  std::string mine = "mine";
  ASSERT_TRUE(run_isolated(kLimits, [&](const IsolatedStage&) { return mine = "its"; }));
  EXPECT_EQ(mine, "mine");
}

TEST_F(Isolated, works_own_refusal_comes_through_as_it_is) {
  const Misfortune refused =
      misfortune_of([](const IsolatedStage&) { return failure("the moon is not full"); });
  EXPECT_EQ(refused.kind, Kind::Refused);
  EXPECT_EQ(refused.message, "the moon is not full");
}

TEST_F(Isolated, a_crash_is_told_with_its_signal_and_what_was_being_done) {
  const Misfortune crash = misfortune_of([](const IsolatedStage& stage) -> Expected<std::string> {
    stage("parsing");
    stage("reading its edges");
    std::raise(SIGSEGV);
    return "";
  });
  EXPECT_EQ(crash.kind, Kind::Crashed);
  EXPECT_EQ(crash.message, "crashed (SIGSEGV) while reading its edges");
}

TEST_F(Isolated, an_abort_and_an_exception_that_nobody_catches_are_crashes) {
  EXPECT_EQ(misfortune_of([](const IsolatedStage&) -> Expected<std::string> { std::abort(); }).message,
            "crashed (SIGABRT)");
  EXPECT_EQ(misfortune_of([](const IsolatedStage&) -> Expected<std::string> {
              throw std::runtime_error("nobody is there");
            }).message,
            "crashed (SIGABRT)");
}

TEST_F(Isolated, an_endless_recursion_is_a_crash) {
  if (kSanitized) GTEST_SKIP() << "the sanitizer reports it itself";
  struct Deep {
    static std::size_t down(std::size_t depth) {  // NOLINT(misc-no-recursion)
      volatile char room[4096];
      room[depth % sizeof room] = 1;
      return room[depth % sizeof room] > 2 ? depth : down(depth + 1) + static_cast<std::size_t>(room[0]);
    }
  };
  EXPECT_EQ(misfortune_of([](const IsolatedStage&) { return std::to_string(Deep::down(0)); }).kind,
            Kind::Crashed);
}

TEST_F(Isolated, an_early_exit_is_told_with_its_code) {
  EXPECT_EQ(misfortune_of([](const IsolatedStage&) -> Expected<std::string> { ::_exit(7); }).message,
            "ended early (exit code 7)");
}

TEST_F(Isolated, a_kill_from_outside_is_told_as_one) {
  EXPECT_EQ(misfortune_of([](const IsolatedStage& stage) -> Expected<std::string> {
              stage("meshing");
              ::kill(::getpid(), SIGKILL);
              return "";
            }).message,
            "was killed (SIGKILL) while meshing");
}

TEST_F(Isolated, work_that_never_ends_is_stopped_and_told_with_its_limit) {
  const Misfortune busy = misfortune_of(
      [](const IsolatedStage& stage) -> Expected<std::string> {
        stage("counting");
        std::atomic<std::uint64_t> count = 0;
        while (true) ++count;
      },
      {.seconds = 0.2, .memory_mb = 64});
  EXPECT_EQ(busy.kind, Kind::Time);
  EXPECT_EQ(busy.message, "takes longer than 0.2 s while counting");
  const Misfortune asleep = misfortune_of(
      [](const IsolatedStage&) -> Expected<std::string> {
        while (true) ::pause();
      },
      {.seconds = 0.2, .memory_mb = 64});
  EXPECT_EQ(asleep.kind, Kind::Time);
}

TEST_F(Isolated, work_that_closes_its_pipe_and_stays_is_stopped_too) {
  const Misfortune hidden = misfortune_of(
      [](const IsolatedStage&) -> Expected<std::string> {
        for (int each = 3; each < 1024; ++each) ::close(each);
        while (true) ::pause();
      },
      {.seconds = 0.2, .memory_mb = 64});
  EXPECT_EQ(hidden.kind, Kind::Time);
}

TEST_F(Isolated, hunger_is_told_with_its_limit_even_where_the_work_swallows_it) {
  if (kSanitized) GTEST_SKIP() << "its address space cannot be limited";
  const IsolatedWork by_new = [](const IsolatedStage& stage) -> Expected<std::string> {
    stage("meshing");
    std::vector<std::unique_ptr<std::string>> kept;
    while (true) kept.push_back(std::make_unique<std::string>(1'000'000, 'x'));
  };
  EXPECT_EQ(misfortune_of(by_new).kind, Kind::Memory);
  EXPECT_EQ(misfortune_of(by_new).message, "needs more than 64 MB of memory while meshing");
  const IsolatedWork by_malloc = [](const IsolatedStage&) -> Expected<std::string> {
    void* volatile piece = nullptr;     // else the compiler leaves them out
    do piece = std::malloc(1'000'000);  // NOLINT(cppcoreguidelines-no-malloc)
    while (piece != nullptr);
    return "half a part";
  };
  EXPECT_EQ(misfortune_of(by_malloc).kind, Kind::Memory);
}

TEST_F(Isolated, what_the_caller_holds_does_not_count_as_the_works_memory) {
  const std::vector<char> much(100U << 20U, 'x');
  const auto answer =
      run_isolated(kLimits, [&](const IsolatedStage&) { return std::string(1U << 20U, much[5]); });
  EXPECT_TRUE(answer) << answer.error().message;
}

TEST_F(Isolated, garbage_in_the_pipe_is_told_and_so_is_too_much_of_it) {
  const int next_free = ::dup(STDERR_FILENO);
  ::close(next_free);
  const auto write_garbage = [end = next_free + 1](std::size_t pieces) -> IsolatedWork {
    return [end, pieces](const IsolatedStage&) -> Expected<std::string> {
      const std::string garbage(65536, 'A');
      for (std::size_t i = 0; i < pieces; ++i) (void)!::write(end, garbage.data(), garbage.size());
      return "";
    };
  };
  EXPECT_EQ(misfortune_of(write_garbage(1)).message, "gave a garbled answer");
  EXPECT_EQ(misfortune_of(write_garbage(1'000'000), {.seconds = 60, .memory_mb = 8}).message,
            "gave an endless answer");
}

TEST_F(Isolated, work_prints_nothing) {
  if (kSanitized) GTEST_SKIP() << "its reports are wanted";
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  ASSERT_TRUE(run_isolated(kLimits, [](const IsolatedStage&) {
    (void)!::write(STDOUT_FILENO, "out", 3);
    (void)!::write(STDERR_FILENO, "err", 3);
    return std::string();
  }));
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST_F(Isolated, work_started_beside_busy_threads_comes_to_its_end) {
  std::atomic<bool> done = false;
  std::vector<std::jthread> others;
  for (int i = 0; i < 4; ++i) {
    others.emplace_back([&] {
      while (!done) std::vector<std::string>(100, std::string(100, 'x')).clear();
    });
  }
  for (int round = 0; round < 20; ++round) {
    EXPECT_TRUE(run_isolated(kLimits, [&](const IsolatedStage&) {
      try {
        throw std::runtime_error("caught");
      } catch (const std::exception& error) {
        return std::string(error.what()) + std::string(100'000, 'x');
      }
    }));
  }
  done = true;
}

/// The process number that a process in state 'running' or another has in /proc; false where it is gone.
bool is_alive(pid_t process) {
  std::ifstream status("/proc/" + std::to_string(process) + "/stat");
  std::string number;
  std::string name;
  char state = 'Z';
  return static_cast<bool>(status >> number >> name >> state) && state != 'Z';
}

TEST_F(Isolated, the_work_ends_with_its_caller_even_where_that_is_killed) {
  const auto note = std::filesystem::path(testing::TempDir()) / ("isolated-" + std::to_string(::getpid()));
  const pid_t caller = ::fork();
  if (caller == 0) {
    (void)run_isolated(kLimits, [&](const IsolatedStage&) -> Expected<std::string> {
      std::ofstream(note) << ::getpid() << "\n";
      while (true) ::pause();
    });
    ::_exit(0);
  }
  pid_t work = 0;
  while (!(std::ifstream(note) >> work)) std::this_thread::sleep_for(std::chrono::milliseconds(5));
  EXPECT_TRUE(is_alive(work));
  ::kill(caller, SIGKILL);
  ::waitpid(caller, nullptr, 0);
  for (int i = 0; i < 2000 && is_alive(work); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(5));
  EXPECT_FALSE(is_alive(work));
  std::filesystem::remove(note);
}

}  // namespace
}  // namespace pinjaw::base
