// Promises: SIM.
#include <gtest/gtest.h>

#include <ctime>

#include "tests/firmware_sim/support/test_cell.hpp"

namespace pinjaw::world {
namespace {

double cpu_s() {
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

TEST(World, three_nodes_are_simulated_at_least_five_times_faster_than_life) {
#if defined(__SANITIZE_ADDRESS__) || !defined(__OPTIMIZE__)
  constexpr double kFactor = 0.5;  // checks cost a factor of ten
#else
  constexpr double kFactor = 5;
#endif
  test::TestCell cell(test::arm_pedestal_pallet());
  const double before_s = cpu_s();
  cell.run_ms(2000);
  EXPECT_GT(2.0 / (cpu_s() - before_s), kFactor);
}

}  // namespace
}  // namespace pinjaw::world
