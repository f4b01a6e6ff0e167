// What the search is worth: the core with one rule left out, or one cell of its state table set wrongly, must
// be found out, and by the invariant that the rule is for. The second channel before the opening valve is
// off, so that each rule is caught by itself; the nightly set tells which drops that channel prevents alone.
//
// Promises: R1, R2, R3, R4, R5, R6, R7, R8, R9, R10, T-GUARD.
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "firmware_sim/core/rules.hpp"
#include "tests/firmware_sim/model_check/report.hpp"
#include "tests/firmware_sim/model_check/search.hpp"

namespace pinjaw::core {
namespace {
std::vector<Rule> broken_rules;  // of the mistake under test; the core asks
}

bool keeps(Rule rule) {
  return std::ranges::find(broken_rules, rule) == broken_rules.end();
}

namespace model {
namespace {

struct Misprint {
  Event event{};
  StateId state{};
  core::Cell cell{};
};

struct Mistake {
  std::string name;
  Invariant violates{};
  std::vector<Rule> rules{};
  std::vector<Misprint> misprints{};
  Scenario scenario{};
};

/// TAKE of `token` by `node` to `giver`, and its STATE, from a handoff long over.
std::vector<Saying> old_take(std::uint8_t node, std::uint8_t giver, std::uint16_t token) {
  const std::vector<std::uint8_t> nodes{kArm, kPedestal, kPallet};
  const std::uint16_t pair = layout_of(node, nodes).peer(giver)->pair_crc;
  return {{.node = node,
           .custody = {.fact = wire::Fact::Take, .peer = giver, .token = token, .pair = pair, .f_low_n = 41}},
          {.node = node,
           .holds_well = true,
           .state = {.state = wire::State::Taken, .hold_stable = true, .f_low_dn = 417}}};
}

Scenario with_old_token() {
  Scenario scenario;
  scenario.history = old_take(kPedestal, kArm, 0);
  return scenario;
}

Scenario with_other_giver() {
  Scenario scenario;
  scenario.nodes = {kArm, kPallet};
  scenario.history = old_take(kPallet, kPedestal, 1);
  return scenario;
}

Scenario with_misfit() {
  Scenario scenario;
  scenario.misfit = kPedestal;
  return scenario;
}

/// Found in a second altogether.
std::vector<Mistake> quick_mistakes() {
  using enum wire::State;
  using enum Rule;
  using C = core::Cell;
  return {
      {"R1: TAKE before the latch is stored", kTakesLatched, {LatchBeforeTake}, {}, {}},
      {"R1: the same", kHeld, {LatchBeforeTake}, {}, {}},
      {"R2: TAKE before the hold is stable", kHeld, {TakeOnStableHold}, {}, with_old_token()},
      {"R3: a latched receiver opens after a time", kHeld, {}, {{Event::PeerSilent, Taken, C::Rd}}, {}},
      {"R3: a host aborts a latched receiver", kHeld, {}, {{Event::CmdAbort, Taken, C::Rd}}, {}},
      {"R3: a restart forgets the latch", kHeld, {}, {{Event::RecordLatched, Recover, C::Rd}}, {}},
      {"R3: sole without RELEASED", kOneCustodian, {}, {{Event::PeerSilent, Taken, C::Hd}}, {}},
      {"R4: the token is not compared", kHeld, {CompareToken}, {}, with_old_token()},
      {"R4: neither pair nor nodes are compared", kHeld, {ComparePair, CompareNodes}, {}, with_other_giver()},
      {"R4: the pair is not compared", kHeld, {ComparePair}, {}, with_misfit()},
      {"R5: RETAIN before the own hold is good", kHeld, {RetainOnGoodHold}, {}, {}},
      {"R6: opens before the decision is stored", kOpensDecided, {DecisionBeforeOpen}, {}, {}},
      {"R6: RETAIN after the decision", kHeld, {}, {{Event::CmdHold, Opening, C::Rs}}, {}},
      {"R7: a token is used again", kHeld, {NewTokenEachOffer}, {}, {}},
      {"R9: a sole holder opens on a host's word", kHeld, {}, {{Event::CmdDisarm, Hold, C::Op}}, {}},
  };
}

/// Only the end of a long way shows them, or the way back from everywhere.
std::vector<Mistake> slow_mistakes() {
  using enum wire::State;
  using C = core::Cell;
  return {
      {"R6: a restart takes the decision back", kWayBack, {}, {{Event::RecordDecided, Recover, C::Rs}}, {}},
      {"R8: an old token is accepted", kOneCustodian, {Rule::RefuseOldToken}, {}, {}},
      {"R10: earlier outcomes are not repeated", kWayBack, {Rule::AnnounceOldOutcomes}, {}, {}},
  };
}

Findings search_with(const Mistake& mistake, bool release_guard, bool merge_equals = false) {
  StateTable table = kStateTable;
  for (const Misprint& misprint : mistake.misprints)
    table[static_cast<std::size_t>(misprint.event)][static_cast<std::size_t>(misprint.state)] = misprint.cell;
  broken_rules = mistake.rules;
  Scenario scenario = mistake.scenario;
  scenario.table = &table;
  scenario.release_guard = release_guard;
  const Findings findings = search(scenario, {.invariants = mistake.violates, .merge_equals = merge_equals});
  broken_rules.clear();
  return findings;
}

void expect_found(const std::vector<Mistake>& mistakes) {
  for (const Mistake& mistake : mistakes) {
    const Findings findings = search_with(mistake, false);
    ASSERT_TRUE(findings.violation) << mistake.name << ": not found in " << findings.states << " states, "
                                    << (findings.complete ? "all there are" : "not all");
    EXPECT_EQ(findings.violation->invariant, mistake.violates) << trace_of(findings);
    const std::size_t colon = mistake.name.find(':');
    pinjaw::test::figure(
        mistake.name.substr(0, colon),
        "left out" + mistake.name.substr(colon) + "; found as a violation of " + name_of(mistake.violates),
        findings.states, "states");
  }
}

TEST(Mistakes, are_found_by_the_invariant_that_their_rule_is_for) {
  expect_found(quick_mistakes());
}

TEST(NightlyMistakes, are_found_where_only_a_long_way_shows_them) {
  expect_found(slow_mistakes());
}

TEST(NightlyMistakes, are_found_as_well_where_states_that_nobody_can_tell_apart_count_as_one) {
  for (const std::vector<Mistake>& mistakes : {quick_mistakes(), slow_mistakes()}) {
    for (std::size_t i = 0; i < mistakes.size(); i += 5) {
      const Findings findings = search_with(mistakes[i], false, true);
      ASSERT_TRUE(findings.violation) << mistakes[i].name;
      EXPECT_EQ(findings.violation->invariant, mistakes[i].violates) << trace_of(findings);
    }
  }
}

TEST(NightlyMistakes, none_is_found_in_the_core_as_it_is_though_the_second_channel_is_off) {
  for (const Scenario& scenario : {Scenario{}, with_old_token(), with_other_giver(), with_misfit()}) {
    const Findings findings = search_with({.name = "none", .violates = kHeld, .scenario = scenario}, false);
    EXPECT_FALSE(findings.violation) << trace_of(findings);
    EXPECT_TRUE(findings.complete);
  }
}

/// Those that leave the stored facts right, and so give the second channel what it judges by.
TEST(NightlyMistakes, second_channel_alone_keeps_the_part_gripped_where_the_first_would_drop_it) {
  int stopped = 0;
  for (Mistake& mistake : quick_mistakes()) {
    if (mistake.violates != kHeld) continue;
    mistake.violates = kGripped;
    const bool drops = search_with(mistake, false).violation.has_value();
    const bool still_drops = search_with(mistake, true).violation.has_value();
    EXPECT_TRUE(drops || !still_drops) << mistake.name;
    if (drops && !still_drops) ++stopped;
    pinjaw::test::figure("T-GUARD", mistake.name,
                         !drops        ? "no drop"
                         : still_drops ? "a drop"
                                       : "a drop, but for the second channel");
  }
  EXPECT_GE(stopped, 5);
}

}  // namespace
}  // namespace model
}  // namespace pinjaw::core
