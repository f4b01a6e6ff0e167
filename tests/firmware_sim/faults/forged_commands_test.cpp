// Promises: AUTH-COMMAND.
//
// Every command in every state of a controller with a key, from somebody who does not know the key, even with
// the hand at the station and the live challenge of a release; and as the host says it, so that it is known
// what would have been obeyed.
#include <gtest/gtest.h>

#include <map>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "firmware_sim/core/authentication.hpp"
#include "protocol/wire/names.hpp"
#include "protocol/wire/seal.hpp"
#include "tests/firmware_sim/faults/moments.hpp"
#include "tests/support/figures.hpp"

namespace pinjaw::core::test {
namespace {

using wire::Op;

constexpr int kObeying_ms = 20;
constexpr wire::Key kOtherKey{1};

/// What a controller does, but for what it says of bad commands, and what it is left with.
struct Doing {
  std::vector<Moment> moments;
  std::uint16_t session = 0;
  std::uint32_t sessions = 0;
  bool armed = false;
  bool frozen = false;
  bool opening_wanted = false;
  std::uint16_t set_dn = 0;
  std::uint16_t permit_dn = 0;
  std::uint16_t challenge = 0;
  bool challenged = false;

  [[nodiscard]] auto left() const {
    return std::tie(session, sessions, armed, frozen, opening_wanted, set_dn, permit_dn, challenge,
                    challenged);
  }
  friend bool operator==(const Doing& one, const Doing& other) {
    for (std::size_t ms = 0; ms < one.moments.size(); ++ms) {
      if (difference(one.moments[ms], other.moments[ms])) return false;
    }
    return one.left() == other.left();
  }
};

/// A scene's controller where it obeys as much as it can: with a session, the local enable on, and a question
/// for a release answered.
class Willing {
 public:
  explicit Willing(const Scene& scene) : scene_(scene), station_(scene.station), next_(scene.before) {
    station_.jaw.local_enable = true;
    if (scene.is_brief()) return;  // what comes later finds another state
    hear();
    const bool keeps_its_state = scene.state != StateId::Loaded;
    if (!station_.core.gate.armed() && keeps_its_state) obey(wire::plain_command(Op::Arm));
    if (scene.state == StateId::Hold) obey(wire::manual_release_ask());
    EXPECT_EQ(station_.id(), scene.state);
  }

  [[nodiscard]] const Scene& scene() const { return scene_; }
  [[nodiscard]] const State& core() const { return station_.core; }
  [[nodiscard]] wire::Command right(const wire::Command& command) const {
    return right_command(scene_, station_, command, scene_.is_brief() ? scene_.before.size() : 0);
  }

  /// What it does about `command`, or about nothing.
  [[nodiscard]] Doing about(const std::optional<wire::Command>& command) const {
    Willing copy = *this;
    if (command) copy.next_.push_back(wire::pack(*command, {.node = scene_.node}));
    Doing doing;
    for (int ms = 0; ms < kObeying_ms; ++ms) {
      Moment moment = copy.hear();
      moment.said.clear();
      doing.moments.push_back(moment);
    }
    const State& core = copy.core();
    doing.session = core.gate.session();
    doing.sessions = core.next_session;
    doing.armed = core.gate.armed();
    doing.frozen = core.frozen;
    doing.opening_wanted = core.opening_wanted;
    doing.set_dn = core.force_set_dn;
    doing.permit_dn = core.permit_dn;
    doing.challenge = core.challenge;
    doing.challenged = core.timers.challenge.running();
    return doing;
  }

 private:
  void obey(const wire::Command& command) {
    next_.push_back(wire::pack(right(command), {.node = scene_.node}));
    hear();
  }
  Moment hear() {
    std::vector<wire::Frame> frames = std::exchange(next_, {});
    const auto& heard = scene_.heard[ms_++];
    frames.insert(frames.end(), heard.begin(), heard.end());
    return moment_of(station_, frames);
  }

