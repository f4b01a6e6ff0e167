#include "host/sequence/script.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "host/sequence/loads.hpp"

namespace pinjaw::sequence {

namespace {

constexpr int kHandoffTries = 3;                // the contract's number
constexpr std::int64_t kSettle_us = 5'000'000;  // chosen: ten times what a handoff's last states take
constexpr double kHandAwayS = 0.1;              // chosen: a hand takes the part away at once
constexpr double kLevelRad = 1e-4;  // chosen: rounding of a script's degrees, far under a real tilt

/// Writes one script after the other and remembers where the part is then.
class Writer {
 public:
  Writer(Crew& crew, const planner::Scene& scene) : crew_(crew), scene_(scene) {
    carried_.mass_kg = scene.part.mass_kg;
    carried_.centroid_mm = scene.part.centroid_mm;
  }

  StepScript set_up() {
    StepScript script;
    script.name = "set up";
    for (Member& member : crew_.members()) {
      const std::uint8_t node = member.node();
      script.actions.push_back(
          operate("send the layout", node, [node, layout = member.layout()](auto& client) {
            client.permit(node, true);
            client.send_layout(node, layout);
          }));
      script.actions.push_back(arm(member));
    }
    return script;
  }

  base::Expected<StepScript> write(const model::Step& step) {
    script_ = {};
    const base::Expected<void> written = std::visit([this](const auto& s) { return add(s); }, step);
    if (!written) return base::failure(script_.name + ": " + written.error().message);
    return std::move(script_);
  }

 private:
  base::Expected<void> add(const model::PlaceStep& step) {
    script_.name = "place on " + step.on;
    if (holder_ != nullptr) return base::failure("the part is at " + holder_->name() + " already");
    holder_ = &crew_.at(step.on);
    carried_.down = -model::Vector3d::UnitZ();
    bench::Place place{.on = holder_->node(), .grasps = {}};
    for (Member& member : crew_.members()) {
      if (!member.grips()) continue;
      place.grasps.push_back(
          {member.node(), member.design().jaw_separation_mm, member.needed_n(weight(carried_))});
    }
    const std::uint8_t node = holder_->node();
    script_.actions = {tell(bench::Enable{node, true}), tell(place), stay_armed(*holder_),
                       armed(*holder_, operate("close on the part", node,
                                               [node](auto& client) { client.close_light(node); })),
                       armed(*holder_, squeeze(*holder_))};
    script_.actions.push_back(
        until(fmt::format("{} does not come to hold the part", step.on), kSettle_us,
              [node](const auto& client) { return client.node(node).in(wire::State::Hold); }));
    script_.actions.push_back(tell(bench::Enable{node, false}));
    return {};
  }

  base::Expected<void> add(const model::RemoveStep& step) {
    script_.name = "remove from " + step.from;
    if (auto ok = at_level(step.from); !ok) return ok;
    const std::uint8_t node = holder_->node();
    script_.actions = {
        tell(bench::Enable{node, true}),
        tell(bench::Remove{node}),
        stay_armed(*holder_),
        armed(*holder_, operate("release by hand", node, [node](auto& client) { client.release(node); })),
        tell(bench::Enable{node, false}),
        pause(kHandAwayS)};
    holder_ = nullptr;
    return {};
  }

  base::Expected<void> add(const model::HandoffStep& step) {
    script_.name = fmt::format("handoff {} to {}", step.from, step.to);
    if (auto ok = at_level(step.from); !ok) return ok;
    const std::uint8_t giver = holder_->node();
    Member& taker = crew_.at(step.to);
    const std::uint8_t receiver = taker.node();
    script_.within_s = step.within_s;
    script_.tries = kHandoffTries;
    script_.reached = [giver, receiver](const jaw_client::Client& client) {
      return client.node(receiver).in(wire::State::Hold) && client.node(giver).in(wire::State::Ready);
    };
    script_.actions = {
        tell(bench::Meet{{giver, receiver}}), stay_armed(*holder_), stay_armed(taker),
        operate("offer", giver, [giver, receiver](auto& client) { client.offer(giver, receiver); }),
        operate("accept", receiver, [giver, receiver](auto& client) { client.accept(receiver, giver); })};
    script_.actions.push_back(squeeze(taker));
    script_.actions.push_back(
        until(fmt::format("{} does not let go", step.from), kSettle_us, script_.reached));
    script_.undo = {attempt(arm(taker)),  // a silence may have ended the sessions
                    attempt(arm(*holder_)),
                    attempt(operate("abort", receiver, [receiver](auto& client) { client.abort(receiver); })),
                    attempt(operate("abort", giver, [giver](auto& client) { client.abort(giver); })),
                    attempt(until("the giver holds again", kSettle_us,
                                  [giver, receiver](const jaw_client::Client& client) {
                                    const bool back = client.node(giver).in(wire::State::Hold) &&
                                                      client.node(receiver).in(wire::State::Ready);
                                    return back || client.node(receiver).in(wire::State::Hold);
                                  }))};
    holder_ = &taker;
    return {};
  }

