#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "tests/firmware_sim/model_check/network.hpp"

namespace pinjaw::core::model {

/// All nodes, a number of their automata's states each, and what the network knows: 16 bytes.
struct Global {
  std::uint64_t nodes = 0;  ///< 21 bits a node
  Said said = 0;

  static constexpr unsigned kBits = 21;
  [[nodiscard]] std::uint32_t node(std::size_t index) const {
    return static_cast<std::uint32_t>(nodes >> (kBits * index)) & ((1U << kBits) - 1U);
  }
  [[nodiscard]] Global with(std::size_t index, std::uint32_t id) const {
    const std::uint64_t mask = ((std::uint64_t{1} << kBits) - 1U) << (kBits * index);
    return {.nodes = (nodes & ~mask) | std::uint64_t{id} << (kBits * index), .said = said};
  }
  friend bool operator==(const Global&, const Global&) = default;
};

/// The visited states in the order in which they were found, and a set of them: whole states are compared, so
/// that none is taken for another.
class StateSet {
 public:
  static constexpr std::uint32_t kNone = 0xFFFFFFFF;

  /// The state's number, and whether it is new.
  struct Place {
    std::uint32_t number = 0;
    bool is_new = false;
  };
  Place insert(const Global& state, std::uint32_t parent);
  /// kNone where it was never inserted.
  [[nodiscard]] std::uint32_t find(const Global& state) const;

  [[nodiscard]] const Global& at(std::uint32_t number) const { return states_[number]; }
  [[nodiscard]] std::uint32_t parent(std::uint32_t number) const { return parents_[number]; }
  [[nodiscard]] std::size_t size() const { return states_.size(); }
  [[nodiscard]] std::size_t bytes() const {
    return states_.capacity() * sizeof(Global) +
           (parents_.capacity() + table_.capacity()) * sizeof(std::uint32_t);
  }

 private:
  [[nodiscard]] std::size_t slot_of(const Global& state) const;
  void grow();

  std::vector<Global> states_;
  std::vector<std::uint32_t> parents_;
  std::vector<std::uint32_t> table_ = std::vector<std::uint32_t>(1U << 16, kNone);  ///< size a power of two
};

}  // namespace pinjaw::core::model
