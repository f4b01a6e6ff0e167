#pragma once

#include <cstdint>
#include <limits>
#include <string>

/// What numbers of files must be, whatever the files are written in.
namespace pinjaw::base {

/// What a number must be. `what` names it in messages: "expected WHAT, found ...".
struct NumberRule {
  std::string what;
  double at_least = -std::numeric_limits<double>::infinity();
  double at_most = std::numeric_limits<double>::infinity();
  double above = -std::numeric_limits<double>::infinity();  ///< strictly
  [[nodiscard]] bool allows(double value) const {
    return value >= at_least && value <= at_most && value > above;
  }
};

/// What a whole number must be.
struct WholeRule {
  std::string what;
  std::int64_t at_least = std::numeric_limits<std::int64_t>::min();
  std::int64_t at_most = std::numeric_limits<std::int64_t>::max();
  [[nodiscard]] bool allows(std::int64_t value) const { return value >= at_least && value <= at_most; }
};

}  // namespace pinjaw::base
