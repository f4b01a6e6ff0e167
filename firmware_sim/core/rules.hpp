#pragma once

#include <cstdint>

/// The rules that keep the part from being dropped (docs/reliability.md 2.5), by name, where the code keeps
/// them. Those that the state table keeps (R3, R9) have no name here: a mistaken table shows what they are
/// for.
namespace pinjaw::core {

enum class Rule : std::uint8_t {
  LatchBeforeTake,      ///< R1
  TakeOnStableHold,     ///< R2
  CompareToken,         ///< R4
  ComparePair,          ///< R4
  CompareNodes,         ///< R4
  RetainOnGoodHold,     ///< R5
  DecisionBeforeOpen,   ///< R6
  NewTokenEachOffer,    ///< R7
  RefuseOldToken,       ///< R8
  SoleRefusesOpen,      ///< R9, beside the table
  AnnounceOldOutcomes,  ///< R10
};

#ifdef PINJAW_SEEDED_MISTAKES
/// In the model checker's build of the core: whether the rule is kept. The checker defines it.
bool keeps(Rule rule);
#else
/// Every rule is kept.
constexpr bool keeps(Rule) {
  return true;
}
#endif

}  // namespace pinjaw::core
