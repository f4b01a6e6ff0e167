#pragma once

#include "tests/firmware_sim/core/bench.hpp"

namespace pinjaw::fuzz {

/// What must be true of a controller at every moment, whatever it hears.
void keeps_its_invariants(const core::test::Station& station);

}  // namespace pinjaw::fuzz
