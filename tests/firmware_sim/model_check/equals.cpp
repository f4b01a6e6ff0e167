#include "tests/firmware_sim/model_check/equals.hpp"

#include <algorithm>
#include <cstddef>
#include <map>
#include <tuple>
#include <utility>
#include <vector>

namespace pinjaw::core::model {
namespace {

struct Arrival {
  int message = -1;
  bool peer_holds = false;
};

/// What may come to the node in one step.
std::vector<Arrival> arrivals(const NodeModel& model, const Network& network) {
  std::vector<Arrival> found{{}};
  network.each_arrival(model.node(), ~Said{0}, [&](int message, bool peer_holds, Said) {
    found.push_back({.message = message, .peer_holds = peer_holds});
    return true;
  });
  return found;
}

using Token = std::tuple<std::uint8_t, std::uint16_t>;  // of a peer

/// What the search asks of a record.
struct RecordSeen {
  bool custodian = false;
  Custody handoff = Custody::Empty;  // Latched and Released, with whom
  Token token;
  std::vector<Token> released;
  auto operator<=>(const RecordSeen&) const = default;
};

RecordSeen seen(const Traits::Record& record) {
  RecordSeen seen;
  if (record.custody == Custody::Latched || record.custody == Custody::Released) {
    seen.handoff = record.custody;
    seen.token = {record.peer, record.token};
  } else {
    seen.custodian = record.custody != Custody::Empty;
  }
  for (const Outcome& outcome : record.outcomes) {
    if (!outcome.retained) seen.released.emplace_back(outcome.peer, outcome.token);
  }
  std::ranges::sort(seen.released);
  return seen;
}

using StateSeen = std::tuple<bool, bool, bool, bool, RecordSeen, RecordSeen, Said, Said>;

StateSeen seen(NodeModel& model, LocalId id) {
  const Said repeats = model.repeats(id);
  const Said chatter = model.chatter(id);
  const Traits& traits = model.traits(id);
  return {traits.grips,
          traits.holds,
          traits.rests_holding,
          traits.rests_empty,
          seen(traits.stored),
          seen(traits.wanted),
          repeats,
          chatter};
}

/// A move to a class: its arrival, mishap or not, the class, what is said, what is wrong.
using MoveSeen = std::tuple<std::uint32_t, bool, std::uint32_t, Said, Fault>;

/// Numbers its keys in the order in which they come.
template <class Key>
class Numbers {
 public:
  std::uint32_t of(Key key) {
    return numbers_.try_emplace(std::move(key), static_cast<std::uint32_t>(numbers_.size())).first->second;
  }
  [[nodiscard]] std::size_t size() const { return numbers_.size(); }

 private:
  std::map<Key, std::uint32_t> numbers_;
};

}  // namespace

void work_out_all(const std::vector<std::unique_ptr<NodeModel>>& models, const Network& network) {
  const auto size = [&] {
    std::size_t sum = 0;
    for (const auto& model : models) sum += model->states() + arrivals(*model, network).size();
    return sum;
  };
  for (std::size_t before = 0; before != size();) {
    before = size();
    for (const auto& model : models) {
      for (LocalId id = 0; id < model->states(); ++id) {
        for (const Arrival& arrival : arrivals(*model, network))
          model->moves(id, arrival.message, arrival.peer_holds);
      }
    }
  }
}

std::vector<LocalId> first_equals(NodeModel& model, const Network& network) {
  const std::vector<Arrival> all = arrivals(model, network);
  const auto states = static_cast<LocalId>(model.states());
  std::vector<std::uint32_t> classes(states);
  Numbers<StateSeen> first;
  for (LocalId id = 0; id < states; ++id) classes[id] = first.of(seen(model, id));

  const auto moves_of = [&](LocalId id) {
    std::vector<MoveSeen> moves;
    for (std::uint32_t i = 0; i < all.size(); ++i) {
      for (const Move& move : model.moves(id, all[i].message, all[i].peer_holds)) {
        const std::uint32_t next = classes[move.next];
        if (next == classes[id] && move.said == 0 && move.fault == Fault::None) continue;
        moves.emplace_back(i, move.stimulus.is_mishap(), next, move.said, move.fault);
      }
    }
    std::ranges::sort(moves);
    const auto doubled = std::ranges::unique(moves);
    moves.erase(doubled.begin(), doubled.end());
    return moves;
  };
  for (std::size_t before = 0, now = first.size(); before != now;) {
    Numbers<std::pair<std::uint32_t, std::vector<MoveSeen>>> finer;
    std::vector<std::uint32_t> next(states);
    for (LocalId id = 0; id < states; ++id) next[id] = finer.of({classes[id], moves_of(id)});
    classes = std::move(next);
    before = std::exchange(now, finer.size());
  }

  std::vector<LocalId> first_of_class(states, states);
  std::vector<LocalId> equals(states);
  for (LocalId id = 0; id < states; ++id) {
    LocalId& known = first_of_class[classes[id]];
    known = std::min(known, id);
    equals[id] = known;
  }
  return equals;
}

}  // namespace pinjaw::core::model
