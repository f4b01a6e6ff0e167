#pragma once

#include "tests/bench/support/report.hpp"

/// What the bench measures, one function a subject. Each measures its peers in the same run.
namespace pinjaw::bench {

void measure_squeeze(Report& report);
void measure_planar(Report& report);
void measure_stand(Report& report);
void measure_plan(Report& report);

}  // namespace pinjaw::bench
