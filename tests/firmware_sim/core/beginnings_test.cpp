// Promises: I3, I7.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "firmware_sim/core/commands.hpp"
#include "firmware_sim/core/record.hpp"
#include "tests/firmware_sim/core/made_state.hpp"

/// What a controller begins with: nothing heard, nothing held, nothing wanted.
namespace pinjaw::core::test {
namespace {

constexpr std::uint32_t kEndOfCount = 0xFFFF'FFFF;

TEST(Beginning, of_inputs_and_outputs_is_rest) {
  const Inputs inputs;
  EXPECT_EQ(inputs.elapsed_ms, 1U);
  EXPECT_TRUE(inputs.received.empty());
  EXPECT_EQ(inputs.sensors.close_mbar, (std::array<std::int32_t, 2>{}));
  EXPECT_EQ(inputs.sensors.supply_mbar, 0);
  EXPECT_EQ(inputs.sensors.separation_10um, 0);
  EXPECT_EQ(inputs.sensors.seats, 0);
  EXPECT_FALSE(inputs.sensors.local_enable);
  EXPECT_EQ(inputs.nvm.done, 0);
  EXPECT_FALSE(inputs.nvm.failed);
  EXPECT_FALSE(inputs.bus.off);
  EXPECT_FALSE(inputs.bus.passive);
  EXPECT_EQ(inputs.bus.overruns, 0U);
  const Outputs outputs;
  EXPECT_EQ(outputs.send.size, 0U);
  EXPECT_EQ(outputs.valves, (Valves{Spool::Hold, 0, false, false, false}));
  EXPECT_FALSE(outputs.nvm.has_value());
  EXPECT_FALSE(outputs.restart_bus);
  EXPECT_EQ(NvmWrite{}.sequence, 0);
}

TEST(Beginning, of_memory_is_that_nothing_was_recorded) {
  const NvmImage image;
  EXPECT_FALSE(image.record.has_value());
  EXPECT_TRUE(image.readable);
  EXPECT_EQ(image.layout.size, 0);
  const NvmRecord record;
  EXPECT_EQ(record.custody, Custody::Empty);
  EXPECT_EQ(record.peer, 0);
  EXPECT_EQ(record.token, 0);
  EXPECT_EQ(record.pair, 0);
  EXPECT_EQ(record.handoff_number, 0);
  EXPECT_EQ(record.force_set_dn, 0);
  EXPECT_EQ(record.permit_dn, 0);
  EXPECT_EQ(record.session_block, 0U);
  EXPECT_EQ(record.frame_block, 0U);
  EXPECT_EQ(record.boot_count, 0);
  EXPECT_EQ(record.seen_givers, 0);
  for (const Outcome& outcome : record.outcomes) {
    EXPECT_FALSE(outcome.retained);
    EXPECT_EQ(outcome.peer, 0);
    EXPECT_EQ(outcome.token, 0);
    EXPECT_EQ(outcome.pair, 0);
  }
  EXPECT_EQ(Stored<NvmRecord>{}.sequence, 0U);
}

TEST(Beginning, of_a_configuration_is_the_140_n_class) {
  const Config config;
  EXPECT_EQ(config.node, 1);
  EXPECT_FALSE(config.passive);
  EXPECT_EQ(config.kit_id, 0);
  EXPECT_EQ(config.seat_switches, 0);
  EXPECT_EQ(config.hardware_limit_dn, 1400);
  EXPECT_EQ(config.uncertainty_dn, 120);
  EXPECT_EQ(config.pressure_max_mbar, 6000);
  EXPECT_EQ(config.serial, 0U);
  EXPECT_FALSE(config.key.has_value());
  EXPECT_FALSE(config.can_fd);
  EXPECT_TRUE(config.force_guard_enabled);
  EXPECT_TRUE(config.release_guard_enabled);
  Config secured;
  secured.can_fd = true;
  EXPECT_FALSE(on_can_fd(secured)) << "a MAC needs a key";
  secured.key = wire::Key{};
  EXPECT_TRUE(on_can_fd(secured));
  secured.can_fd = false;
  EXPECT_FALSE(on_can_fd(secured));
}

TEST(Beginning, of_measuring_is_that_nothing_was_read) {
  const Measurement m;
  EXPECT_FALSE(m.started);
  EXPECT_EQ(m.open_ubar, 0);
  EXPECT_EQ(m.squeeze, (Squeeze{0, 0, 0}));
  EXPECT_EQ(m.squeeze.measured_dn, 0);
  EXPECT_EQ(m.separation_10um, 0);
  EXPECT_EQ(m.still_at_10um, 0);
  EXPECT_EQ(m.lagging_um, 0);
  EXPECT_EQ(m.closing_mm_s, 0);
  EXPECT_EQ(m.still_ms, 0);
  EXPECT_EQ(m.troubled_ms, 0);
  EXPECT_EQ(m.suspected, SensorTrouble::None);
  EXPECT_EQ(m.trouble, SensorTrouble::None);
  EXPECT_EQ(m.supply_low_ms, 0);
  EXPECT_FALSE(m.supply_low);
  EXPECT_FALSE(m.seated);
  EXPECT_FALSE(m.seats_clear);
  EXPECT_FALSE(m.local_enable);
  EXPECT_EQ(m.supply_mbar, 0);
  EXPECT_EQ(ForceGuard{}.over_ms, 0);
  EXPECT_EQ(ForceGuard{}.under_ms, 0);
  EXPECT_FALSE(ForceGuard{}.cut);
}

TEST(Beginning, of_both_channels_is_that_nobody_was_heard_and_nothing_permitted) {
  BusLink bus;
  EXPECT_FALSE(bus.off() || bus.fell_off() || bus.recovered() || bus.passive() || bus.overran());
  bus.observe({}, 1);
  EXPECT_FALSE(bus.overran());
  HostLink host;
  EXPECT_FALSE(host.alive() || host.permits() || host.two_hosts());
  EXPECT_EQ(host.epoch(), 0);
  const Release release;
  EXPECT_EQ(release.peer, 0);
  EXPECT_EQ(release.token, 0);
  EXPECT_EQ(release.pair, 0);
  EXPECT_EQ(release.peer_required_dn, 0);
  EXPECT_FALSE(release.decided);
  const ReleaseGuard guard;
  EXPECT_EQ(guard.custody.counter, 15);
  EXPECT_EQ(guard.custody.in_a_row, 0);
  EXPECT_FALSE(guard.custody.good);
  EXPECT_EQ(guard.peer, 0);
  EXPECT_EQ(guard.token, 0);
  EXPECT_EQ(guard.good_ms, 0);
  EXPECT_FALSE(guard.peer_permits || guard.hand_permits || guard.decided_before);
  EXPECT_FALSE(guard.asked.running() || guard.peer_faulty.running());
  const Decision decision;
  EXPECT_EQ(decision.answer, Answer{});
  EXPECT_EQ(decision.event, Event::CmdHold);
  EXPECT_EQ(Reaction{}, (Reaction{ReactionKind::Ignored, StateId::Boot}));
  EXPECT_EQ(Reaction{}.kind, ReactionKind::Ignored);
}

TEST(Beginning, of_a_state_is_boot_with_nothing_known) {
  const State state;
  EXPECT_EQ(state.id, StateId::Boot);
  EXPECT_FALSE(state.layouts.committed || state.layouts.is_staged);
  EXPECT_EQ(state.layouts.crc, 0U);
  EXPECT_EQ(state.store.requested, 0);
  EXPECT_EQ(state.store.done, 0);
  EXPECT_FALSE(state.store.record_waits || state.store.layout_waits || state.store.failed);
  EXPECT_TRUE(state.store.readable);
  EXPECT_EQ(state.announced, (Announcement{wire::Fact::Unknown, 0, 0, 0}));
  EXPECT_EQ(state.announced.peer, 0);
  EXPECT_EQ(state.receiving.giver, 0);
  EXPECT_EQ(state.receiving.token, 0);
  EXPECT_EQ(state.receiving.pair, 0);
  EXPECT_FALSE(state.receiving.retained);
  EXPECT_EQ(state.control.flow, Flow::Shut);
  EXPECT_EQ(state.control.reference_dn, 0);
  EXPECT_EQ(state.control.integral_ubar, 0);
  EXPECT_EQ(state.control.blocked_ms, 0);
  EXPECT_EQ(state.control.push_mdn, 0);
  EXPECT_EQ(state.control.starved_ms, 0);
  EXPECT_FALSE(state.control.refilling);
  EXPECT_EQ(state.control.asked_ms, 0);
  const SendCounters& sent = state.send_counters;
  for (const int counter :
       {sent.fault, sent.custody, sent.status, sent.force, sent.pneumatics, sent.layout, sent.identity})
    EXPECT_EQ(counter, 0);
  const Counters& counted = state.counters;
  for (const std::uint32_t counter : {counted.bad_frames, counted.events_ignored, counted.events_refused,
                                      counted.frames_not_sent, counted.steps, counted.wrong_macs})
    EXPECT_EQ(counter, 0U);
  EXPECT_FALSE(state.service.commit_waits);
  EXPECT_EQ(state.service.commit_transaction, 0);
  EXPECT_EQ(state.link.next_number(), 0U);
  EXPECT_EQ(state.frame_block, 0U);
  Faults faults = state.faults;
  EXPECT_EQ(faults.take_report(), wire::FaultCode::None);
  EXPECT_EQ(faults.worst(), wire::FaultCode::None);
  EXPECT_EQ(state.session_epoch, 0);
  EXPECT_EQ(state.next_session, 0U);
  EXPECT_EQ(state.permit_dn, 0);
  EXPECT_EQ(state.force_set_dn, 0);
  EXPECT_EQ(state.reference_10um, 0);
  EXPECT_EQ(state.challenge, 0);
  EXPECT_EQ(state.bad_hold_ms, 0);
  EXPECT_EQ(state.identity_page, 0);
  EXPECT_EQ(state.outcome_next, 0);
  EXPECT_TRUE(state.identity_burst);
  EXPECT_FALSE(state.frozen || state.opening_wanted || state.hold_proven || state.answer_seen);
}

NvmImage left_by(const NvmRecord& record) {
  return {.record = record, .readable = true, .layout = {}};
}

TEST(PowerOn, begins_another_boot_and_the_next_block_of_sessions) {
  const State state = power_on({.node = kArm}, left_by({.session_block = 32, .boot_count = 6}));
  EXPECT_EQ(state.config.node, kArm);
  EXPECT_EQ(state.next_session, 32U);
  EXPECT_EQ(state.store.record.session_block, 48U);
  EXPECT_EQ(state.store.record.boot_count, 7);
  EXPECT_TRUE(state.store.record_waits);
  EXPECT_EQ(state.timers.force.left_ms(), 11);
  const State last = power_on({.node = kArm}, left_by({.session_block = kEndOfCount - 64}));
  EXPECT_EQ(last.store.record.session_block, kEndOfCount - 64) << "no block is left";
  EXPECT_EQ(last.next_session, kEndOfCount - 64);
}

TEST(PowerOn, takes_up_the_handoff_and_the_permit_that_the_record_tells_of) {
  NvmRecord record{.peer = kPedestal, .token = 7, .pair = 8, .permit_dn = 900};
  State state = power_on({.node = kArm}, left_by(record));
  EXPECT_EQ(state.permit_dn, 900);
  EXPECT_EQ(state.receiving.giver, kPedestal);
  EXPECT_EQ(state.receiving.token, 7);
  EXPECT_EQ(state.receiving.pair, 8);
  for (const Custody custody : {Custody::Sole, Custody::Latched, Custody::Released}) {
    record.custody = custody;
    state = power_on({.node = kArm}, left_by(record));
    EXPECT_EQ(state.receiving.giver, 0);
    EXPECT_FALSE(state.release_guard.decided_before);
  }
  record.custody = Custody::Decided;
  EXPECT_TRUE(power_on({.node = kArm}, left_by(record)).release_guard.decided_before);
}

TEST(PowerOn, stores_nothing_in_a_memory_that_it_cannot_read_and_takes_no_layout_from_it) {
  NvmImage image;
  const wire::EncodedLayout encoded = wire::encode(layout_for(kArm));
  std::copy(encoded.bytes.begin(), encoded.bytes.end(), image.layout.bytes.begin());
  image.layout.size = static_cast<std::uint16_t>(encoded.size);
  const Config config{.node = kArm, .kit_id = 0x1234};
  const State good = power_on(config, image);
  EXPECT_TRUE(good.layouts.committed);
  EXPECT_EQ(good.layouts.layout, layout_for(kArm));
  EXPECT_EQ(good.layouts.crc, wire::layout_crc_of(layout_for(kArm)));
  EXPECT_NE(good.peers.find(kPedestal), nullptr);
  EXPECT_FALSE(power_on({.node = kArm, .kit_id = 0x1235}, image).layouts.committed) << "for another kit";
  image.readable = false;
  const State bad = power_on(config, image);
  EXPECT_FALSE(bad.store.readable);
  EXPECT_FALSE(bad.store.record_waits);
  EXPECT_FALSE(bad.layouts.committed);
  image.readable = true;
  image.layout.bytes[20] ^= 1U;
  EXPECT_FALSE(power_on(config, image).layouts.committed);
  for (const std::uint16_t size :
       {std::uint16_t{0}, std::uint16_t{1}, std::uint16_t{256}, std::uint16_t{257}}) {
    image.layout.size = size;
    EXPECT_FALSE(power_on(config, image).layouts.committed) << size;
  }
}

TEST(PowerOn, begins_its_frame_numbers_with_the_block_of_the_record) {
  const Config config{.node = kArm, .key = wire::Key{}, .can_fd = true};
  const State state = power_on(config, left_by({.frame_block = 3}));
  EXPECT_EQ(state.link.next_number(), 0x3'0001U);
  EXPECT_EQ(state.store.record.frame_block, 19U);
}

}  // namespace
}  // namespace pinjaw::core::test
