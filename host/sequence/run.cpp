#include "host/sequence/run.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace pinjaw::sequence {

Run::Run(const model::Sequence& sequence, const Crew& crew, std::vector<StepScript> scripts, Venue venue,
         jaw_client::Client::Settings host)
    : sequence_(sequence),
      scripts_(std::move(scripts)),
      venue_(std::move(venue)),
      injected_(sequence.faults.size()),
      client_(*venue_.bus, host),
      stage_{client_, venue_.world} {
  report_.sequence = sequence.name;
  for (const Member& member : crew.members()) nodes_.push_back(member.node());
  for (const int node : nodes_) last_.push_back({-1, node, wire::State::Boot, wire::Fact::Unknown});
  constexpr double kRelativeTol = 1e-6;
  for (const StepScript& script : scripts_) {
    report_.undersampled = report_.undersampled || script.needed_n > script.required_n * (1 + kRelativeTol);
  }
}

const std::string& Run::playing() const {
  return scripts_[std::min(step_, scripts_.size() - 1)].name;
}

void Run::step(std::int64_t now_us) {
  if (over_) return;
  now_us_ = now_us;
  if (!started_us_) {
    started_us_ = now_us;
    begin_try();
    report_.steps.push_back(
        {.step = playing(), .result = "", .from_s = 0, .to_s = 0, .tries = 1, .states = {}});
  }
  inject_faults();
  if (killed_) {
    if (time_s() >= over_at_s_) over_ = true;
    return;
  }
  client_.step(now_us);
  note_states();
  if (client_.bus_failure()) return give_up({Trouble::Silent, client_.bus_failure()->message});
  play();
}

void Run::note_states() {
  for (StateChange& last : last_) {
    const jaw_client::NodeView& view = client_.node(static_cast<std::uint8_t>(last.node));
    if (!view.state) continue;
    const StateChange now{time_s(), last.node, view.state->state,
                          view.custody ? view.custody->fact : wire::Fact::Unknown};
    const bool changed = last.t_s < 0 || now.state != last.state || now.fact != last.fact;
    if (!changed) continue;
    last = now;
    current().states.push_back(now);
  }
}

void Run::inject_faults() {
  for (std::size_t i = 0; i < sequence_.faults.size(); ++i) {
    const model::ScriptedFault& fault = sequence_.faults[i];
    const bool by_step =
        fault.at_step && step_ >= static_cast<std::size_t>(*fault.at_step);  // step 0 sets up
    const bool by_time = fault.at_s && time_s() >= *fault.at_s;
    if (injected_[i] || (!by_step && !by_time)) continue;
    injected_[i] = true;
    if (!fault.kill_host) {
      if (venue_.lose_frames) venue_.lose_frames(fault.drop_share, fault.seconds);
    } else if (!killed_) {
      killed_ = true;
      over_at_s_ = time_s() + kAftermathS;
      finish_step("the host was killed");
    }
  }
}

const std::vector<Action>& Run::list() const {
  return undoing_ ? scripts_[step_].undo : scripts_[step_].actions;
}

void Run::begin_try() {
  action_ = 0;
  begun_ = false;
  undoing_ = false;
}

void Run::play() {
  // actions that end at once follow each other within one call; the count bounds a script of nothing but such
  constexpr int kMostAtOnce = 1000;
  for (int i = 0; i < kMostAtOnce && !over_; ++i) {
    if (time_s() - current().from_s > scripts_[step_].within_s) {
      return give_up({Trouble::Silent, fmt::format("not done within {:g} s", scripts_[step_].within_s)});
    }
    if (action_ == list().size()) {
      if (!undoing_) {
        finish_step("done");
        inject_faults();
        if (over_ || killed_) return;
        continue;
      }
      ++current().tries;
      begin_try();
      const bool there = scripts_[step_].reached && scripts_[step_].reached(client_);
      if (there) action_ = list().size();
      continue;
    }
    const Action& action = list()[action_];
    ActionState state = StillGoing{};
    if (!begun_) {
      begun_ = true;
      action_since_us_ = now_us_;
      state = action.begin(stage_);
    } else {
      state = action.poll(stage_);
    }
    const bool late = now_us_ - action_since_us_ >= action.limit_us;
    if (std::holds_alternative<StillGoing>(state) && late) {
      if (action.ends_well_at_limit) {
        state = Finished{};
      } else {
        state = Failed{Trouble::Silent, action.name};
      }
    }
    if (std::holds_alternative<StillGoing>(state)) return;
    advance(state);
  }
}

void Run::advance(const ActionState& state) {
  if (const auto* failure = std::get_if<Failed>(&state)) return fail(*failure);
  ++action_;
  begun_ = false;
}

void Run::fail(const Failed& failure) {
  const StepScript& script = scripts_[step_];
  if (!undoing_ && current().tries < script.tries && !script.undo.empty()) {
    undoing_ = true;
    action_ = 0;
    begun_ = false;
    return;
  }
  give_up(failure);
}

void Run::give_up(const Failed& failure) {
  trouble_ = failure.trouble;
  finish_step(failure.sentence);
  over_ = true;
}

StepReport& Run::current() {
  return report_.steps.back();
}

void Run::finish_step(const std::string& result) {
  current().result = result;
  current().to_s = time_s();
  if (result != "done") return;
  ++step_;
  begin_try();
  if (step_ == scripts_.size()) {
    report_.result = RunResult::Done;
    over_ = true;
    return;
  }
  report_.steps.push_back(
      {.step = playing(), .result = "", .from_s = time_s(), .to_s = time_s(), .tries = 1, .states = {}});
}

RunReport Run::report() {
  const bus::Statistics statistics = venue_.bus->statistics();
  report_.bus.frames = statistics.sent + statistics.received;
  report_.bus.statistics = statistics;
  if (stage_.world != nullptr) {
    const auto reply = stage_.world->ask(bench::AskTruth{});
    if (reply && std::holds_alternative<bench::Truth>(*reply)) report_.plant = std::get<bench::Truth>(*reply);
  }
  return report_;
}

}  // namespace pinjaw::sequence
