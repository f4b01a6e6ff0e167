#pragma once

#include <type_traits>

/// What the mutated copies of the portable code ask at every place where they can go wrong.
///
/// All mutants live in one binary. A process is told which of them it is; in constant evaluation the code is
/// what it was, so that a constexpr function mutates only where it runs; unless PINJAW_MUTANT names one, for
/// a build of its own.
namespace pinjaw::mutation {

inline constexpr int kTable = 1 << 13;   ///< ids of mutants in the code are below
inline constexpr int kPlaces = 1 << 10;  ///< the state table has fewer
inline constexpr int kValues = 32;       ///< a place's mutants: kTable + place * kValues + value

extern int chosen;                               ///< the mutant that this process is; -1: none
extern unsigned char reached[kTable + kPlaces];  ///< 1 where a run came by

#ifndef PINJAW_MUTANT
#define PINJAW_MUTANT -1  // a build of its own for a mutant that only the compiler runs
#endif

constexpr bool mutant(int id) {
  if (std::is_constant_evaluated()) return id == PINJAW_MUTANT;
  reached[id] = 1;
  return chosen == id;
}

/// What the state table says at a place; `now` unless the mutant is that it says something else.
inline unsigned char cell(int place, unsigned char now) {
  reached[kTable + place] = 1;
  const int changed = chosen - kTable;
  return changed >= 0 && changed / kValues == place ? static_cast<unsigned char>(changed % kValues) : now;
}

/// The type of a constant without its const: a mutated constant keeps it.
template <class T>
using Plain = std::remove_cvref_t<T>;

}  // namespace pinjaw::mutation
