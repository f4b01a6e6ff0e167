#include <algorithm>

#include "host/cell/join.hpp"

namespace pinjaw::cell {
namespace {

/// Stations on the way from `root` to `station`, without the root; empty where there is no way.
std::vector<std::size_t> way(std::size_t root, std::size_t station, const std::vector<std::size_t>& parent) {
  std::vector<std::size_t> stations;
  for (std::size_t at = station; at != root; at = parent[at]) {
    stations.push_back(at);
    if (parent[at] == at) return {};
  }
  std::reverse(stations.begin(), stations.end());
  return stations;
}

/// Handoffs of each station.
std::vector<std::vector<std::size_t>> handoffs_at(std::size_t stations,
                                                  const std::vector<StationPair>& handoffs) {
  std::vector<std::vector<std::size_t>> at(stations);
  for (std::size_t i = 0; i < handoffs.size(); ++i) {
    at[handoffs[i].giver].push_back(i);
    at[handoffs[i].receiver].push_back(i);
  }
  return at;
}

std::size_t busiest(const std::vector<std::vector<std::size_t>>& at, const std::vector<std::size_t>& first) {
  const auto busier = [](const auto& a, const auto& b) { return a.size() < b.size(); };
  auto root = static_cast<std::size_t>(std::ranges::max_element(at, busier) - at.begin());
  for (const std::size_t station : first) {
    if (at[station].size() == at[root].size()) root = station;
  }
  return root;
}

}  // namespace

TreeOutcome handoff_tree(std::size_t stations, const std::vector<StationPair>& handoffs,
                         const std::vector<std::size_t>& first) {
  const auto at = handoffs_at(stations, handoffs);
  TreeOutcome outcome;
  outcome.tree.root = busiest(at, first);

  std::vector<std::size_t> parent(stations);
  std::vector<std::size_t> by(stations, handoffs.size());
  for (std::size_t i = 0; i < stations; ++i) parent[i] = i;
  std::vector<std::size_t> reached{outcome.tree.root};
  for (std::size_t i = 0; i < reached.size(); ++i) {
    for (const std::size_t handoff : at[reached[i]]) {
      const std::size_t other =
          handoffs[handoff].giver == reached[i] ? handoffs[handoff].receiver : handoffs[handoff].giver;
      if (other == outcome.tree.root || by[other] < handoffs.size()) continue;
      parent[other] = reached[i];
      by[other] = handoff;
      reached.push_back(other);
    }
  }
  if (reached.size() != stations) return {TreeFault::NotConnected, {}};
  if (handoffs.size() != stations - 1) return {TreeFault::Cycle, {}};

  std::vector<std::size_t> order;
  const auto visit = [&](std::size_t station) {
    for (const std::size_t step : way(outcome.tree.root, station, parent)) {
      if (std::ranges::find(order, step) == order.end()) order.push_back(step);
    }
  };
  for (const std::size_t station : first) visit(station);
  for (const std::size_t station : reached) visit(station);
  for (const std::size_t station : order)
    outcome.tree.links.push_back({parent[station], station, by[station]});
  return outcome;
}

}  // namespace pinjaw::cell
