#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "host/geometry/region.hpp"

namespace pinjaw::geometry {

/// A tree of boxes, each over its children's (bounding volume hierarchy, split by the surface area
/// heuristic).
class Bvh {
 public:
  struct Node {
    Box box;
    std::int32_t first = 0;  ///< a leaf's first item; an inner node's first child, the second follows it
    std::int32_t count = 0;  ///< items of a leaf; 0 at an inner node
  };

  /// No path from the root is longer: beyond kHeuristicDepth nodes are split in halves.
  static constexpr int kHeuristicDepth = 40;
  static constexpr int kMaxDepth = kHeuristicDepth + 32;

  explicit Bvh(const std::vector<Box>& boxes);

  /// Root first; empty where there are no boxes.
  [[nodiscard]] const std::vector<Node>& nodes() const { return nodes_; }
  /// Positions of the boxes in the order that leaves refer to.
  [[nodiscard]] const std::vector<int>& order() const { return order_; }

  /// Visits leaves depth first. `skip(node)` leaves a subtree out; `first(a, b)` tells whether child a comes
  /// before b; `leaf(node)` returns true to stop.
  template <class Skip, class First, class Leaf>
  void walk(Skip&& skip, First&& first, Leaf&& leaf) const {
    if (nodes_.empty() || skip(nodes_.front())) return;
    std::array<std::int32_t, kMaxDepth + 2> stack{};
    std::size_t depth = 0;
    std::int32_t at = 0;
    while (true) {
      const Node& node = nodes_[static_cast<std::size_t>(at)];
      if (node.count > 0) {
        if (leaf(node)) return;
      } else {
        const Node& one = nodes_[static_cast<std::size_t>(node.first)];
        const Node& other = nodes_[static_cast<std::size_t>(node.first) + 1];
        const bool into_one = !skip(one);
        const bool into_other = !skip(other);
        if (into_one && into_other) {
          const bool in_order = first(one, other);
          stack[depth++] = node.first + (in_order ? 1 : 0);
          at = node.first + (in_order ? 0 : 1);
          continue;
        }
        if (into_one || into_other) {
          at = node.first + (into_one ? 0 : 1);
          continue;
        }
      }
      do {  // what was left for later may have fallen out meanwhile
        if (depth == 0) return;
        at = stack[--depth];
      } while (skip(nodes_[static_cast<std::size_t>(at)]));
    }
  }

 private:
  void split(const std::vector<Box>& boxes, std::int32_t index, int depth);

  std::vector<Node> nodes_;
  std::vector<int> order_;
};

}  // namespace pinjaw::geometry
