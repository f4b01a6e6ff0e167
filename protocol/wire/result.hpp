#pragma once

#include <optional>
#include <utility>

namespace pinjaw::wire {

/// A value, or the named reason why there is none; portable code has no exceptions and no std::expected.
template <class T, class Error>
class Result {
 public:
  // Both convert implicitly so that a function may `return value` or `return Error::Name`.
  constexpr Result(T value) : value_(std::move(value)) {}  // NOLINT(google-explicit-constructor)
  constexpr Result(Error error) : error_(error) {}         // NOLINT(google-explicit-constructor)

  [[nodiscard]] constexpr bool has_value() const { return value_.has_value(); }
  constexpr explicit operator bool() const { return has_value(); }
  /// Precondition of the next three: has_value().
  constexpr const T& operator*() const { return *value_; }
  constexpr const T* operator->() const { return &*value_; }
  [[nodiscard]] constexpr const T& value() const { return *value_; }
  /// Meaningful where there is no value.
  [[nodiscard]] constexpr Error error() const { return error_; }

 private:
  std::optional<T> value_;
  Error error_{};
};

}  // namespace pinjaw::wire
