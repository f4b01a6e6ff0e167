#include "tests/firmware_sim/support/test_cell.hpp"

#include <algorithm>
#include <cmath>

#include "protocol/bus/candump.hpp"

namespace pinjaw::test {
namespace {

constexpr std::uint16_t kKitId = 0xABCD;
constexpr std::uint32_t kPartId = 0x12345678;

std::uint16_t dn(double newtons) {
  return static_cast<std::uint16_t>(std::lround(newtons * 10));
}

node::Figures figures_of(const TestGrip& grip) {
  node::Figures figures;
  figures.node = grip.node;
  figures.passive = grip.passive;
  figures.kit_id = grip.layout ? grip.layout->kit_id : kKitId;
  figures.key = grip.key;
  figures.can_fd = grip.can_fd;
  figures.force_uncertainty_n = grip.passive ? 0 : grip.uncertainty_n;
  figures.max_squeeze_n = grip.passive ? 0 : grip.max_squeeze_n;
  if (grip.keeper_n > 0) figures.plant.keeper_n = grip.keeper_n;
  return figures;
}

}  // namespace

wire::Layout bare_layout(const TestGrip& grip, std::uint16_t kit_id) {
  if (grip.layout) return *grip.layout;
  wire::Layout layout;
  layout.node_class = grip.passive ? wire::NodeClass::Passive : wire::NodeClass::Gripper;
  layout.passive = grip.passive;
  layout.kit_id = kit_id;
  layout.part_id = kPartId;
  layout.grid_pitch_nm = 11112500;
  layout.pin_diameter_nm = 4762500;
  layout.pin_count = grip.passive ? 3 : 4;
  layout.pins[0] = {wire::Jaw::Left, 0, 1, 1600};
  layout.pins[1] = {wire::Jaw::Left, 0, 3, 1600};
  layout.pins[2] = {wire::Jaw::Left, 1, 2, 1600};
  if (!grip.passive) {
    layout.pins[2] = {wire::Jaw::Right, 0, 1, 1600};
    layout.pins[3] = {wire::Jaw::Right, 0, 3, 1600};
  }
  layout.separation_open_10um = 6000;
  layout.separation_contact_10um = static_cast<std::uint16_t>(std::lround(grip.separation_mm * 100));
  layout.separation_tolerance_10um = 50;
  layout.slip_tolerance_um = 200;
  layout.stable_ms = 150;
  if (!grip.passive) {
    layout.f_light_dn = 120;
    layout.f_required_dn = wire::layout_requirement_dn(dn(grip.needed_n), layout.f_light_dn);
    layout.f_limit_dn = dn(grip.limit_n);
  }
  return layout;
}

std::vector<std::uint8_t> write_request(std::uint8_t transaction, const wire::Layout& layout) {
  const wire::EncodedLayout blob = wire::encode(layout);
  std::vector<std::uint8_t> message;
  message.push_back(static_cast<std::uint8_t>(wire::Service::Write));
  message.push_back(transaction);
  for (const std::uint8_t byte : blob.span()) message.push_back(byte);
  return message;
}

std::vector<std::uint8_t> commit_request(std::uint8_t transaction, const wire::Layout& layout) {
  const std::uint32_t crc = wire::layout_crc_of(layout);
  std::vector<std::uint8_t> message;
  message.push_back(static_cast<std::uint8_t>(wire::Service::Commit));
  message.push_back(transaction);
  for (int i = 0; i < 4; ++i) message.push_back(static_cast<std::uint8_t>(crc >> (8 * i)));
  return message;
}

std::vector<TestGrip> arm_pedestal_pallet() {
  return {{.node = 1, .separation_mm = 30, .needed_n = 60},
          {.node = 2, .separation_mm = 36, .needed_n = 40},
          {.node = 3, .passive = true, .separation_mm = 30, .needed_n = 0}};
}

TestCell::TestCell(std::vector<TestGrip> grips, std::uint64_t seed) : grips_(std::move(grips)) {
  bus_.on_frame([this](const bus::Received& received) {
    if (keeps_logs_) frame_log_ += bus::to_log_line({received.time_us, "sim", received.frame}) + "\n";
  });
  std::vector<world::Member> members;
  for (const TestGrip& grip : grips_) {
    ends_.push_back(bus_.open());
    members.push_back({figures_of(grip), ends_.back().get()});
  }
  world_ = std::make_unique<world::World>(members, seed);
  world_->on_event([this](const std::string& line) {
    if (keeps_logs_) event_log_ += line + "\n";
  });
  host_end_ = bus_.open();
  host_ = std::make_unique<ScriptedHost>(*host_end_, std::uint16_t{0x1234});
}

void TestCell::advance(int elapsed_ms) {
  now_ms_ += elapsed_ms;
  if (const auto planned = planned_.find(now_ms()); planned != planned_.end()) planned->second();
  bus_.advance_to(1000 * now_ms_);
  const bool killed = kill_at_ms_ && now_ms_ >= *kill_at_ms_;
  if (!killed) host_->step(elapsed_ms);
  (void)world_->step(static_cast<unsigned>(elapsed_ms));
  if (after_) after_();
  if (killed && now_ms_ == *kill_at_ms_) throw HostKilled();
}

void TestCell::run_ms(int duration_ms) {
  for (int i = 0; i < duration_ms; ++i) advance();
}

bool TestCell::run_until(const std::function<bool()>& condition, int at_most_ms) {
  for (int i = 0; i < at_most_ms; ++i) {
    if (condition()) return true;
    advance();
  }
  return condition();
}

wire::Layout TestCell::layout_of(const TestGrip& grip) const {
  wire::Layout layout = bare_layout(grip, kKitId);
  const std::uint32_t own_crc = wire::layout_crc_of(layout);
  for (const TestGrip& other : grips_) {
    if (other.node == grip.node) continue;
    const wire::Layout other_layout = bare_layout(other, kKitId);
    const std::uint32_t other_crc = wire::layout_crc_of(other_layout);
    layout.peers.at(layout.peer_count++) = {
        .node = static_cast<std::uint8_t>(other.node),
        .layout_crc = other_crc,
        .f_required_dn = other_layout.f_required_dn,
        .pair_crc = wire::pair_crc_of(kPartId, {static_cast<std::uint8_t>(grip.node), own_crc},
                                      {static_cast<std::uint8_t>(other.node), other_crc})};
  }
  return layout;
}

std::optional<wire::TransferStatus> TestCell::send_layout(const TestGrip& grip) {
  const wire::Layout layout = layout_of(grip);
  std::uint8_t transaction = 1;
  for (const auto& message : {write_request(1, layout), commit_request(2, layout)}) {
    host_->request(grip.node, message);
    if (!run_until([&] { return host_->transferred(); }, 1000)) return std::nullopt;
    const std::vector<std::uint8_t>& response = host_->heard(grip.node).response;
    if (response.size() < 3 || response[1] != transaction++) return std::nullopt;
    const auto status = static_cast<wire::TransferStatus>(response[2]);
    if (status != wire::TransferStatus::Ok) return status;
  }
  return wire::TransferStatus::Ok;
}

bool TestCell::commission() {
  run_ms(500);
  return std::ranges::all_of(grips_, [this](const TestGrip& grip) {
    return send_layout(grip) == wire::TransferStatus::Ok && wait_for(grip.node, wire::State::Loaded, 200) &&
           arm(grip.node);
  });
}

wire::Acknowledge TestCell::command(int node, const wire::Command& command) {
  host_->send(node, command);
  if (!run_until([&] { return host_->answered(); }, 500)) return {.result = wire::CommandResult::Busy};
  return host_->heard(node).answer.value_or(wire::Acknowledge{.result = wire::CommandResult::Busy});
}

bool TestCell::arm(int node) {
  for (const TestGrip& grip : grips_) {
    if (grip.node != node) continue;
    const std::uint32_t crc = wire::layout_crc_of(bare_layout(grip, kKitId));
    return command(node, wire::arm_command(crc, 0x1234)).result == wire::CommandResult::Ok;
  }
  return false;
}

wire::State TestCell::state_of(int node) const {
  const auto& state = host_->heard(node).state;
  return state ? state->state : wire::State::Boot;
}

bool TestCell::wait_for(int node, wire::State state, int at_most_ms) {
  return run_until([&] { return state_of(node) == state; }, at_most_ms);
}

const bench::NodeTruth& TestCell::truth_of(int node) {
  last_truth_ = world_->truth();
  return *std::ranges::find(last_truth_.nodes, node, &bench::NodeTruth::node);
}

bool TestCell::squeeze(int node) {
  for (const TestGrip& grip : grips_) {
    if (grip.node != node) continue;
    const wire::Layout layout = bare_layout(grip, kKitId);
    const auto set =
        static_cast<std::uint16_t>(grip.passive ? 0 : layout.f_required_dn + dn(grip.uncertainty_n));
    return command(node, wire::squeeze_command({.set_dn = set, .permit_dn = layout.f_limit_dn})).result ==
           wire::CommandResult::Ok;
  }
  return false;
}

bool TestCell::load(int on) {
  std::vector<bench::Grasp> grasps;
  for (const TestGrip& grip : grips_) grasps.push_back({grip.node, grip.separation_mm, grip.needed_n});
  if (!std::holds_alternative<bench::Done>(ask(bench::Place{on, grasps}))) return false;
  ask(bench::Enable{on, true});
  run_ms(50);
  const bool closing =
      command(on, wire::plain_command(wire::Op::CloseLight)).result == wire::CommandResult::Ok;
  const bool seated = closing && wait_for(on, wire::State::Seated, 3000);
  const bool held = seated && squeeze(on) && wait_for(on, wire::State::Hold, 3000);
  ask(bench::Enable{on, false});
  return held;
}

bool TestCell::hand_over(int giver, int receiver) {
  const auto ok = [this](int node, const wire::Command& said) {
    return command(node, said).result == wire::CommandResult::Ok;
  };
  if (!std::holds_alternative<bench::Done>(ask(bench::Meet{{giver, receiver}}))) return false;
  return ok(giver, wire::offer_command(static_cast<std::uint8_t>(receiver))) &&
         wait_for(giver, wire::State::Offered, 200) &&
         run_until(
             [&] {
               const auto& custody = host_->heard(giver).custody;
               return custody && custody->fact == wire::Fact::Offer;
             },
             200) &&
         ok(receiver, wire::accept_command(static_cast<std::uint8_t>(giver))) &&
         wait_for(receiver, wire::State::Seated, 3000) && squeeze(receiver) &&
         wait_for(receiver, wire::State::Hold, 5000) && wait_for(giver, wire::State::Ready, 5000);
}

}  // namespace pinjaw::test