  const Scene& scene_;
  Station station_;
  std::vector<wire::Frame> next_;
  std::size_t ms_ = 0;
};

/// Every command there is, each with the arguments that are right for it.
std::vector<wire::Command> commands_for(const Willing& willing) {
  const std::uint8_t peer = willing.scene().peer;
  return {wire::plain_command(Op::Arm),
          wire::plain_command(Op::Disarm),
          wire::plain_command(Op::CloseLight),
          wire::squeeze_command({520, 1400}),
          wire::offer_command(peer),
          wire::accept_command(peer),
          wire::plain_command(Op::Abort),
          wire::plain_command(Op::OpenEmpty),
          wire::plain_command(Op::ClearFault),
          wire::manual_release_ask(),
          wire::manual_release_answer(willing.core().challenge)};
}

/// `right` as somebody says it who knows all but the key.
std::vector<wire::Command> forged(const Willing& willing, const wire::Command& right) {
  const State& core = willing.core();
  const bool arms = right.op == Op::Arm;
  const wire::Freshness freshness{.number = arms ? next_session_number(core) : core.next_session,
                                  .epoch = arms ? core.host.epoch() : core.session_epoch};
  wire::Command plain = right;
  plain.session = arms ? core.host.epoch() : core.gate.session();
  wire::Freshness stale = freshness;
  --stale.number;
  return {plain, wire::sealed(kOtherKey, willing.scene().node, right, freshness),
          wire::sealed(kSceneKey, willing.scene().peer, right, freshness),
          wire::sealed(kSceneKey, willing.scene().node, right, stale)};
}

using States = std::set<StateId>;

/// A command, and which step of it.
using Step = std::pair<Op, std::uint8_t>;

/// Where a host's command changes something. ABORT and OPEN_EMPTY find the scene's READY jaws open already.
std::map<Step, States> obeyed_in() {
  using enum wire::State;
  States armed;
  for (std::size_t s = 0; s < kStates; ++s) armed.insert(static_cast<StateId>(s));
  armed.erase(Boot);
  armed.erase(Unconfigured);  // nobody can have a session there, and so none of the others means anything
  return {{{Op::Arm, 0}, armed},
          {{Op::Disarm, 0}, {Ready}},
          {{Op::CloseLight, 0}, {Ready}},
          {{Op::Squeeze, 0}, {Seated}},
          {{Op::Offer, 0}, {Hold}},
          {{Op::Accept, 0}, {Ready}},
          {{Op::Abort, 0}, {Seating, Seated, Offered, Relax, FaultEmpty}},
          {{Op::OpenEmpty, 0}, {FaultEmpty}},
          {{Op::ClearFault, 0}, {FaultHold, FaultEmpty}},
          {{Op::ManualRelease, 1}, {Hold}},
          {{Op::ManualRelease, 2}, {Hold}}};
}

std::string told(const std::map<Step, States>& obeyed) {
  std::string text;
  for (const auto& [step, states] : obeyed) {
    text += std::string(wire::to_string(step.first)) + " " + std::to_string(step.second) + ":";
    for (const StateId state : states) text += std::string(" ") + wire::to_string(state);
    text += "\n";
  }
  return text;
}

TEST(ForgedCommands, change_nothing_in_any_state_and_the_hosts_do_where_they_are_obeyed) {
  std::map<Step, States> obeyed;
  int tried = 0;
  for (const Scene& scene : scenes(Framing::Sealed)) {
    const Willing willing(scene);
    const Doing untouched = willing.about(std::nullopt);
    for (const wire::Command& command : commands_for(willing)) {
      const wire::Command right = willing.right(command);
      const std::uint8_t step = right.op == Op::ManualRelease ? right.argument : std::uint8_t{0};
      if (willing.about(right) != untouched) obeyed[{right.op, step}].insert(scene.state);
      for (const wire::Command& bad : forged(willing, right)) {
        EXPECT_TRUE(willing.about(bad) == untouched)
            << wire::to_string(right.op) << " in " << wire::to_string(scene.state) << ", forgery "
            << tried % 4;
        ++tried;
      }
    }
  }
  EXPECT_TRUE(obeyed == obeyed_in()) << told(obeyed);
  pinjaw::test::figure("AUTH-COMMAND", "forged commands x states without an effect", tried);
}

}  // namespace
}  // namespace pinjaw::core::test
