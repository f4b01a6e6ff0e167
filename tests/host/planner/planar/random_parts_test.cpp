#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <string>

#include "tests/host/planner/planar/shapes.hpp"
#include "tests/host/planner/planar/slow/comparison.hpp"
#include "tests/host/planner/planar/slow/random_profiles.hpp"

// Built twice: a short run of ./dev test and a long one, which differ in the numbers that CMake gives.
namespace pinjaw::planner {
namespace {

class PlanarRandomParts : public testing::TestWithParam<slow::Family> {};

/// `family` made so many times, each with a kit of its own.
slow::Tally compare_family(const slow::Family& family, std::uint64_t seed, int parts) {
  slow::Tally tally;
  for (int i = 0; i < parts; ++i) {
    base::Random random(seed + static_cast<std::uint64_t>(i));
    const model::Kit kit = slow::random_kit(random);
    const model::Profile part = family.make(random, kit);
    const slow::Task task = slow::task_of(model::features_of(part), kit, &part);
    tally += slow::compare(
        task, all_fixtures(part, kit, Twins::Both, 1),
        std::string(family.name) + ", seed " + std::to_string(seed) + " + " + std::to_string(i));
  }
  return tally;
}

TEST_P(PlanarRandomParts, have_the_fixtures_that_a_slow_search_of_another_design_finds) {
  const slow::Tally tally = compare_family(GetParam(), PINJAW_SEED, PINJAW_PARTS_A_FAMILY);
  RecordProperty("fixtures", tally.fixtures);
  RecordProperty("borderlines", tally.borderlines);
  RecordProperty("overlooked", tally.overlooked);
  std::printf("%s: %d parts, %d fixtures, %d borderline, %d that the slow search overlooked\n",
              GetParam().name, tally.parts, tally.fixtures, tally.borderlines, tally.overlooked);
  for (const std::string& disagreement : tally.disagreements) ADD_FAILURE() << disagreement;
  EXPECT_GT(tally.fixtures, 15 * tally.parts);
  EXPECT_LE(tally.borderlines, 1 + tally.fixtures / 500);  // rounding decides next to nothing
  EXPECT_LE(tally.overlooked, 1 + tally.fixtures / 500);   // so that a gap of the planner's would be seen
}

INSTANTIATE_TEST_SUITE_P(Planar, PlanarRandomParts,
                         testing::ValuesIn(slow::families().begin(), slow::families().end()),
                         [](const auto& one) {
                           std::string name = one.param.name;
                           std::ranges::replace(name, ' ', '_');
                           return name;
                         });

}  // namespace
}  // namespace pinjaw::planner
