#pragma once

#include <array>
#include <string_view>

#include "host/planner/interference/fingers.hpp"

namespace pinjaw::planner {

/// The checks of a handoff (BB 3.6; DESIGN 3 phase 6, 3.1 nos 9 and 12), in the order they are made.
enum class HandoffCheck {
  None,           ///< compatible: no check failed
  Floor,          ///< a pin from above reaches the plane that the part rests on
  BothClosed,     ///< both grippers hold the part
  GiverMoves,     ///< the giver opens while the receiver holds; or closes, when it takes the part back
  ReceiverMoves,  ///< the receiver closes, or opens, while the giver holds
  GiverLeaves,    ///< the open giver goes away along z; or comes
  ReceiverComes,  ///< the open receiver comes along z; or goes away
};
inline constexpr std::array kHandoffChecks{HandoffCheck::Floor,       HandoffCheck::BothClosed,
                                           HandoffCheck::GiverMoves,  HandoffCheck::ReceiverMoves,
                                           HandoffCheck::GiverLeaves, HandoffCheck::ReceiverComes};
/// The name in reports: `both_closed`.
std::string_view to_string(HandoffCheck check);

enum class FingerKind { Pin, Plate, Floor };

/// A finger of one gripper: which pin (index in its design) or plate (0 left, 1 right).
struct FingerName {
  FingerKind kind = FingerKind::Pin;
  int index = 0;
  friend bool operator==(const FingerName&, const FingerName&) = default;
};

/// Whether two designs can hand the part over, and if not the first clash that was found.
struct HandoffVerdict {
  HandoffCheck failed = HandoffCheck::None;
  FingerName giver;  ///< meaningless where compatible
  FingerName receiver;
  [[nodiscard]] bool compatible() const { return failed == HandoffCheck::None; }
};

/// Checks a handoff. Two fingers clash where their plan distance is under the sum of their radii plus the
/// larger clearance of the two kits and their z ranges overlap: a broad phase on z ranges and plan distances,
/// then libccd; what libccd cannot decide counts as a clash. Two designs are compatible whichever of them
/// gives.
HandoffVerdict check_handoff(const FingerSet& giver, const FingerSet& receiver);

/// Whether a pin of one reaches the floor on which the part of the other rests: what no stance changes.
bool reaches_floor(const FingerSet& giver, const FingerSet& receiver);

/// The same answer as check_handoff(...).compatible(), without finding out which check failed first.
bool compatible(const FingerSet& giver, const FingerSet& receiver);

}  // namespace pinjaw::planner
