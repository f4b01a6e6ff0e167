#pragma once

#include <string>
#include <tl/expected.hpp>

namespace pinjaw::base {

/// Why an operation in the outside world failed: a sentence that a person can act on.
struct Failure {
  std::string message;
};

/// A value, or why there is none.
template <class T, class E = Failure>
using Expected = tl::expected<T, E>;

/// `return failure("cannot open {}", path)`-style helper: wraps a sentence for an Expected.
inline tl::unexpected<Failure> failure(std::string message) {
  return tl::unexpected<Failure>(Failure{std::move(message)});
}

}  // namespace pinjaw::base
