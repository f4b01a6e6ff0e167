#include "tests/firmware_sim/model_check/search.hpp"

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <stdexcept>

#include "tests/firmware_sim/model_check/equals.hpp"
#include "tests/firmware_sim/model_check/state_set.hpp"
#include "tests/firmware_sim/model_check/words.hpp"

namespace pinjaw::core::model {
namespace {

double cpu_now_s() {
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

class Search {
 public:
  Search(const Scenario& scenario, const Bounds& bounds) : scenario_(scenario), bounds_(bounds) {
    for (const std::uint8_t node : scenario.nodes) {
      models_.push_back(std::make_unique<NodeModel>(NodeSetup{.node = node,
                                                              .nodes = scenario.nodes,
                                                              .tokens = scenario.tokens,
                                                              .release_guard = scenario.release_guard,
                                                              .misfit = scenario.misfit,
                                                              .table = scenario.table},
                                                    network_));
    }
  }

  Findings run() {
    const double start_s = cpu_now_s();
    if (bounds_.merge_equals) merge_equals();
    explore();
    if (!findings_.violation && findings_.complete && (bounds_.invariants & kWayBack) != 0) look_back();
    findings_.states = states_.size();
    findings_.cpu_s = cpu_now_s() - start_s;
    findings_.memory_bytes = states_.bytes();
    for (const auto& model : models_) {
      findings_.node_states += model->states();
      findings_.steps += model->steps();
    }
    return std::move(findings_);
  }

 private:
  void merge_equals() {
    for (std::size_t index = 0; index < models_.size(); ++index) first_state_of(index);
    work_out_all(models_, network_);
    for (const auto& model : models_) {
      equals_.push_back(first_equals(*model, network_));
      std::vector<LocalId> distinct = equals_.back();
      std::ranges::sort(distinct);
      findings_.distinct_node_states +=
          static_cast<std::size_t>(std::ranges::unique(distinct).begin() - distinct.begin());
    }
  }

  LocalId first_state_of(std::size_t index) {
    NodeModel& model = *models_[index];
    return model.node() == scenario_.loaded ? model.loaded() : model.ready();
  }

  /// What stands for the node's state `id` in the search.
  [[nodiscard]] LocalId merged(std::size_t index, LocalId id) const {
    return equals_.empty() ? id : equals_[index][id];
  }

  struct Taken {
    std::size_t index = 0;  ///< of the node
    const Move* move = nullptr;
    Said needed = 0;  ///< frames that come in this step
    std::size_t sender = 0;
  };

  /// Calls `visit(next, taken)` for every move there is in `state`, until it returns false.
  template <class Visit>
  void expand(const Global& state, Visit visit) {
    for (std::size_t index = 0; index < models_.size(); ++index) {
      NodeModel& model = *models_[index];
      const LocalId id = state.node(index);
      const auto all = [&](int message, bool peer_holds, Said needed) {
        for (const Move& move : model.moves(id, message, peer_holds)) {
          const LocalId to = merged(index, move.next);
          if (to >> Global::kBits != 0) throw std::length_error("too many states of one node");
          Global next = state.with(index, to);
          next.said |= move.said | model.chatter(to);
          if (!visit(next, Taken{.index = index, .move = &move, .needed = needed})) return false;
        }
        return true;
      };
      if (!all(-1, false, 0) || !network_.each_arrival(model.node(), state.said, all)) return;
    }
  }

  [[nodiscard]] bool asks(Invariant invariant) const { return (bounds_.invariants & invariant) != 0; }

  void explore() {
    Global first;
    for (std::size_t index = 0; index < models_.size(); ++index) {
      first = first.with(index, merged(index, first_state_of(index)));
      first.said |= models_[index]->chatter(first.node(index));
    }
    for (const Saying& saying : scenario_.history) {
      const std::optional<int> bit = saying.holds_well ? network_.heard(saying.node, saying.state)
                                                       : network_.heard(saying.node, saying.custody);
      if (bit) first.said |= Said{1} << *bit;
    }
    states_.insert(first, StateSet::kNone);
    if (const auto wrong = wrong_in(first)) return report(*wrong, 0, nullptr);
    for (std::uint32_t number = 0; number < states_.size(); ++number) {
      if (states_.size() >= bounds_.most_states) return;
      if (bounds_.progress && number % 4'000'000 == 0) say_progress(number);
      const Global state = states_.at(number);
      expand(state, [&](const Global& next, const Taken& taken) {
        ++findings_.transitions;
        if (const auto wrong = wrong_of(state, *taken.move)) return report(*wrong, number, &taken), false;
        const StateSet::Place place = states_.insert(next, number);
        if (!place.is_new) return true;
        if (const auto wrong = wrong_in(next)) return report(*wrong, place.number, nullptr), false;
        return true;
      });
      if (findings_.violation) return;
    }
    findings_.complete = true;
  }

  void say_progress(std::uint32_t number) const {
    std::fprintf(stderr, "model check: %u of %zu states expanded, %zu states of nodes, %.0f s of CPU\n",
                 number, states_.size(), models_[0]->states(), cpu_now_s());
  }

  [[nodiscard]] std::optional<Invariant> wrong_of(const Global& state, const Move& move) const {
    if (move.fault == Fault::OpensUndecided && asks(kOpensDecided)) return kOpensDecided;
    const bool first_said =
        (move.said & ~state.said & network_.takes()) != 0;  // later the handoff may be over
    if (move.fault == Fault::TakesUnlatched && first_said && asks(kTakesLatched)) return kTakesLatched;
    return std::nullopt;
  }

  [[nodiscard]] const Traits& traits(const Global& state, std::size_t index) const {
    return models_[index]->traits(state.node(index));
  }

  [[nodiscard]] bool any(const Global& state, bool Traits::*what) const {
    for (std::size_t index = 0; index < models_.size(); ++index) {
      if (traits(state, index).*what) return true;
    }
    return false;
  }

  [[nodiscard]] std::optional<Invariant> wrong_in(const Global& state) const {
    if (asks(kHeld) && !any(state, &Traits::holds)) return kHeld;
    if (asks(kGripped) && !any(state, &Traits::grips)) return kGripped;
    if (asks(kOneCustodian) &&
        (custodians(state, &Traits::stored) != 1 || custodians(state, &Traits::wanted) != 1))
      return kOneCustodian;
    return std::nullopt;
  }

  /// A node is custodian while its record says sole, offered, retained or decided, and as a latched receiver
  /// once its giver has released the token, by word or by record.
  [[nodiscard]] int custodians(const Global& state, Traits::Record Traits::*view) const {
    int count = 0;
    for (std::size_t index = 0; index < models_.size(); ++index) {
      const Traits::Record& record = traits(state, index).*view;
      switch (record.custody) {
        case Custody::Sole:
        case Custody::Offered:
        case Custody::Retained:
        case Custody::Decided:
          ++count;
          break;
        case Custody::Latched:
          if (released(state, record, scenario_.nodes[index], view)) ++count;
          break;
        case Custody::Empty:
        case Custody::Released:
          break;
      }
    }
    return count;
  }

  [[nodiscard]] bool released(const Global& state, const Traits::Record& latch, std::uint8_t receiver,
                              Traits::Record Traits::*view) const {
    if ((state.said & network_.released(latch.peer, receiver, latch.token)) != 0) return true;
    for (std::size_t index = 0; index < models_.size(); ++index) {
      if (scenario_.nodes[index] != latch.peer) continue;
      const Traits::Record& giver = traits(state, index).*view;
      if (giver.custody == Custody::Released && giver.peer == receiver && giver.token == latch.token)
        return true;
      return std::ranges::any_of(giver.outcomes, [&](const Outcome& outcome) {
        return !outcome.retained && outcome.peer == receiver && outcome.token == latch.token;
      });
    }
    return false;
  }

  [[nodiscard]] bool rests(const Global& state) const {
    int holding = 0;
    for (std::size_t index = 0; index < models_.size(); ++index) {
      const Traits& node = traits(state, index);
      if (node.rests_holding) {
        ++holding;
      } else if (!node.rests_empty) {
        return false;
      }
    }
    return holding == 1;
  }

  /// Whether the way back may go by `taken`: no mishap, and of the network only what its sender still
  /// repeats, as though every older frame were lost.
  [[nodiscard]] bool is_cooperative(const Global& state, const Taken& taken) {
    if (taken.move->stimulus.is_mishap()) return false;
    if (taken.needed == 0) return true;
    const std::uint8_t sender = network_.at(taken.move->stimulus.message).node;
    for (std::size_t index = 0; index < models_.size(); ++index) {
      if (scenario_.nodes[index] == sender)
        return (taken.needed & ~models_[index]->repeats(state.node(index))) == 0;
    }
    return false;
  }

  /// I2c: marks what leads to rest, from the last found to the first, until nothing is added.
  void look_back() {
    std::vector<bool> leads(states_.size());
    std::size_t left = states_.size();
    for (std::uint32_t number = 0; number < states_.size(); ++number) {
      if (!rests(states_.at(number))) continue;
      leads[number] = true;
      ++findings_.resting;
      --left;
    }
    for (std::size_t before = left + 1; left < before && left > 0;) {
      before = left;
      for (auto number = static_cast<std::uint32_t>(states_.size()); number-- > 0;) {
        if (leads[number]) continue;
        const Global& state = states_.at(number);
        bool found = false;
        expand(state, [&](const Global& next, const Taken& taken) {
          if (!is_cooperative(state, taken)) return true;
          const std::uint32_t place = states_.find(next);
          found = place != StateSet::kNone && leads[place];
          return !found;
        });
        if (!found) continue;
        leads[number] = true;
        --left;
      }
    }
    if (left == 0) return;
    const auto stuck = std::ranges::find(leads, false);
    report(kWayBack, static_cast<std::uint32_t>(stuck - leads.begin()), nullptr);
    findings_.violation->trace += "  (" + std::to_string(left) + " states have no way back)\n";
  }

  /// Keeps the shortest way to state `number`, and the move that follows it where one is given.
  void report(Invariant invariant, std::uint32_t number, const Taken* last) {
    std::vector<std::uint32_t> way;
    for (std::uint32_t at = number; at != StateSet::kNone; at = states_.parent(at)) way.push_back(at);
    std::ranges::reverse(way);
    std::string text = describe(states_.at(way.front()));
    for (std::size_t i = 1; i < way.size(); ++i)
      text += describe_way(states_.at(way[i - 1]), states_.at(way[i]));
    if (last != nullptr) text += describe_move(*last);
    findings_.violation = Violation{.invariant = invariant, .trace = text};
  }

  std::string describe(const Global& state) const {
    std::string text = "  at first:\n";
    for (std::size_t index = 0; index < models_.size(); ++index)
      text += "    " + station(scenario_.nodes[index]) + ": " + models_[index]->describe(state.node(index)) +
              "\n";
    return text;
  }

  std::string describe_move(const Taken& taken) const {
    return "  " + station(scenario_.nodes[taken.index]) + " " +
           model::describe(taken.move->stimulus, network_) + "\n    -> " +
           models_[taken.index]->describe(taken.move->next) + "\n";
  }

  std::string describe_way(const Global& from, const Global& to) {
    std::string text;
    expand(from, [&](const Global& next, const Taken& taken) {
      if (!(next == to)) return true;
      text = describe_move(taken);
      return false;
    });
    return text;
  }

  Scenario scenario_;
  Bounds bounds_;
  Network network_;
  std::vector<std::unique_ptr<NodeModel>> models_;
  std::vector<std::vector<LocalId>> equals_;  ///< of each node, where equal states count as one
  StateSet states_;
  Findings findings_;
};

}  // namespace

std::string name_of(Invariant invariant) {
  switch (invariant) {
    case kHeld:
      return "I2";
    case kGripped:
      return "the part is gripped";
    case kOneCustodian:
      return "I2b";
    case kWayBack:
      return "I2c";
    case kOpensDecided:
      return "opens only what is decided";
    case kTakesLatched:
      return "takes only what is latched";
    default:
      return "?";
  }
}

Findings search(const Scenario& scenario, const Bounds& bounds) {
  return Search(scenario, bounds).run();
}

}  // namespace pinjaw::core::model
