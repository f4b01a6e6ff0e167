#include "host/cell/join.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/host/cell/synthetic.hpp"

namespace pinjaw::cell {
namespace {

using testing::arm;
using testing::joined;
using testing::Joined;
using testing::pallet;
using testing::pedestal;
using testing::random_station;
using testing::TestCell;
using testing::tried;
using testing::Tried;

constexpr std::size_t kAll = 1000000;

/// Arm between pallet and pedestal.
TestCell star(std::uint64_t seed, std::size_t designs) {
  base::Random random(seed);
  TestCell cell;
  for (const auto& kind : {arm(), pedestal(), pallet()}) {
    cell.stations.push_back(random_station(random, kind, designs));
  }
  cell.handoffs = {{2, 0}, {0, 1}};
  return cell;
}

/// Pallet, arm, pedestal, second arm that may also slide.
TestCell chain(std::uint64_t seed, std::size_t designs) {
  base::Random random(seed);
  testing::StationKind last = arm();
  last.name = "second arm";
  last.adjust.x_mm = last.adjust.y_mm = {-12, 12};
  TestCell cell;
  for (const auto& kind : {pallet(), arm(), pedestal(), last}) {
    cell.stations.push_back(random_station(random, kind, designs));
  }
  cell.handoffs = {{0, 1}, {1, 2}, {2, 3}};
  return cell;
}

std::vector<Tried::Combination> combinations(const JoinResult& result) {
  std::vector<Tried::Combination> list;
  for (const Choice& choice : result.best) {
    list.push_back({choice.score_n, {}});
    for (const Partner& partner : choice.stations) list.back().designs.push_back(partner.design);
  }
  return list;
}

TEST(Join, of_a_star_is_what_trying_everything_finds) {
  std::size_t found = 0;
  for (const std::uint64_t seed : {1U, 2U, 3U, 4U, 5U, 6U}) {
    const TestCell cell = star(seed, 14);
    const Joined answer = joined(cell, kAll);
    const Tried all = tried(cell, answer.references);
    EXPECT_EQ(answer.result.count, static_cast<std::int64_t>(all.combinations.size()));
    EXPECT_EQ(combinations(answer.result), all.combinations);
    found += all.combinations.size();
  }
  EXPECT_GT(found, 300U);
}

TEST(Join, of_a_chain_is_what_trying_everything_finds) {
  std::size_t found = 0;
  for (const std::uint64_t seed : {11U, 12U, 13U, 14U}) {
    const TestCell cell = chain(seed, 8);
    const Joined answer = joined(cell, kAll);
    const Tried all = tried(cell, answer.references);
    EXPECT_EQ(answer.result.count, static_cast<std::int64_t>(all.combinations.size()));
    EXPECT_EQ(combinations(answer.result), all.combinations);
    found += all.combinations.size();
  }
  EXPECT_GT(found, 100U);
}

TEST(Join, of_two_stations_counts_its_pairs) {
  for (const std::uint64_t seed : {21U, 22U, 23U}) {
    TestCell cell = star(seed, 30);
    cell.stations.pop_back();
    cell.handoffs = {{0, 1}};
    const Joined answer = joined(cell, kAll);
    EXPECT_EQ(answer.result.count,
              static_cast<std::int64_t>(tried(cell, answer.references).combinations.size()));
    EXPECT_EQ(answer.pairs, std::vector{answer.result.count});
    EXPECT_GT(answer.result.count, 0);
    EXPECT_LT(answer.result.count, 900);
  }
}

TEST(Join, lists_the_first_of_all_combinations) {
  const TestCell cell = star(31, 14);
  const auto all = combinations(joined(cell, kAll).result);
  ASSERT_GT(all.size(), 40U);
  for (const std::size_t top : {1U, 2U, 7U, 40U}) {
    const JoinResult result = joined(cell, top).result;
    EXPECT_EQ(combinations(result), std::vector(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(top)));
    EXPECT_EQ(result.count, static_cast<std::int64_t>(all.size())) << "whatever is kept, all are counted";
  }
  EXPECT_TRUE(joined(cell, 0).result.best.empty());
}

TEST(Join, of_stations_without_designs_is_empty) {
  TestCell cell = star(41, 6);
  cell.stations[1].designs.clear();
  const JoinResult result = joined(cell, kAll).result;
  EXPECT_EQ(result.count, 0);
  EXPECT_TRUE(result.best.empty());
}

TEST(JoinLaws, who_gives_and_who_receives_changes_nothing) {
  for (const TestCell& cell : {star(51, 14), chain(52, 8)}) {
    TestCell swapped = cell;
    for (StationPair& pair : swapped.handoffs) std::swap(pair.giver, pair.receiver);
    const Joined one = joined(cell, kAll);
    const Joined other = joined(swapped, kAll);
    EXPECT_EQ(one.pairs, other.pairs);
    EXPECT_EQ(combinations(one.result), combinations(other.result));
  }
}

TEST(JoinLaws, the_order_in_which_a_cell_lists_its_stations_changes_no_count) {
  const TestCell cell = star(53, 14);
  TestCell turned = cell;
  std::rotate(turned.stations.begin(), turned.stations.begin() + 1, turned.stations.end());
  for (StationPair& pair : turned.handoffs) pair = {(pair.giver + 2) % 3, (pair.receiver + 2) % 3};
  const Joined one = joined(cell, 0);
  const Joined other = joined(turned, 0);
  EXPECT_EQ(one.pairs, other.pairs);
  EXPECT_EQ(one.result.count, other.result.count);

  TestCell two = cell;
  two.stations.pop_back();
  two.handoffs = {{0, 1}};
  TestCell reversed = two;
  std::swap(reversed.stations[0], reversed.stations[1]);
  EXPECT_EQ(joined(two, 0).pairs, joined(reversed, 0).pairs);
}

TEST(JoinLaws, turning_and_moving_everything_changes_nothing) {
  for (const TestCell& cell : {star(54, 14), chain(55, 8)}) {
    TestCell elsewhere = cell;
    for (testing::TestStation& station : elsewhere.stations) {
      testing::move_part_frame(station, {0.83, {41, -17}});
    }
    const Joined one = joined(cell, kAll);
    const Joined other = joined(elsewhere, kAll);
    EXPECT_EQ(one.pairs, other.pairs);
    EXPECT_EQ(combinations(one.result), combinations(other.result));
  }
}

TEST(JoinLaws, a_station_that_may_move_further_loses_nothing) {
  TestCell cell = star(56, 14);
  const Joined one = joined(cell, 0);
  cell.stations[1].station.adjust.x_mm = {-15, 12};
  cell.stations[2].station.adjust.y_mm = {-30, 30};
  const Joined wider = joined(cell, 0);
  EXPECT_GE(wider.result.count, one.result.count);
  EXPECT_GT(wider.result.count, 0);
}

}  // namespace
}  // namespace pinjaw::cell
