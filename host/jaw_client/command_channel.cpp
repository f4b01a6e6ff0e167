#include "host/jaw_client/command_channel.hpp"

namespace pinjaw::jaw_client {

namespace {
/// Commands outside a session count in the lower half, so that an ARM leaves its session numbers to use.
constexpr std::uint8_t kFreeNumbers = 128;
}  // namespace

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
  tries_ = 0;
  if (!number(command)) {
    state_ = ChannelState::NoSession;
    return;
  }
  command_ = command;
  state_ = ChannelState::Waiting;
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

}  // namespace pinjaw::jaw_client
