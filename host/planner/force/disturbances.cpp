#include "host/planner/force/disturbances.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <type_traits>

#include "host/planner/force/source_loads.hpp"

namespace pinjaw::planner {
namespace {

using model::Disturbance;
using model::Wrench;
using Loads = base::Expected<std::vector<Disturbance>>;

constexpr std::size_t kMostLoads = 1'000'000;  // chosen: some 100 MB, and minutes for a thousand fixtures

/// Both at once, told by both names; a name left empty says nothing.
Disturbance both(const Disturbance& one, const Disturbance& other) {
  const char* between = one.name.empty() || other.name.empty() ? "" : " with ";
  return {one.name + between + other.name, one.wrench + other.wrench};
}

/// One load for each choice of one from each list.
std::vector<Disturbance> choices(const std::vector<Disturbance>& ones,
                                 const std::vector<Disturbance>& others) {
  std::vector<Disturbance> all;
  all.reserve(ones.size() * others.size());
  for (const Disturbance& one : ones) {
    for (const Disturbance& other : others) all.push_back(both(one, other));
  }
  return all;
}

Loads named_loads(const model::SingleSource& source, const Body& body) {
  const auto loads = loads_of(source, body);
  if (!loads) return tl::unexpected(loads.error());
  std::vector<Disturbance> all;
  for (const SourceLoad& load : *loads) all.push_back({full_name(name_of(source), load.label), load.wrench});
  return all;
}

/// The loads of sources that act at the same time; one without wrench where there are none.
Loads simultaneous(const std::vector<model::SingleSource>& sources, const Body& body) {
  std::vector<Disturbance> all = {{"", Wrench::Zero()}};
  for (const model::SingleSource& source : sources) {
    const Loads loads = named_loads(source, body);
    if (!loads) return loads;
    all = choices(all, *loads);
  }
  return all;
}

/// A source as the list of those that act at the same time, and the name of that list where it has one.
struct Group {
  std::string name;
  std::vector<model::SingleSource> of;
};

Group group_of(const model::DisturbanceSource& source) {
  if (const auto* together = std::get_if<model::Together>(&source))
    return {together->name.empty() ? "together" : together->name, together->of};
  Group group;
  std::visit(
      [&](const auto& each) {
        if constexpr (!std::is_same_v<std::decay_t<decltype(each)>, model::Together>) group.of = {each};
      },
      source);
  return group;
}

Loads loads_of_group(const Group& group, const Body& body) {
  Loads loads = simultaneous(group.of, body);
  if (loads && !group.name.empty()) {
    for (Disturbance& load : *loads) load.name = full_name(group.name, load.name);
  }
  return loads;
}

std::size_t count_of_group(const Group& group) {
  std::size_t count = 1;
  for (const model::SingleSource& source : group.of)
    count = std::min(kMostLoads + 1, count * std::min(kMostLoads, count_of(source)));
  return count;
}

/// What acts always: each of its states with each disturbance. Where there is but one state it goes unnamed.
Loads always_of(const model::Task& task, const Body& body) {
  std::vector<Disturbance> states = {{"", Wrench::Zero()}};
  for (const model::DisturbanceSource& source : task.always) {
    const Loads loads = loads_of_group(group_of(source), body);
    if (!loads) return loads;
    states = choices(states, *loads);
  }
  if (states.size() == 1) states.front().name.clear();
  return states;
}

/// Several loads of one source share their source's number: `spray[3]`, then `spray#2[3]`.
void tell_apart(std::vector<Disturbance>& loads, std::map<std::string, int>& seen) {
  if (loads.empty()) return;
  const std::string base = loads.front().name.substr(0, loads.front().name.find('['));
  const int number = ++seen[base];
  if (number == 1) return;
  for (Disturbance& load : loads) load.name.insert(base.size(), fmt::format("#{}", number));
}

base::Expected<void> refuse_too_many(const model::Task& task) {
  std::size_t states = 1;
  for (const model::DisturbanceSource& source : task.always)
    states = std::min(kMostLoads + 1, states * count_of_group(group_of(source)));
  std::size_t loads = 0;
  for (const model::DisturbanceSource& source : task.disturbances)
    loads = std::min(kMostLoads + 1, loads + count_of_group(group_of(source)));
  if ((loads + 1) * states <= kMostLoads) return {};
  return base::failure(
      fmt::format("the disturbances, each with each state of always, are more than {} loads", kMostLoads));
}

}  // namespace

base::Expected<std::vector<Disturbance>> disturbances_of(const model::Task& task, const Body& body) {
  if (const auto few = refuse_too_many(task); !few) return tl::unexpected(few.error());
  const Loads always = always_of(task, body);
  if (!always) return always;
  std::vector<Disturbance> all;
  std::map<std::string, int> seen;
  for (const model::DisturbanceSource& source : task.disturbances) {
    Loads loads = loads_of_group(group_of(source), body);
    if (!loads) return loads;
    tell_apart(*loads, seen);
    for (Disturbance& load : choices(*loads, *always)) all.push_back(std::move(load));
  }
  if (task.always.empty()) return all;
  // by itself, too: with both ends of a load among the loads, it may also come in part
  for (Disturbance state : *always) {
    if (always->size() == 1) state.name = "always";
    all.push_back(std::move(state));
  }
  return all;
}

base::Expected<std::vector<Jet>> jets_of(const model::Task& task, const Body& body) {
  const Loads always = always_of(task, body);
  if (!always) return tl::unexpected(always.error());
  std::vector<Jet> jets;
  for (const model::DisturbanceSource& source : task.disturbances) {
    Group group = group_of(source);
    const auto is_spray = [](const model::SingleSource& each) {
      return std::holds_alternative<model::Spray>(each);
    };
    const auto found = std::find_if(group.of.begin(), group.of.end(), is_spray);
    if (found == group.of.end()) continue;
    const auto spray = std::get<model::Spray>(*found);
    const std::string name = group.name.empty() ? name_of(*found) : group.name;
    group.of.erase(found);
    const Loads others = simultaneous(group.of, body);
    if (!others) return tl::unexpected(others.error());
    jets.push_back({name, spray, choices(*others, *always)});
  }
  return jets;
}

Wrench turned(const Wrench& wrench, model::Side side) {
  if (side == model::Side::Below) return wrench;
  Wrench result = wrench;
  for (const int k : {0, 2, 3, 5}) result[k] = -result[k];
  return result;
}

std::vector<Wrench> turned_wrenches(const std::vector<Disturbance>& disturbances, model::Side side) {
  std::vector<Wrench> wrenches;
  wrenches.reserve(disturbances.size());
  for (const Disturbance& disturbance : disturbances) wrenches.push_back(turned(disturbance.wrench, side));
  return wrenches;
}

}  // namespace pinjaw::planner
