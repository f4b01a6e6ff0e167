#include "host/sequence/action.hpp"

#include <limits>
#include <memory>
#include <utility>

namespace pinjaw::sequence {

namespace {

constexpr std::int64_t kForever = std::numeric_limits<std::int64_t>::max();

ActionState state_of(const jaw_client::Outcome& outcome) {
  using jaw_client::OutcomeKind;
  switch (outcome.kind) {
    case OutcomeKind::Pending:
      return StillGoing{};
    case OutcomeKind::Done:
      return Finished{};
    case OutcomeKind::ForceRefused:
      return Failed{Trouble::ForceLimit, outcome.sentence};
    case OutcomeKind::Silent:
    case OutcomeKind::BusFailed:
      return Failed{Trouble::Silent, outcome.sentence};
    case OutcomeKind::Refused:
    case OutcomeKind::Fault:
      break;
  }
  return Failed{Trouble::Refused, outcome.sentence};
}

ActionState ask(Stage& stage, const bench::Request& request) {
  if (stage.world == nullptr) return Finished{};
  const auto reply = stage.world->ask(request);
  if (!reply) return Failed{Trouble::Silent, "the world: " + reply.error().message};
  if (const auto* refused = std::get_if<bench::Refused>(&*reply)) {
    return Failed{Trouble::World, "the world: " + refused->reason};
  }
  return Finished{};
}

}  // namespace

Action tell(bench::Request request) {
  return {.name = "bench",
          .limit_us = kForever,
          .ends_well_at_limit = false,
          .begin = [request = std::move(request)](Stage& stage) { return ask(stage, request); },
          .poll = [](Stage&) -> ActionState { return Finished{}; }};
}

Action operate(std::string name, std::uint8_t node, std::function<void(jaw_client::Client&)> begin) {
  return {.name = std::move(name),
          .limit_us = kForever,  // the client limits its operations itself
          .ends_well_at_limit = false,
          .begin = [begin = std::move(begin)](Stage& stage) -> ActionState {
            begin(stage.client);
            return StillGoing{};
          },
          .poll = [node](Stage& stage) { return state_of(stage.client.outcome(node)); }};
}

Action until(std::string otherwise, std::int64_t limit_us,
             std::function<bool(const jaw_client::Client&)> condition) {
  return {.name = std::move(otherwise),
          .limit_us = limit_us,
          .ends_well_at_limit = false,
          .begin = [](Stage&) -> ActionState { return StillGoing{}; },
          .poll = [condition = std::move(condition)](Stage& stage) -> ActionState {
            if (condition(stage.client)) return Finished{};
            return StillGoing{};
          }};
}

Action pause(double seconds) {
  const auto still = [](Stage&) -> ActionState { return StillGoing{}; };
  return {.name = "pause",
          .limit_us = static_cast<std::int64_t>(seconds * 1e6),
          .ends_well_at_limit = true,
          .begin = still,
          .poll = still};
}

Action rearming(Action action, Action arm, std::uint8_t node) {
  constexpr int kTries = 3;
  struct Course {
    int tries = 0;
    bool arms = false;
  };
  const auto course = std::make_shared<Course>();
  const auto poll = [course, node, acts = action, arms = std::move(arm)](Stage& stage) -> ActionState {
    if (course->arms) {
      const ActionState state = arms.poll(stage);
      if (!std::holds_alternative<Finished>(state)) return state;
      course->arms = false;
      return acts.begin(stage);
    }
    ActionState state = acts.poll(stage);
    const bool session_over = stage.client.outcome(node).reason == wire::Reason::NotArmed;
    if (!std::holds_alternative<Failed>(state) || !session_over || ++course->tries >= kTries) return state;
    course->arms = true;
    return arms.begin(stage);
  };
  action.begin = [course, begin = std::move(action.begin)](Stage& stage) {
    *course = {};
    return begin(stage);
  };
  action.poll = poll;
  return action;
}

Action attempt(Action action) {
  const auto forgiving = [](std::function<ActionState(Stage&)> inner) {
    return [inner = std::move(inner)](Stage& stage) -> ActionState {
      ActionState state = inner(stage);
      if (std::holds_alternative<Failed>(state)) return Finished{};
      return state;
    };
  };
  action.begin = forgiving(std::move(action.begin));
  action.poll = forgiving(std::move(action.poll));
  action.ends_well_at_limit = true;
  return action;
}

}  // namespace pinjaw::sequence
