#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <type_traits>

/// Figures that tests measure of the promises in docs/safety.md.
namespace pinjaw::test {

/// States that `what` of promise `promise` came out as `value`: a line on stdout and, where the environment
/// variable PINJAW_FIGURES names a file, one JSON object appended to it. `./dev safety` makes its table of
/// them.
void figure(std::string_view promise, std::string_view what, std::string_view value,
            std::string_view unit = {});
void figure(std::string_view promise, std::string_view what, double value, std::string_view unit = {});
void figure(std::string_view promise, std::string_view what, std::int64_t value, std::string_view unit = {});
inline void figure(std::string_view promise, std::string_view what, const char* value,
                   std::string_view unit = {}) {
  figure(promise, what, std::string_view(value), unit);
}
template <class Whole>
requires(std::is_integral_v<Whole>) void figure(std::string_view promise, std::string_view what, Whole value,
                                                std::string_view unit = {}) {
  figure(promise, what, static_cast<std::int64_t>(value), unit);
}

}  // namespace pinjaw::test
