#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "protocol/wire/messages.hpp"

/// The network as the search sees it: the set of frames that were ever said. Any of them may come to anybody
/// at any time, again and again, or never: that is loss, duplication, reordering and unbounded delay in one.
namespace pinjaw::core::model {

/// A set of said frames; bit i is Network::at(i).
using Said = std::uint64_t;

/// A frame that may change what another node does: a custody fact of a handoff, or the STATE of a receiver
/// that holds well. Every other frame is the same as none: a receiver forgets its sender's last one.
struct Saying {
  std::uint8_t node = 0;
  bool holds_well = false;  ///< the STATE; else `custody`
  wire::Custody custody{};
  wire::NodeState state{};
};

class Network {
 public:
  /// The bit of a custody frame; nothing where it changes nobody.
  std::optional<int> heard(std::uint8_t node, const wire::Custody& custody);
  std::optional<int> heard(std::uint8_t node, const wire::NodeState& state);

  [[nodiscard]] const Saying& at(int bit) const { return sayings_[static_cast<std::size_t>(bit)]; }
  /// Calls `visit(message, peer_holds, needed)` for each custody frame of `said` that may come to `node`, and
  /// once more where its sender's STATE, also of `said`, may come with it; `needed` are the frames. Ends
  /// where it gives false.
  template <class Visit>
  bool each_arrival(std::uint8_t node, Said said, Visit visit) const {
    for (Said rest = said & facts_for_[node]; rest != 0; rest &= rest - 1) {
      const int message = std::countr_zero(rest);
      const Said fact = Said{1} << message;
      if (!visit(message, false, fact)) return false;
      const Said state = holding_state_of(at(message).node) & said;
      if (state != 0 && !visit(message, true, fact | state)) return false;
    }
    return true;
  }
  /// The STATE of `node` that says it holds well; 0 where it never said so.
  [[nodiscard]] Said holding_state_of(std::uint8_t node) const { return holding_[node]; }
  /// RELEASED of `token` by `giver` to `receiver`; 0 where it was never said.
  [[nodiscard]] Said released(std::uint8_t giver, std::uint8_t receiver, std::uint16_t token) const;
  /// Every TAKE.
  [[nodiscard]] Said takes() const { return takes_; }
  [[nodiscard]] std::string name(int bit) const;

 private:
  int add(const Saying& saying);

  std::vector<Saying> sayings_;
  std::array<Said, 16> facts_for_{};
  std::array<Said, 16> holding_{};
  Said takes_ = 0;
};

}  // namespace pinjaw::core::model
