#include "host/jaw_client/operation.hpp"

#include <utility>

#include "protocol/wire/commands.hpp"
#include "protocol/wire/names.hpp"

namespace pinjaw::jaw_client {

namespace {

std::string node_name(std::uint8_t node) {
  return "node " + std::to_string(node);
}

bool is_force_reason(wire::Reason reason) {
  return reason == wire::Reason::ForceOverPermit || reason == wire::Reason::ForceOverLimit;
}

}  // namespace

void Operation::begin(std::uint8_t node, const Order& order) {
  node_ = node;
  order_ = order;
  outcome_ = {};
  challenged_ = false;
  asked_again_ = false;
  phase_ = Phase::Start;
}

void Operation::begin(std::uint8_t node, const wire::Layout& layout) {
  begin(node, Order{});
  transfer_.begin(layout);
  phase_ = Phase::Transfer;
}

void Operation::fail(OutcomeKind kind, std::string sentence) {
  if (!outcome_.pending()) return;
  outcome_.kind = kind;
  outcome_.sentence = std::move(sentence);
  phase_ = Phase::Over;
}

void Operation::enter(Phase phase, std::int64_t now_us) {
  phase_ = phase;
  entered_us_ = now_us;
}

void Operation::advance(const Surroundings& around) {
  switch (phase_) {
    case Phase::Over:
      return;
    case Phase::Start:
      begun_us_ = around.now_us;
      enter(Phase::Prepare, around.now_us);
      return prepare(around);
    case Phase::Prepare:
      return prepare(around);
    case Phase::Command:
      return await_answer(around);
    case Phase::Pause:
      if (around.now_us - entered_us_ < kBusyRetry_us) return;
      around.channel.begin(order_.command);
      return enter(Phase::Command, around.now_us);
    case Phase::Challenge:
      return await_challenge(around);
    case Phase::Reach:
      return reach(around);
    case Phase::Transfer:
      if (transfer_.outcome().pending()) return;
      outcome_ = transfer_.outcome();
      if (!outcome_.done()) outcome_.sentence = node_name(node_) + ": " + outcome_.sentence;
      around.channel.forget_session();
      phase_ = Phase::Over;
  }
}

void Operation::prepare(const Surroundings& around) {
  const NodeView& view = around.view;
  const bool heard = !order_.needs_host_heard || (view.alive(around.now_us) && view.state->host_alive);
  const NodeView* giver = around.giver;
  const bool offered = order_.offering_giver == 0 ||
                       (giver != nullptr && giver->custody && giver->custody->fact == wire::Fact::Offer &&
                        giver->custody->peer == node_);
  if (heard && offered) {
    if (order_.asks_challenge) around.view.challenge.reset();
    around.channel.begin(order_.command);
    return enter(Phase::Command, around.now_us);
  }
  if (around.now_us - entered_us_ < kPrepare_us) return;
  if (!view.alive(around.now_us)) return fail(OutcomeKind::Silent, node_name(node_) + " is not heard");
  if (!heard) return fail(OutcomeKind::Silent, node_name(node_) + " does not hear this host");
  fail(OutcomeKind::Silent, node_name(order_.offering_giver) + " makes no offer to " + node_name(node_));
}

void Operation::await_answer(const Surroundings& around) {
  switch (around.channel.state()) {
    case ChannelState::Idle:
    case ChannelState::Waiting:
      return;
    case ChannelState::Silent:
      return fail(OutcomeKind::Silent, node_name(node_) + " does not answer");
    case ChannelState::NoSession:
      outcome_.reason = wire::Reason::NotArmed;
      return fail(OutcomeKind::Refused, node_name(node_) + " is not armed");
    case ChannelState::NoKey:
      outcome_.reason = wire::Reason::Authentication;
      return fail(OutcomeKind::Refused, node_name(node_) + " has no key, and this host insists on one");
    case ChannelState::OtherKey:
      outcome_.reason = wire::Reason::Authentication;
      return fail(OutcomeKind::Refused, node_name(node_) + " has another key than this host");
    case ChannelState::Answered:
      return answered(around);
  }
}

bool Operation::worth_another_try(const wire::Acknowledge& answer, std::int64_t now_us) {
  if (now_us - begun_us_ >= kPrepare_us) return false;
  if (answer.result == wire::CommandResult::Ok) {
    return order_.leaves_loaded && answer.state == wire::State::Loaded;
  }
  if (answer.result == wire::CommandResult::Busy) return true;
  switch (answer.reason) {
    case wire::Reason::PeerStale:
      return true;  // a frame or two of the peer were lost
    case wire::Reason::PeerNotOffering:
      return order_.offering_giver != 0;  // its OFFER is on its way
    case wire::Reason::TwoHosts:          // the last host may have stopped just now
    case wire::Reason::HostSilent:
    case wire::Reason::WrongSession:  // the node still follows the last host
      return order_.command.op == wire::Op::Arm;
    case wire::Reason::Authentication:  // another session began since we asked for the number
      return order_.command.op == wire::Op::Arm && knows_key_ && !std::exchange(asked_again_, true);
    default:
      return false;
  }
}

void Operation::answered(const Surroundings& around) {
  const wire::Acknowledge answer = around.channel.answer();
  knows_key_ = around.channel.has_secret();
  if (worth_another_try(answer, around.now_us)) return enter(Phase::Pause, around.now_us);
  if (answer.result != wire::CommandResult::Ok) return refused(answer);
  if (order_.asks_challenge && !challenged_) return enter(Phase::Challenge, around.now_us);
  if (order_.goals.empty()) {
    outcome_.kind = OutcomeKind::Done;
    phase_ = Phase::Over;
    return;
  }
  states_before_ = around.view.states_heard;
  state_before_ = around.view.state ? around.view.state->state : answer.state;
  left_ = false;
  enter(Phase::Reach, around.now_us);
}

void Operation::refused(const wire::Acknowledge& answer) {
  outcome_.result = answer.result;
  outcome_.reason = answer.reason;
  if (answer.reason == wire::Reason::Authentication && !knows_key_) {
    return fail(OutcomeKind::Refused,
                node_name(node_) + " requires authentication: give this host the cell's key");
  }
  const bool force = answer.result == wire::CommandResult::Limit || is_force_reason(answer.reason);
  fail(force ? OutcomeKind::ForceRefused : OutcomeKind::Refused,
       node_name(node_) + " refused " + wire::to_string(answer.op) + " in " + wire::to_string(answer.state) +
           ": " + wire::to_string(answer.result) +
           (answer.reason == wire::Reason::None ? ""
                                                : std::string(" (") + wire::to_string(answer.reason) + ")"));
}

void Operation::await_challenge(const Surroundings& around) {
  if (around.view.challenge) {
    challenged_ = true;
    order_.command = wire::manual_release_answer(*around.view.challenge);
    around.channel.begin(order_.command);
    return enter(Phase::Command, around.now_us);
  }
  if (around.now_us - entered_us_ >= kPrepare_us) {
    fail(OutcomeKind::Silent, node_name(node_) + " gave no challenge");
  }
}

void Operation::reach(const Surroundings& around) {
  const NodeView& view = around.view;
  if (view.states_heard > states_before_) {
    const wire::State state = view.state->state;
    left_ = left_ || state != state_before_;
    if (order_.goals.has(state)) {
      outcome_.kind = OutcomeKind::Done;
      phase_ = Phase::Over;
      return;
    }
    if (order_.failures.has(state) && (left_ || around.now_us - entered_us_ >= kFallback_us)) {
      outcome_.fault = view.state->fault;
      return fail(OutcomeKind::Fault, node_name(node_) + " fell to " + wire::to_string(state) + " after " +
                                          wire::to_string(order_.command.op) + ": " +
                                          wire::to_string(view.state->fault));
    }
  }
  if (around.now_us - entered_us_ < order_.reach_us) return;
  fail(OutcomeKind::Silent,
       node_name(node_) + " did not finish " + wire::to_string(order_.command.op) + " in time" +
           (view.state ? std::string("; it is in ") + wire::to_string(view.state->state) : ""));
}

}  // namespace pinjaw::jaw_client
