#include "firmware_sim/core/custody.hpp"

#include "firmware_sim/core/guards.hpp"
#include "firmware_sim/core/rules.hpp"

namespace pinjaw::core {

NvmRecord& to_store(Store& store) {
  store.record_waits = true;
  return store.record;
}

void acknowledge(Store& store, const NvmStatus& status) {
  store.done = status.done;
  store.failed = status.failed && status.done != store.requested;
}

void flush(Store& store, const wire::Layout& committed, std::optional<NvmWrite>& write) {
  if (!store.record_waits && !store.layout_waits) return write.reset();
  write.emplace().sequence = ++store.requested;
  if (store.record_waits) write->record = store.record;
  if (store.layout_waits) {
    LayoutBlob& blob = write->layout.emplace();
    wire::ByteWriter out(blob.bytes);
    wire::encode(committed, out);
    blob.size = static_cast<std::uint16_t>(out.used());
  }
  store.record_waits = false;
  store.layout_waits = false;
}

void announce(State& state) {
  const NvmRecord& record = state.store.record;
  if (!state.store.readable) return;  // whatever the record was, it is not known
  if ((record.custody != Custody::Latched || keeps(Rule::LatchBeforeTake)) && !state.store.durable()) return;
  const auto say = [&](wire::Fact fact) {
    state.announced = {.fact = fact, .peer = record.peer, .token = record.token, .pair = record.pair};
  };
  switch (record.custody) {
    case Custody::Empty:
      state.announced = {.fact = wire::Fact::Empty};
      return;
    case Custody::Sole:
      return say(wire::Fact::Sole);
    case Custody::Offered:
      if (state.id == StateId::Offered || state.id == StateId::Relax) say(wire::Fact::Offer);
      return;
    case Custody::Latched:
      if (state.hold_proven || !keeps(Rule::TakeOnStableHold)) say(wire::Fact::Take);
      return;
    case Custody::Released:
      return say(wire::Fact::Released);
    case Custody::Retained:
      if (state.announced.fact != wire::Fact::Retain && !holds_enough(state) && keeps(Rule::RetainOnGoodHold))
        return;
      return say(wire::Fact::Retain);
    default:  // Decided: nothing new is true until the jaws are open
      return;
  }
}

bool token_is_new(const NvmRecord& record, std::uint8_t giver, std::uint16_t token) {
  if (giver >= record.last_token.size()) return false;
  if (((record.seen_givers >> giver) & 1U) == 0 || !keeps(Rule::RefuseOldToken)) return true;
  const auto ahead = static_cast<std::uint16_t>(token - record.last_token[giver]);
  return ahead != 0 && ahead < 0x8000;
}

void remember_token(NvmRecord& record, std::uint8_t giver, std::uint16_t token) {
  if (giver >= record.last_token.size()) return;
  record.last_token[giver] = token;
  record.seen_givers = static_cast<std::uint16_t>(record.seen_givers | (1U << giver));
}

}  // namespace pinjaw::core
