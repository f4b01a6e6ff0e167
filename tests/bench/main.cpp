// pinjaw_bench [--json FILE] [SUITE...]: ours beside peers, in one run, in CPU time. All suites where none is
// named.
#include <fstream>
#include <iostream>
#include <string>
#include <utility>
#include <vector>

#include "tests/bench/suites.hpp"

namespace {

using Suite = std::pair<const char*, void (*)(pinjaw::bench::Report&)>;
constexpr Suite kSuites[] = {
    {"squeeze", pinjaw::bench::measure_squeeze},
    {"planar", pinjaw::bench::measure_planar},
    {"stand", pinjaw::bench::measure_stand},
    {"plan", pinjaw::bench::measure_plan},
};

int usage(const std::string& wrong) {
  std::cerr << "pinjaw_bench: no such suite: " << wrong
            << "\nusage: pinjaw_bench [--json FILE] [SUITE...]\nsuites:";
  for (const auto& [name, measure] : kSuites) std::cerr << ' ' << name;
  std::cerr << '\n';
  return 2;
}

}  // namespace

int main(int argc, char** argv) {
  std::string json_file;
  std::vector<Suite> chosen;
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    if (argument == "--json" && i + 1 < argc) {
      json_file = argv[++i];
      continue;
    }
    bool known = false;
    for (const Suite& suite : kSuites) {
      if (argument != suite.first) continue;
      chosen.push_back(suite);
      known = true;
    }
    if (!known) return usage(argument);
  }
  if (chosen.empty()) chosen.assign(std::begin(kSuites), std::end(kSuites));

  pinjaw::bench::Report report(std::cout);
  for (const auto& [name, measure] : chosen) {
    std::cout << "== " << name << " ==\n";
    measure(report);
  }
  if (json_file.empty()) return 0;
  std::ofstream file(json_file);
  file << report.json();
  return file.flush() ? 0 : 1;
}
