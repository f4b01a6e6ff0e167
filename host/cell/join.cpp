#include "host/cell/join.hpp"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <numeric>
#include <optional>
#include <queue>

#include "host/planner/interference/interference.hpp"

namespace pinjaw::cell {
namespace {

/// Smaller score first, then the designs' places.
bool precedes(const Choice& a, const Choice& b) {
  if (a.score_n != b.score_n) return a.score_n < b.score_n;
  return std::lexicographical_compare(a.stations.begin(), a.stations.end(), b.stations.begin(),
                                      b.stations.end(),
                                      [](const Partner& x, const Partner& y) { return x.design < y.design; });
}

/// Walks the tree of handoffs, one station after another. The part's place follows once both reference
/// stations have their designs; until then nothing is known to be out of reach.
class Walk {
 public:
  explicit Walk(const JoinInput& input)
      : stations(*input.stations),
        tree(*input.tree),
        partners(*input.partners),
        references(input.references),
        chosen(stations.size()) {
    known_after = std::max(place_of(references.theta), place_of(references.offset));
  }

 protected:
  /// How many links are walked when `station` has its design.
  [[nodiscard]] std::size_t place_of(std::size_t station) const {
    for (std::size_t i = 0; i < tree.links.size(); ++i) {
      if (tree.links[i].far == station) return i + 1;
    }
    return 0;
  }
  [[nodiscard]] const Setup& setup_of(std::size_t station, const Partner& partner) const {
    return stations[station].setup(partner.design, partner.stance);
  }
  [[nodiscard]] PartPlace part_place() const {
    const auto& [theta, offset] = references;
    return PartPlace(part_in_handoff_frame(setup_of(theta, chosen[theta]).hold, stations[theta].bounds,
                                           setup_of(offset, chosen[offset]).hold, stations[offset].bounds));
  }
  /// Whether the far station of `link` can hold the part at its place, in any stance that suits the handoff.
  [[nodiscard]] bool can_reach(std::size_t link, const Partner& partner, const PartPlace& place) const {
    const StationSetups& far = stations[tree.links[link].far];
    if (reaches(far.setup(partner.design, partner.stance).hold, far.bounds, place)) return true;
    return far.stances(partner.design) > 1 && least_moved(link, partner, place).has_value();
  }
  /// The first stance, hence the least moved, in which the far station of `link` holds the part at its place
  /// and does not clash with the near one.
  [[nodiscard]] std::optional<std::uint32_t> least_moved(std::size_t link, const Partner& partner,
                                                         const PartPlace& place) const {
    const auto& [near, far, handoff] = tree.links[link];
    const StationSetups& station = stations[far];
    const planner::FingerSet& other = setup_of(near, chosen[near]).fingers;
    for (std::uint32_t stance = 0; stance < station.stances(partner.design); ++stance) {
      const Setup& setup = station.setup(partner.design, stance);
      if (!reaches(setup.hold, station.bounds, place)) continue;
      if (stance == partner.stance || planner::compatible(other, setup.fingers)) return stance;
    }
    return std::nullopt;
  }
  /// Once the part's place is known: whether the stations chosen so far reach it.
  [[nodiscard]] bool chosen_reach(std::size_t links_walked, const PartPlace& place) const {
    const StationSetups& root = stations[tree.root];
    if (!reaches(setup_of(tree.root, chosen[tree.root]).hold, root.bounds, place)) return false;
    for (std::size_t i = 0; i < links_walked; ++i) {
      if (!can_reach(i, chosen[tree.links[i].far], place)) return false;
    }
    return true;
  }
  [[nodiscard]] const std::vector<Partner>& partners_at(std::size_t link) const {
    return partners[link][chosen[tree.links[link].near].design];
  }

  const std::vector<StationSetups>& stations;
  const HandoffTree& tree;
  const std::vector<Partners>& partners;
  References references;
  std::size_t known_after = 0;  ///< links to walk until the part's place is known
  std::vector<Partner> chosen;
};

class Counter : Walk {
 public:
  explicit Counter(const JoinInput& input) : Walk(input), leaves_(tree.links.size()) {}

  std::int64_t with_root(std::uint32_t design) {
    chosen[tree.root] = {design, 0};
    return until_known(0);
  }

 private:
  /// Partners at a link from the station that says where the part is to one beyond which there is none: only
  /// the part's turn is open.
  struct Leaf {
    std::optional<std::uint32_t> of;                    ///< design of the near station
    std::int64_t always = 0;                            ///< partners in reach however the part is turned
    std::vector<std::vector<const PlanHold*>> depends;  ///< of each other: its holds that may come into reach
  };

  const Leaf& leaf_at(std::size_t link) {
    Leaf& leaf = leaves_[link];
    const std::size_t near = tree.links[link].near;
    const std::size_t far = tree.links[link].far;
    if (leaf.of == chosen[near].design) return leaf;
    leaf = {chosen[near].design, 0, {}};
    const StationSetups& station = stations[far];
    const Setup& other = setup_of(near, chosen[near]);
    const auto turns = [&](const PlanHold& hold) {
      return turns_in_reach(hold, station.bounds, other.hold, stations[near].bounds);
    };
    for (const Partner& partner : partners_at(link)) {
      if (turns(setup_of(far, partner).hold) == TurnsInReach::All) {
        ++leaf.always;
        continue;
      }
      std::vector<const PlanHold*> holds;
      for (std::size_t stance = 0; stance < station.stances(partner.design); ++stance) {
        const Setup& setup = station.setup(partner.design, stance);
        if (turns(setup.hold) != TurnsInReach::None && planner::compatible(other.fingers, setup.fingers)) {
          holds.push_back(&setup.hold);
        }
      }
      if (!holds.empty()) leaf.depends.push_back(std::move(holds));
    }
    return leaf;
  }

