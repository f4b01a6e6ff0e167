// Promises: T-TABLE, R3, R6, R9.
#include "firmware_sim/core/state_table.hpp"

#include <gtest/gtest.h>

#include <initializer_list>
#include <vector>

#include "protocol/wire/names.hpp"

namespace pinjaw::core {
namespace {

struct Row {
  StateId state;
  Event event;
  StateId next;
};

using enum wire::State;

/// docs/reliability.md, table 2.6, row by row: every change of state there is, and no other.
const std::vector<Row>& specified() {
  static const std::vector<Row> rows = {
      {Boot, Event::BootLoaded, Loaded},
      {Boot, Event::BootBare, Unconfigured},
      {Boot, Event::BootHeld, Recover},
      {Boot, Event::BootBad, FaultHold},
      {Boot, Event::StoreFault, FaultHold},
      {Recover, Event::RecordOffered, Resqueeze},
      {Recover, Event::RecordLatched, Taken},
      {Recover, Event::RecordDecided, Opening},
      {Recover, Event::RecordSole, Hold},
      {Recover, Event::RecordNone, FaultHold},
      {Unconfigured, Event::CmdCommit, Loaded},
      {Loaded, Event::CmdArmReady, Ready},
      {Ready, Event::CmdAccept, Seating},
      {Ready, Event::CmdCloseLight, Seating},
      {Ready, Event::HostLost, Loaded},
      {Ready, Event::CmdDisarm, Loaded},
      {Ready, Event::CmdWrite, Loaded},
      {Ready, Event::SensorFault, FaultEmpty},
      {Ready, Event::StoreFault, FaultEmpty},
      {Seating, Event::Contact, Seated},
      {Seating, Event::NoPart, FaultEmpty},
      {Seating, Event::Misseated, FaultEmpty},
      {Seating, Event::SensorFault, FaultEmpty},
      {Seating, Event::StoreFault, FaultEmpty},
      {Seating, Event::CmdAbort, Ready},
      {Seated, Event::CmdSqueeze, Squeezing},
      {Seated, Event::CmdAbort, Ready},
      {Seated, Event::SensorFault, FaultEmpty},
      {Seated, Event::StoreFault, FaultEmpty},
      {Squeezing, Event::HoldStableForPeer, Taken},
      {Squeezing, Event::HoldStableForOperator, Hold},
      {Squeezing, Event::OverForce, Seated},
      {Squeezing, Event::SqueezeTimeout, Seated},
      {Squeezing, Event::Slip, Seated},
      {Squeezing, Event::HostLost, Seated},
      {Squeezing, Event::CmdHold, Seated},
      {Squeezing, Event::SensorFault, FaultEmpty},
      {Squeezing, Event::StoreFault, FaultEmpty},
      {Taken, Event::PeerReleased, Hold},
      {Taken, Event::PeerRetained, Seated},
      {Hold, Event::CmdOffer, Offered},
      {Hold, Event::CmdManualRelease, Opening},
      {Hold, Event::SensorFault, FaultHold},
      {Hold, Event::StoreFault, FaultHold},
      {Offered, Event::PeerHolds, Relax},
      {Offered, Event::CmdAbort, Hold},
      {Offered, Event::CmdHold, Hold},
      {Offered, Event::OfferUnanswered, Hold},
      {Offered, Event::HoldLost, Hold},
      {Offered, Event::OverForce, Hold},
      {Offered, Event::Slip, Hold},
      {Offered, Event::SensorFault, Hold},
      {Offered, Event::StoreFault, Hold},
      {Relax, Event::PeerWatched, Opening},
      {Relax, Event::PeerDoubted, Resqueeze},
      {Relax, Event::Slip, Resqueeze},
      {Relax, Event::CmdAbort, Resqueeze},
      {Relax, Event::CmdHold, Resqueeze},
      {Relax, Event::SensorFault, Resqueeze},
      {Relax, Event::StoreFault, Resqueeze},
      {Resqueeze, Event::HoldRestored, Hold},
      {Opening, Event::Opened, Ready},
      {Opening, Event::OpenTimeout, FaultEmpty},
      {Opening, Event::StoreFault, FaultHold},
      {FaultHold, Event::CmdClearFault, Recover},
      {FaultHold, Event::CmdClearEmpty, Loaded},
      {FaultHold, Event::CmdAbort, Ready},
      {FaultEmpty, Event::CmdClearEmpty, Loaded},
      {FaultEmpty, Event::CmdAbort, Ready},
  };
  return rows;
}

constexpr std::uint32_t only(std::initializer_list<StateId> states) {
  std::uint32_t bits = 0;
  for (const StateId state : states) bits |= 1U << static_cast<unsigned>(state);
  return bits;
}

constexpr std::uint32_t all_but(std::initializer_list<StateId> states) {
  return ~only(states) & ((1U << kStates) - 1);
}

/// The states that heed an event and stay what they are: a bit for each.
std::uint32_t heeding(Event event) {
  switch (event) {
    case Event::CmdHold:
      return all_but({Squeezing, Offered, Relax});
    case Event::CmdWrite:
    case Event::CmdDisarm:
      return only({Unconfigured, Loaded});
    case Event::CmdCommit:
      return only({Loaded});
    case Event::CmdArm:
      return all_but({Boot, Unconfigured});
    case Event::CmdArmReady:
      return all_but({Boot, Unconfigured, Loaded});
    case Event::CmdAbort:
      return only({Ready});
    case Event::CmdOpenEmpty:
      return only({Ready, FaultEmpty});
    case Event::CmdClearFault:
      return all_but({Boot, FaultHold, FaultEmpty});
    case Event::CmdManualAsk:
      return only({Hold});
    case Event::OverForce:
      return only({Seating, Seated, Taken, Hold, Relax, Resqueeze});
    case Event::Slip:
    case Event::HoldLost:
      return only({Taken, Hold});
    case Event::Opened:
      return only({FaultEmpty});
    case Event::SensorFault:
      return only({Recover, Unconfigured, Loaded, Taken, Resqueeze, Opening, FaultHold, FaultEmpty});
    case Event::StoreFault:
      return only({Recover, Unconfigured, Loaded, Taken, Resqueeze, FaultHold, FaultEmpty});
    case Event::HostLost:
      return all_but({Boot, Ready, Squeezing});
    case Event::PeerLost:
      return only({Seating, Seated, Squeezing, Taken, Offered});
    case Event::PeerSilent:
      return only({Taken});
    default:
      return 0;
  }
}

const Row* find(StateId state, Event event) {
  for (const Row& row : specified()) {
    if (row.state == state && row.event == event) return &row;
  }
  return nullptr;
}

template <class Visit>
void for_every_pair(Visit visit) {
  for (std::size_t s = 0; s < kStates; ++s) {
    for (std::size_t e = 0; e < kEvents; ++e) visit(static_cast<StateId>(s), static_cast<Event>(e));
  }
}

TEST(StateTable, has_every_row_of_the_specification) {
  for (const Row& row : specified()) {
    const Reaction what = reaction(kStateTable, row.state, row.event);
    EXPECT_EQ(what.kind, ReactionKind::Go)
        << wire::to_string(row.state) << " " << static_cast<int>(row.event);
    EXPECT_EQ(what.next, row.next) << wire::to_string(row.state) << " " << static_cast<int>(row.event);
  }
}

TEST(StateTable, changes_state_for_nothing_else) {
  for_every_pair([](StateId state, Event event) {
    const bool goes = reaction(kStateTable, state, event).kind == ReactionKind::Go;
    EXPECT_EQ(goes, find(state, event) != nullptr)
        << wire::to_string(state) << " by event " << static_cast<int>(event);
  });
}

TEST(StateTable, refuses_every_command_that_is_not_listed) {
  for_every_pair([](StateId state, Event event) {
    const ReactionKind kind = reaction(kStateTable, state, event).kind;
    if (is_command(event)) {
      EXPECT_NE(kind, ReactionKind::Ignored) << wire::to_string(state) << " " << static_cast<int>(event);
    } else {
      EXPECT_NE(kind, ReactionKind::Refused) << wire::to_string(state) << " " << static_cast<int>(event);
    }
  });
}

TEST(StateTable, heeds_without_a_change_of_state_what_is_listed_and_nothing_else) {
  for_every_pair([](StateId state, Event event) {
    const Reaction what = reaction(kStateTable, state, event);
    EXPECT_EQ(what.kind == ReactionKind::Stay, (heeding(event) & only({state})) != 0)
        << wire::to_string(state) << " " << static_cast<int>(event);
    if (what.kind != ReactionKind::Go) {
      EXPECT_EQ(what.next, state) << wire::to_string(state) << " " << static_cast<int>(event);
    }
  });
}

TEST(StateTable, leads_from_boot_to_every_state) {
  std::vector<bool> reached(kStates, false);
  reached[0] = true;
  for (std::size_t round = 0; round < kStates; ++round) {
    for (const Row& row : specified()) {
      if (reached[static_cast<std::size_t>(row.state)]) reached[static_cast<std::size_t>(row.next)] = true;
    }
  }
  for (std::size_t s = 0; s < kStates; ++s)
    EXPECT_TRUE(reached[s]) << wire::to_string(static_cast<StateId>(s));
}

}  // namespace
}  // namespace pinjaw::core