  base::Expected<void> add(const model::MoveStep& step) {
    script_.name = "move " + step.station;
    Member& member = crew_.at(step.station);
    script_.actions.push_back(tell(bench::Move{
        member.node(), step.seconds, step.peak_g, {step.along.x(), step.along.y(), step.along.z()}}));
    if (holder_ != &member) return add_pause(step.seconds);
    return add_loads(loads_of(step, carried_, member.in_part_frame(step.along)));
  }

  base::Expected<void> add(const model::RotateStep& step) {
    script_.name =
        fmt::format("rotate {} by {:g} deg", step.station, step.angle_rad * 180 / std::numbers::pi);
    Member& member = crew_.at(step.station);
    script_.actions.push_back(tell(bench::Rotate{member.node(), step.angle_rad, step.seconds, step.peak_g}));
    if (holder_ != &member) return add_pause(step.seconds);
    const model::Vector3d axis = member.in_part_frame(model::Vector3d::UnitY());
    const std::vector<Load> loads = loads_of(step, carried_, axis);
    carried_.down = turned_down(carried_.down, axis, step.angle_rad);
    return add_loads(loads);
  }

  base::Expected<void> add(const model::SprayStep& step) {
    script_.name = "spray on " + step.on;
    if (holder_ != &crew_.at(step.on)) return base::failure("the part is not there then");
    const auto loads = loads_of(step, carried_, scene_);
    if (!loads) return tl::unexpected(loads.error());
    return add_loads(*loads);
  }

  base::Expected<void> add(const model::WaitStep& step) {
    script_.name = "wait";
    return add_pause(step.seconds);
  }

  base::Expected<void> add_pause(double seconds) {
    script_.actions.push_back(pause(seconds));
    return {};
  }

  static Action arm(const Member& member) {
    const std::uint32_t crc = wire::layout_crc_of(member.layout());
    return operate("arm", member.node(),
                   [node = member.node(), crc](auto& client) { client.arm(node, crc); });
  }

  /// Opens a session anew where a silence has ended it, as an overloaded machine may be silent for long
  /// enough.
  static Action stay_armed(const Member& member) {
    Action action = arm(member);
    action.begin = [node = member.node(), begin = std::move(action.begin)](Stage& stage) -> ActionState {
      const jaw_client::NodeView& view = stage.client.node(node);
      if (view.state && view.state->armed && stage.client.armed(node)) return Finished{};
      return begin(stage);
    };
    return action;
  }

  /// `action` on a station whose session a silence may end at any time.
  static Action armed(const Member& member, Action action) {
    return rearming(std::move(action), arm(member), member.node());
  }

  /// A station that does not grip takes part with no force: its seats are what must be stable.
  Action squeeze(const Member& member) {
    return operate("squeeze", member.node(), [node = member.node(), forces = member.squeeze()](auto& client) {
      client.squeeze(node, forces);
    });
  }

  /// The part is at `station`, the way up that handoffs and hands need.
  base::Expected<void> at_level(const std::string& station) {
    if (holder_ == nullptr || holder_->name() != station)
      return base::failure("the part is not at " + station + " then");
    const double tilt_rad = std::acos(std::clamp(carried_.down.dot(-model::Vector3d::UnitZ()), -1.0, 1.0));
    if (tilt_rad > kLevelRad) {
      return base::failure(fmt::format("{} is turned by {:.1f} deg then; rotate it back first", station,
                                       tilt_rad * 180 / std::numbers::pi));
    }
    return {};
  }

  void disturb(const std::string& name, const model::Wrench& wrench) {
    bench::Disturb request{name, {}};
    for (Member& member : crew_.members()) {
      if (!member.grips()) continue;
      const double needed_n = member.needed_n(wrench);
      request.needed.push_back({member.node(), needed_n});
      if (holder_ == &member) script_.needed_n = std::max(script_.needed_n, needed_n);
    }
    if (holder_ != nullptr) script_.required_n = holder_->design().squeeze.required_n;
    script_.actions.push_back(tell(std::move(request)));
  }

  base::Expected<void> add_loads(const std::vector<Load>& loads) {
    for (const Load& load : loads) {
      disturb(load.name, load.wrench);
      script_.actions.push_back(pause(load.seconds));
    }
    disturb("rest", weight(carried_));
    return {};
  }

  Crew& crew_;
  const planner::Scene& scene_;
  StepScript script_;
  Member* holder_ = nullptr;
  Carried carried_;
};

}  // namespace

base::Expected<std::vector<StepScript>> script_of(const model::Sequence& sequence, Crew& crew,
                                                  const planner::Scene& scene) {
  Writer writer(crew, scene);
  std::vector<StepScript> scripts;
  scripts.push_back(writer.set_up());
  for (std::size_t i = 0; i < sequence.steps.size(); ++i) {
    auto script = writer.write(sequence.steps[i]);
    if (!script) return base::failure(fmt::format("step {}: {}", i + 1, script.error().message));
    scripts.push_back(std::move(*script));
  }
  return scripts;
}

}  // namespace pinjaw::sequence
