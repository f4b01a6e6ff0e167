#pragma once

#include <array>
#include <string_view>

namespace pinjaw::planner {

/// What became of an edge, a wall or a silhouette of the part in phase 1. Where its pieces fared differently,
/// the last one named here counts.
enum class Fate {
  Seam,          ///< one closed face's border with itself
  Degenerate,    ///< a pole or tip: no curve in space
  NotGraspable,  ///< a profile says so
  Upright,       ///< a point in plan
  OffSurface,    ///< no part on either side of it: the file's edge lies beside its faces
  Hidden,        ///< other surface lies below
  InFlat,        ///< the surface runs on across it
  LowStep,       ///< the surface jumps there, by less than the engagement
  Coincident,    ///< runs above or below another one that stands for both
  TooShort,      ///< shorter than eps
  NoRoom,        ///< a feature, but a closed pin has no room anywhere on it
  Kept,          ///< a feature that a closed pin can touch
};

inline constexpr std::array kFates{Fate::Seam,       Fate::Degenerate, Fate::NotGraspable, Fate::Upright,
                                   Fate::OffSurface, Fate::Hidden,     Fate::InFlat,       Fate::LowStep,
                                   Fate::Coincident, Fate::TooShort,   Fate::NoRoom,       Fate::Kept};

/// The name in documents: `low_step`.
std::string_view to_string(Fate fate);
/// What it means, for readers: "jumps by less than the engagement".
std::string_view meaning_of(Fate fate);

/// How many of one kind there are and what became of them: the fates add up to the total.
struct FateCounts {
  int total = 0;
  std::array<int, kFates.size()> of_fate{};

  void add(Fate fate, int count = 1) {
    total += count;
    of_fate[static_cast<std::size_t>(fate)] += count;
  }
  [[nodiscard]] int operator[](Fate fate) const { return of_fate[static_cast<std::size_t>(fate)]; }
  friend bool operator==(const FateCounts&, const FateCounts&) = default;
};

}  // namespace pinjaw::planner
