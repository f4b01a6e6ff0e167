#include "host/jaw_client/command_channel.hpp"

namespace pinjaw::jaw_client {

namespace {

/// Commands outside a session count in the lower half, so that an ARM leaves its session numbers to use.
constexpr std::uint8_t kFreeNumbers = 128;
/// A session that opens between two answers makes the proof of the third wrong: ask again.
constexpr int kMostUnproven = 3;

/// splitmix64: another one for each step of `state`.
std::uint64_t next_random(std::uint64_t& state) {
  state += 0x9E3779B97F4A7C15U;
  std::uint64_t mixed = state;
  mixed = (mixed ^ (mixed >> 30)) * 0xBF58476D1CE4E5B9U;
  mixed = (mixed ^ (mixed >> 27)) * 0x94D049BB133111EBU;
  return mixed ^ (mixed >> 31);
}

wire::Nonce nonce_from(std::uint64_t bits) {
  return {.session = static_cast<std::uint16_t>(bits & 0xFFFFU),
          .a = static_cast<std::uint16_t>(bits >> 16 & 0xFFFU),
          .b = static_cast<std::uint16_t>(bits >> 32 & 0xFFFU)};
}

}  // namespace

void CommandChannel::share(std::uint8_t node, const Secret& secret) {
  node_ = node;
  secret_ = secret;
  secret_->nonces += std::uint64_t{node} << 56;
}

bool CommandChannel::number(wire::Command& command) {
  if (command.op == wire::Op::Hold || command.op == wire::Op::Arm) {
    command.sequence = free_number_;
    free_number_ = static_cast<std::uint8_t>((free_number_ + 1) % kFreeNumbers);
    return true;
  }
  if (session_ == 0) return false;
  const std::optional<std::uint8_t> sequence = issuer_.take();
  if (!sequence) return false;
  command.sequence = *sequence;
  command.session = session_;
  return true;
}

void CommandChannel::begin(wire::Command command) {
  asking_ = wire::ArmStep::Open;
  if (secret_ && command.op == wire::Op::Arm) {
    arm_ = command;
    unproven_ = 0;
    return ask(wire::ArmStep::LowHalf);
  }
  if (!number(command)) {
    state_ = ChannelState::NoSession;
    return;
  }
  if (secret_ && command.op != wire::Op::Hold)
    command = wire::sealed(secret_->key, node_, command, freshness_);
  say(command);
}

void CommandChannel::say(const wire::Command& command) {
  tries_ = 0;
  command_ = command;
  state_ = ChannelState::Waiting;
}

void CommandChannel::ask(wire::ArmStep step) {
  asking_ = step;
  if (step == wire::ArmStep::LowHalf) nonce_ = nonce_from(next_random(secret_->nonces));
  wire::Command question = wire::ask_number(step, nonce_);
  number(question);
  say(question);
}

std::optional<wire::Command> CommandChannel::due(std::int64_t now_us) {
  if (state_ != ChannelState::Waiting) return std::nullopt;
  if (tries_ > 0 && now_us - sent_at_us_ < kRepeat_us) return std::nullopt;
  if (tries_ == kTries) {
    state_ = ChannelState::Silent;
    return std::nullopt;
  }
  ++tries_;
  sent_at_us_ = now_us;
  return command_;
}

void CommandChannel::take(const wire::Acknowledge& answer) {
  if (state_ != ChannelState::Waiting || answer.sequence != command_.sequence || answer.op != command_.op)
    return;
  answer_ = answer;
  if (asking_ != wire::ArmStep::Open) return take_number(answer);
  state_ = ChannelState::Answered;
  if (answer.reason == wire::Reason::NotArmed || answer.result == wire::CommandResult::BadSession)
    session_ = 0;
  if (answer.result != wire::CommandResult::Ok) return;
  if (command_.op == wire::Op::Disarm) session_ = 0;
  if (command_.op == wire::Op::Arm) {
    session_ = answer.session;
    issuer_.begin(answer.next_sequence);
  }
}

void CommandChannel::take_number(const wire::Acknowledge& answer) {
  if (answer.reason != wire::Reason::Authentication) {
    state_ = answer.reason == wire::Reason::BadArgument ? ChannelState::NoKey : ChannelState::Answered;
    return;
  }
  if (asking_ == wire::ArmStep::LowHalf) {
    asked_ = answer.session;
    return ask(wire::ArmStep::HighHalf);
  }
  if (asking_ == wire::ArmStep::HighHalf) {
    asked_ |= std::uint32_t{answer.session} << 16;
    return ask(wire::ArmStep::Proof);
  }
  if (answer.session != wire::number_answer(secret_->key, node_, wire::ArmStep::Proof, asked_, nonce_)) {
    if (++unproven_ < kMostUnproven) return ask(wire::ArmStep::LowHalf);
    state_ = ChannelState::OtherKey;
    return;
  }
  asking_ = wire::ArmStep::Open;
  freshness_ = {.number = asked_, .epoch = arm_.session};
  wire::Command arm = arm_;
  number(arm);
  say(wire::sealed(secret_->key, node_, arm, freshness_));
}

}  // namespace pinjaw::jaw_client
