#include <cstdio>
#include <cstdlib>

#include "tests/fuzz/targets.hpp"

namespace pinjaw::fuzz {

void must(bool holds, const std::string& sentence) {
  if (holds) return;
  std::fprintf(stderr, "%s\n", sentence.c_str());
  std::abort();
}

}  // namespace pinjaw::fuzz
