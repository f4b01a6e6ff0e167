#pragma once

#include <algorithm>
#include <string>

#include "host/base/diagnostics.hpp"
#include "tests/fuzz/targets.hpp"

namespace pinjaw::fuzz {

/// A refused file tells at least one mistake, each with its file and a sentence of no unbounded length.
inline void must_tell(const base::Diagnostics& mistakes) {
  constexpr std::size_t kLongestSentence = 2000;  // a file's name may be told in it
  must(!mistakes.empty(), "refused without a reason");
  for (const base::Diagnostic& each : mistakes) {
    must(!each.message.empty(), "a mistake without a sentence");
    must(!each.place.file.empty(), "a mistake without a file: " + each.message);
    must(each.message.size() < kLongestSentence, "an endless sentence: " + each.message.substr(0, 200));
    must((each.place.line == 0) == (each.place.column == 0), "half a place: " + base::to_string(each));
  }
  must(!base::render(mistakes, "nothing was done").empty(), "nothing to show");
}

}  // namespace pinjaw::fuzz
