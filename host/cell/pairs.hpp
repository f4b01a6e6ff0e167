#pragma once

#include <cstdint>
#include <vector>

#include "host/cell/setup.hpp"

namespace pinjaw::cell {

/// A design that a given design of the other station may hand the part to or take it from, and a stance for
/// that: of its stances that can be adjusted and have no interference the one whose gripper's origin lies
/// nearest to the other's, hence the likeliest to suit the other stations as well.
struct Partner {
  std::uint32_t design = 0;
  std::uint32_t stance = 0;
};

/// Partners of each design of one station among those of another, ascending: least squeeze first.
using Partners = std::vector<std::vector<Partner>>;

/// Every pair of designs of two stations that can be adjusted to one place of the part and whose fingers do
/// not clash (phase 6, BB 3.6). `near` keeps its own stance. Cheapest question first: where the pins stand
/// closed, where the grippers' origins lie, then the full checks of a handoff.
Partners partners_of(const StationSetups& near, const StationSetups& far);

std::int64_t count(const Partners& partners);

}  // namespace pinjaw::cell
