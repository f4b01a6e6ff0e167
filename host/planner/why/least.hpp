#pragma once

#include <cmath>
#include <cstddef>
#include <optional>
#include <stop_token>

/// Least values that pass a test, by halving. Private to the search for near misses.
namespace pinjaw::planner {

/// The failing and the passing end of a search: `fails` does not pass, `passes` does; either may be greater.
struct Bracket {
  double fails = 0;
  double passes = 0;
};

/// The passing end of the bracket once its ends are within `step` of each other.
template <class Passes>
double boundary(Bracket bracket, double step, const Passes& passes) {
  while (std::abs(bracket.passes - bracket.fails) > step) {
    const double middle = (bracket.fails + bracket.passes) / 2;
    (passes(middle) ? bracket.passes : bracket.fails) = middle;
  }
  return bracket.passes;
}

/// Which of many passes first, and where.
struct Least {
  double value = 0;
  std::size_t which = 0;
};

/// The least value in (0, most] at which any of `count` things passes, to within `step`. Each passes from
/// some value on; nothing where none does. A thing is halved only when it passes below the least so far, so
/// that few of them are.
template <class Passes>
std::optional<Least> least_over(std::size_t count, double most, double step, const std::stop_token& stop,
                                const Passes& passes) {
  std::optional<Least> least;
  for (std::size_t i = 0; i < count && !stop.stop_requested(); ++i) {
    const double from = least ? least->value - step : most;
    if (from <= 0) break;
    if (!passes(i, from)) continue;
    least = Least{boundary({0, from}, step, [&](double value) { return passes(i, value); }), i};
  }
  return least;
}

}  // namespace pinjaw::planner
