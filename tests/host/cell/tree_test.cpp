#include <gtest/gtest.h>

#include <algorithm>

#include "host/cell/join.hpp"

namespace pinjaw::cell {
namespace {

bool each_is_reached_before_it_is_left(const HandoffTree& tree) {
  std::vector<std::size_t> reached{tree.root};
  for (const HandoffTree::Link& link : tree.links) {
    if (std::ranges::find(reached, link.near) == reached.end()) return false;
    if (std::ranges::find(reached, link.far) != reached.end()) return false;
    reached.push_back(link.far);
  }
  return true;
}

TEST(HandoffTree, of_one_station_has_no_link) {
  const TreeOutcome outcome = handoff_tree(1, {}, {});
  EXPECT_EQ(outcome.fault, TreeFault::None);
  EXPECT_TRUE(outcome.tree.links.empty());
}

TEST(HandoffTree, starts_at_the_station_of_most_handoffs) {
  const TreeOutcome outcome = handoff_tree(3, {{2, 0}, {0, 1}}, {1, 0});
  ASSERT_EQ(outcome.fault, TreeFault::None);
  EXPECT_EQ(outcome.tree.root, 0U);
  ASSERT_EQ(outcome.tree.links.size(), 2U);
  EXPECT_EQ(outcome.tree.links[0].far, 1U) << "asked for early";
  EXPECT_EQ(outcome.tree.links[0].handoff, 1U);
  EXPECT_EQ(outcome.tree.links[1].far, 2U);
}

TEST(HandoffTree, of_two_stations_starts_at_the_last_of_those_asked_for) {
  EXPECT_EQ(handoff_tree(2, {{0, 1}}, {0, 1}).tree.root, 1U);
  EXPECT_EQ(handoff_tree(2, {{1, 0}}, {1, 0}).tree.root, 0U);
}

TEST(HandoffTree, of_a_chain_reaches_each_station_before_it_leaves_it) {
  const std::vector<StationPair> chain{{0, 1}, {2, 1}, {2, 3}, {4, 3}};
  for (std::size_t early = 0; early < 5; ++early) {
    const TreeOutcome outcome = handoff_tree(5, chain, {early});
    ASSERT_EQ(outcome.fault, TreeFault::None);
    EXPECT_EQ(outcome.tree.links.size(), 4U);
    EXPECT_TRUE(each_is_reached_before_it_is_left(outcome.tree));
  }
}

TEST(HandoffTree, without_a_way_to_some_station_is_told) {
  EXPECT_EQ(handoff_tree(2, {}, {}).fault, TreeFault::NotConnected);
  EXPECT_EQ(handoff_tree(4, {{0, 1}, {2, 3}}, {}).fault, TreeFault::NotConnected);
}

TEST(HandoffTree, with_a_ring_or_a_handoff_twice_is_told) {
  EXPECT_EQ(handoff_tree(3, {{0, 1}, {1, 2}, {2, 0}}, {}).fault, TreeFault::Cycle);
  EXPECT_EQ(handoff_tree(2, {{0, 1}, {0, 1}}, {}).fault, TreeFault::Cycle);
  EXPECT_EQ(handoff_tree(2, {{0, 1}, {1, 0}}, {}).fault, TreeFault::Cycle);
}

}  // namespace
}  // namespace pinjaw::cell
