// Runs the tests of wire and core once for each mutant, each in a process of its own.
//
//     mutants                    the tests themselves, without any mutant
//     mutants --reach FILE       which mutants each test comes by, and its CPU time; tests of over a second
//                                are left out: they would cost more than they tell
//     mutants --kill PLAN FILE   PLAN: lines `id test=ms test=ms ...`, quick ones first, ms being the CPU
//     time
//                                without a mutant; FILE gets `id verdict ms test` lines
//
// A mutant is killed by a test that fails, crashes or runs out of CPU time.
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "tests/mutation/mutant.hpp"

namespace pinjaw::mutation {

int chosen = -1;
unsigned char reached[kTable + kPlaces];

namespace {

constexpr double kLongest_ms = 1000;  // of a test that is used
constexpr double kLimit_ms = 1000;    // with kSlower times what a test takes: past it, it never ends
constexpr double kSlower = 10;

std::vector<std::string> all_tests() {
  std::vector<std::string> names;
  const auto* unit = testing::UnitTest::GetInstance();
  for (int i = 0; i < unit->total_test_suite_count(); ++i) {
    const auto* suite = unit->GetTestSuite(i);
    for (int j = 0; j < suite->total_test_count(); ++j) {
      const std::string name = std::string(suite->name()) + "." + suite->GetTestInfo(j)->name();
      if (name.find("DISABLED_") == std::string::npos) names.push_back(name);
    }
  }
  return names;
}

/// Runs the tests named in `filter` here and now; true where all pass.
bool pass(const std::string& filter) {
  testing::GTEST_FLAG(filter) = filter;
  testing::GTEST_FLAG(fail_fast) = true;
  return RUN_ALL_TESTS() == 0;
}

void be_quiet() {
  auto& listeners = testing::UnitTest::GetInstance()->listeners();
  delete listeners.Release(listeners.default_result_printer());
  if (std::freopen("/dev/null", "w", stdout) == nullptr || std::freopen("/dev/null", "w", stderr) == nullptr)
    std::_Exit(2);
}

/// From now on; SIGPROF ends the process then.
void limit_cpu_to(double ms) {
  itimerval timer{};
  timer.it_value.tv_sec = static_cast<time_t>(ms / 1000);
  timer.it_value.tv_usec = static_cast<suseconds_t>(ms * 1000) % 1'000'000;
  setitimer(ITIMER_PROF, &timer, nullptr);
}

void limit_memory() {
  const rlimit core{0, 0};
  setrlimit(RLIMIT_CORE, &core);
  const rlimit bytes{rlim_t{2} << 30, rlim_t{2} << 30};
  setrlimit(RLIMIT_AS, &bytes);
}

double cpu_ms_of(const rusage& usage) {
  const auto ms = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) * 1e3 + static_cast<double>(t.tv_usec) / 1e3;
  };
  return ms(usage.ru_utime) + ms(usage.ru_stime);
}

int reach(const char* file) {
  std::ofstream out(file);
  int bad = 0;
  for (const std::string& name : all_tests()) {
    int ends[2];
    if (pipe(ends) != 0) return 2;
    const pid_t child = fork();
    if (child == 0) {
      be_quiet();
      limit_cpu_to(kLongest_ms);
      std::memset(reached, 0, sizeof reached);
      const bool good = pass(name);
      const ssize_t written = write(ends[1], reached, sizeof reached);
      std::_Exit(good && written == static_cast<ssize_t>(sizeof reached) ? 0 : 1);
    }
    close(ends[1]);
    std::vector<unsigned char> seen(sizeof reached);
    std::size_t got = 0;
    while (got < seen.size()) {
      const ssize_t n = read(ends[0], seen.data() + got, seen.size() - got);
      if (n <= 0) break;
      got += static_cast<std::size_t>(n);
    }
    close(ends[0]);
    int status = 0;
    rusage usage{};
    wait4(child, &status, 0, &usage);
    if (WIFSIGNALED(status) && WTERMSIG(status) == SIGPROF) continue;
    if (status != 0) {
      std::fprintf(stderr, "mutants: %s fails without any mutant\n", name.c_str());
      bad = 1;
    }
    out << name << ' ' << cpu_ms_of(usage);
    for (std::size_t id = 0; id < seen.size(); ++id) {
      if (seen[id] != 0) out << ' ' << id;
    }
    out << '\n';
  }
  return bad;
}

struct Job {
  int id = 0;
  std::vector<std::pair<std::string, double>> tests;  ///< with CPU times in ms
};

/// In a child: which test kills, as an exit code for the parent and a name through `note`.
[[noreturn]] void be_mutant(const Job& job, int note) {
  be_quiet();
  limit_memory();
  chosen = job.id;
  for (const auto& [test, ms] : job.tests) {
    limit_cpu_to(kLimit_ms + kSlower * ms);
    const auto begun = write(note, (test + "\n").c_str(), test.size() + 1);
    if (begun < 0 || !pass(test)) std::_Exit(1);
  }
  std::_Exit(0);
}

const char* verdict_of(int status) {
  if (WIFEXITED(status)) return WEXITSTATUS(status) == 0 ? "survived" : "failed";
  return WTERMSIG(status) == SIGPROF ? "endless" : "crashed";
}

int kill_all(const char* plan, const char* file) {
  std::ifstream in(plan);
  std::vector<Job> jobs;
  for (std::string line; std::getline(in, line);) {
    std::istringstream words(line);
    Job job;
    words >> job.id;
    for (std::string test; words >> test;) {
      const std::size_t equals = test.rfind('=');
      job.tests.emplace_back(test.substr(0, equals), std::atof(test.c_str() + equals + 1));
    }
    jobs.push_back(job);
  }
  std::ofstream out(file);
  struct Running {
    int id = 0;
    int note = 0;
  };
  std::map<pid_t, Running> running;
  std::size_t next = 0;
  const std::size_t workers = std::max(1U, std::thread::hardware_concurrency());
  while (next < jobs.size() || !running.empty()) {
    if (next < jobs.size() && running.size() < workers) {
      int ends[2];
      if (pipe(ends) != 0) return 2;
      const pid_t child = fork();
      if (child == 0) be_mutant(jobs[next], ends[1]);
      close(ends[1]);
      running[child] = {jobs[next].id, ends[0]};
      ++next;
      continue;
    }
    int status = 0;
    rusage usage{};
    const pid_t child = wait4(-1, &status, 0, &usage);
    const Running done = running.at(child);
    running.erase(child);
    std::string notes(1 << 16, '\0');
    const ssize_t n = read(done.note, notes.data(), notes.size());
    notes.resize(n > 0 ? static_cast<std::size_t>(n) - 1 : 0);
    close(done.note);
    const std::size_t last = notes.rfind('\n');
    out << done.id << ' ' << verdict_of(status) << ' ' << cpu_ms_of(usage) << ' '
        << (last == std::string::npos ? notes : notes.substr(last + 1)) << '\n';
    out.flush();
  }
  return 0;
}

}  // namespace
}  // namespace pinjaw::mutation

int main(int argc, char** argv) {
  setenv("RC_PARAMS", "seed=1 noshrink=1", 1);
  testing::InitGoogleTest(&argc, argv);
  if (argc == 3 && std::string(argv[1]) == "--reach") return pinjaw::mutation::reach(argv[2]);
  if (argc == 1) return RUN_ALL_TESTS();
  if (argc == 4 && std::string(argv[1]) == "--kill") return pinjaw::mutation::kill_all(argv[2], argv[3]);
  std::fprintf(stderr, "usage: mutants --reach FILE | --kill PLAN FILE\n");
  return 2;
}
