// The libFuzzer program: PINJAW_FUZZ_TARGET names the target, without it they are listed; all else is
// libFuzzer's own.
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>

#include "tests/fuzz/targets.hpp"

namespace {

const pinjaw::fuzz::Target* chosen = nullptr;

/// One target a line: name, dictionary, seeds.
void list(const std::vector<pinjaw::fuzz::Target>& all) {
  for (const auto& target : all) {
    std::printf("%s %s", target.name.c_str(), target.dictionary.c_str());
    for (const auto& seed : target.seeds) std::printf(" %s", seed.c_str());
    std::printf("\n");
  }
  std::fflush(stdout);
}

}  // namespace

extern "C" int LLVMFuzzerInitialize(int* /*count*/, char*** /*arguments*/) {
  const char* name = std::getenv("PINJAW_FUZZ_TARGET");
  const auto& all = pinjaw::fuzz::targets();
  const auto found = std::ranges::find(all, name == nullptr ? "" : name, &pinjaw::fuzz::Target::name);
  if (found == all.end()) {
    list(all);
    std::_Exit(name == nullptr ? EXIT_SUCCESS : EXIT_FAILURE);
  }
  chosen = &*found;
  chosen->answer({});  // what is made once is made before libFuzzer takes the time of its inputs
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t count) {
  chosen->answer({reinterpret_cast<const char*>(bytes), count});
  return 0;
}
