#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <type_traits>

#include "firmware_sim/core/state.hpp"
#include "tests/firmware_sim/model_check/jaw.hpp"
#include "tests/firmware_sim/model_check/layouts.hpp"

/// One node with its memory and jaws, as the search keeps it.
///
/// One visitor names what of it decides; it packs and unpacks. What it does not name is a template's after
/// each step, so that the space is finite: counters, sessions' numbers, send times, filters, the control
/// law's memory. Timers are not named, as any of them may run out at any step; nor is what was heard of hosts
/// and peers, as any frame ever said may be heard again in the same step.
namespace pinjaw::core::model {

struct Local {
  State core;
  NvmRecord stored;                    ///< what a power cut leaves
  std::array<NvmRecord, 2> pending{};  ///< on its way to memory, and the next
  std::uint8_t pending_count = 0;
  Grip grip = Grip::Open;
  Pull pull = Pull::Stay;
};

/// Names of `record` all but what only counts: boots and sessions.
template <class Visit>
void visit_record(NvmRecord& record, Visit& visit) {
  visit(record.custody);
  visit(record.peer);
  visit(record.token);
  visit(record.pair);
  visit(record.handoff_number);
  visit(record.force_set_dn);
  visit(record.permit_dn);
  visit(record.seen_givers);
  for (std::size_t giver = 1; giver <= kMostNodes; ++giver) visit(record.last_token[giver]);
  for (Outcome& outcome : record.outcomes) {
    visit(outcome.retained);
    visit(outcome.peer);
    visit(outcome.token);
    visit(outcome.pair);
  }
}

/// The faults for which a node must hold, a bit for each; the others decide nothing.
std::uint32_t held_faults(const Faults& faults);
Faults with_held_faults(std::uint32_t bits);

template <class Visit>
void visit_core(State& core, Visit& visit) {
  visit(core.id);
  visit_record(core.store.record, visit);
  visit(core.store.record_waits);
  visit(core.announced.fact);
  visit(core.announced.peer);
  visit(core.announced.token);
  visit(core.announced.pair);
  visit(core.receiving.giver);
  visit(core.receiving.token);
  visit(core.receiving.pair);
  visit(core.receiving.retained);
  visit(core.permit_dn);
  visit(core.force_set_dn);
  visit(core.reference_10um);
  visit(core.frozen);
  visit(core.opening_wanted);
  visit(core.hold_proven);
  visit(core.answer_seen);
  visit(core.release_guard.peer);
  visit(core.release_guard.token);
  visit(core.release_guard.peer_permits);
  visit(core.release_guard.decided_before);
  std::uint32_t faults = held_faults(core.faults);
  visit(faults);
  bool armed = core.gate.armed();
  visit(armed);
  if constexpr (Visit::kUnpacks) {
    core.faults = with_held_faults(faults);
    if (!armed) core.gate.close();
  }
}

template <class Visit>
void visit_local(Local& local, Visit& visit) {
  visit_core(local.core, visit);
  visit_record(local.stored, visit);
  visit(local.pending_count);
  for (std::size_t i = 0; i < local.pending_count; ++i) visit_record(local.pending[i], visit);
  visit(local.grip);
  visit(local.pull);
}

/// A node as bytes; equal nodes have equal bytes.
using Packed = std::string;

Packed pack(Local& local);

/// `packed` put onto a copy of `base`.
Local unpack(const Packed& packed, const Local& base);

}  // namespace pinjaw::core::model
