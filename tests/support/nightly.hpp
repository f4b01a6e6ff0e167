#pragma once

#include <cstdlib>

namespace pinjaw::test {

/// Whether this is the nightly run (environment variable PINJAW_NIGHTLY, set by ctest for tests labelled
/// `nightly`): the same tests with bigger bounds.
inline bool nightly() {
  return std::getenv("PINJAW_NIGHTLY") != nullptr;
}

/// `big` in the nightly run, else `small`.
template <class T>
T by_night(T big, T small) {
  return nightly() ? big : small;
}

}  // namespace pinjaw::test
