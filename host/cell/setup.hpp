#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "host/cell/hold.hpp"
#include "host/model/cell.hpp"
#include "host/model/design.hpp"
#include "host/planner/interference/fingers.hpp"

namespace pinjaw::cell {

/// One stance of one design: where the gripper is about the part, and its fingers.
struct Setup {
  planner::Stance stance;
  PlanHold hold;
  planner::FingerSet fingers;
};

/// All designs of one station with the stances that the join may use; designs by their squeeze, least first.
struct StationSetups {
  std::string name;
  bool grips = true;
  model::Side side = model::Side::Below;
  PlanBounds bounds;
  std::vector<double> required_n;    ///< of each design; 0 for a pallet
  std::vector<Setup> setups;         ///< design by design
  std::vector<std::uint32_t> first;  ///< of each design, and one past the last
  std::vector<std::uint32_t>
      opens_least;  ///< of each design: the stance whose jaws travel least when they open
  [[nodiscard]] std::size_t size() const { return required_n.size(); }
  [[nodiscard]] std::size_t stances(std::size_t index) const { return first[index + 1] - first[index]; }
  /// The `stance`-th setup of design `index`; 0 is the design as it stands.
  [[nodiscard]] const Setup& setup(std::size_t index, std::size_t stance) const {
    return setups[first[index] + stance];
  }
};

/// Which stances of a design take part.
enum class Stances {
  OwnOnly,  ///< the design as it stands: a station of several handoffs, which keeps it in all of them, and
            ///< the one whose offset says where the part is
  All,      ///< shifted by rows and columns as well: any other station
};

/// `designs`: smallest required squeeze first; `part_low_mm`: lowest z of the part turned by the station's
/// side.
StationSetups setups_of(const model::Station& station, const std::vector<model::Design>& designs,
                        double part_low_mm, Stances stances);

}  // namespace pinjaw::cell