  [[nodiscard]] std::int64_t in_reach(const Leaf& leaf, const PlanBounds& bounds,
                                      const PartPlace& place) const {
    return leaf.always + std::ranges::count_if(leaf.depends, [&](const auto& holds) {
             return std::ranges::any_of(holds,
                                        [&](const PlanHold* hold) { return reaches(*hold, bounds, place); });
           });
  }

  std::int64_t until_known(std::size_t link) {
    if (link == known_after) {
      const PartPlace place = part_place();
      if (!chosen_reach(link, place)) return 0;
      std::int64_t product = 1;
      for (std::size_t i = link; i < tree.links.size() && product > 0; ++i) {
        const bool hangs_on_chosen = place_of(tree.links[i].near) <= link;
        if (hangs_on_chosen) product *= below(i, place);
      }
      return product;
    }
    std::int64_t total = 0;
    for (const Partner& partner : partners_at(link)) {
      chosen[tree.links[link].far] = partner;
      total += until_known(link + 1);
    }
    return total;
  }

  /// Ways to choose the far station of `link` and all stations beyond it.
  std::int64_t below(std::size_t link, const PartPlace& place) {
    const std::size_t station = tree.links[link].far;
    const bool ends_here =
        std::ranges::none_of(tree.links, [&](const auto& other) { return other.near == station; });
    if (ends_here && tree.links[link].near == references.offset) {
      return in_reach(leaf_at(link), stations[station].bounds, place);
    }
    std::int64_t total = 0;
    for (const Partner& partner : partners_at(link)) {
      if (!can_reach(link, partner, place)) continue;
      if (ends_here) {
        ++total;
        continue;
      }
      chosen[station] = partner;
      std::int64_t product = 1;
      for (std::size_t i = link + 1; i < tree.links.size() && product > 0; ++i) {
        if (tree.links[i].near == station) product *= below(i, place);
      }
      total += product;
    }
    return total;
  }

  std::vector<Leaf> leaves_;
};

class BestFirst : Walk {
 public:
  BestFirst(const JoinInput& input, std::size_t top) : Walk(input), top_(top), best_(precedes) {}

  std::vector<Choice> take() {
    const StationSetups& root = stations[tree.root];
    for (std::uint32_t design = 0; design < root.size(); ++design) {
      const double score_n = root.required_n[design];
      if (hopeless(score_n)) break;
      chosen[tree.root] = {design, 0};
      choose(0, score_n);
    }
    std::vector<Choice> sorted;
    for (; !best_.empty(); best_.pop()) sorted.push_back(in_least_moved_stances(best_.top()));
    std::reverse(sorted.begin(), sorted.end());
    return sorted;
  }

 private:
  [[nodiscard]] Choice in_least_moved_stances(Choice choice) {
    chosen = choice.stations;
    const PartPlace place = part_place();
    for (std::size_t i = 0; i < tree.links.size(); ++i) {
      Partner& partner = choice.stations[tree.links[i].far];
      partner.stance = least_moved(i, partner, place).value_or(partner.stance);
    }
    return choice;
  }

  [[nodiscard]] bool hopeless(double score_n) const {
    return best_.size() == top_ && score_n > best_.top().score_n;
  }

  void choose(std::size_t link, double score_n) {
    if (link >= known_after && !chosen_reach(link, part_place())) return;
    if (link == tree.links.size()) {
      keep({chosen, score_n});
      return;
    }
    const StationSetups& station = stations[tree.links[link].far];
    for (const Partner& partner : partners_at(link)) {
      const double with_n = std::max(score_n, station.required_n[partner.design]);
      if (hopeless(with_n)) break;
      chosen[tree.links[link].far] = partner;
      choose(link + 1, with_n);
    }
  }

  void keep(const Choice& choice) {
    if (best_.size() == top_ && !precedes(choice, best_.top())) return;
    if (best_.size() == top_) best_.pop();
    best_.push(choice);
  }

  std::size_t top_;
  std::priority_queue<Choice, std::vector<Choice>, decltype(&precedes)> best_;  ///< the worst kept on top
};

}  // namespace

JoinResult join(const JoinInput& input, std::size_t top) {
  JoinResult result;
  const std::size_t roots = (*input.stations)[input.tree->root].size();
  std::vector<std::int64_t> counts(roots, 0);
  tbb::parallel_for(std::size_t{0}, roots, [&](std::size_t i) {
    counts[i] = Counter(input).with_root(static_cast<std::uint32_t>(i));
  });
  result.count = std::accumulate(counts.begin(), counts.end(), std::int64_t{0});
  if (top > 0 && result.count > 0) result.best = BestFirst(input, top).take();
  return result;
}

}  // namespace pinjaw::cell
