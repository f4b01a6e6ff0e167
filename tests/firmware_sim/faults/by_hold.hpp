#pragma once

#include "protocol/wire/codes.hpp"

namespace pinjaw::test {

/// What HOLD makes of a state, as a controller asks it of itself once it is off the bus
/// (docs/reliability.md 2.6).
constexpr wire::State by_hold(wire::State state) {
  switch (state) {
    case wire::State::Squeezing:
      return wire::State::Seated;
    case wire::State::Offered:
      return wire::State::Hold;
    case wire::State::Relax:
      return wire::State::Resqueeze;
    default:
      return state;
  }
}

}  // namespace pinjaw::test
