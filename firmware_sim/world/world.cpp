#include "firmware_sim/world/world.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "host/base/random.hpp"

namespace pinjaw::world {
namespace {

std::uint64_t seed_of(std::uint64_t seed, int number) {
  base::Random random(seed ^ (static_cast<std::uint64_t>(number) << 32U));
  return random.bits();
}

}  // namespace

World::World(const std::vector<Member>& members, std::uint64_t seed) {
  for (const Member& member : members) {
    Station& added = stations_.emplace_back();
    added.node =
        std::make_unique<node::Node>(member.figures, seed_of(seed, member.figures.node), *member.bus);
  }
  std::ranges::sort(stations_, {}, [](const Station& one) { return one.node->number(); });
}

bus::Expected<void> World::step(unsigned elapsed_ms) {
  bus::Expected<void> result;
  for (Station& one : stations_) {
    const auto stepped = one.node->step(surroundings_of(one), elapsed_ms);
    if (!stepped && result) result = stepped;
  }
  for (unsigned i = 0; i < elapsed_ms; ++i) {
    ++elapsed_ms_;
    observe();
  }
  return result;
}

node::Node* World::find(int number) {
  Station* found = station(number);
  return found == nullptr ? nullptr : found->node.get();
}

World::Station* World::station(int number) {
  const auto found =
      std::ranges::find(stations_, number, [](const Station& one) { return one.node->number(); });
  return found == stations_.end() ? nullptr : &*found;
}

bool World::has_contact(const Station& one) const {
  return part_.here() && one.meets && one.known_grasp && !one.node->figures().passive;
}

bool World::seated(const Station& one) const {
  return part_.here() && one.meets && one.node->figures().passive;
}

bool World::touches_part(const Station& one) const {
  return seated(one) || (has_contact(one) && one.node->truth().squeeze_n > 0.0);
}

const World::Station* World::gripping_beside(const Station& one) const {
  const auto found = std::ranges::find_if(stations_, [&](const Station& other) {
    return &other != &one && has_contact(other) && touches_part(other);
  });
  return found == stations_.end() ? nullptr : &*found;
}

node::Surroundings World::surroundings_of(const Station& one) const {
  const bool neighbour_moves = std::ranges::any_of(
      stations_, [&](const Station& other) { return &other != &one && other.node->moves(); });
  return {.contact = {.present = has_contact(one),
                      .separation_m = one.contact_mm * 1e-3,
                      .fixed = gripping_beside(one) != nullptr},
          .seats_pressed = seated(one),
          .local_enable = one.local_enable,
          .neighbour_moves = neighbour_moves};
}

Touch World::touch_of(const Station& one) const {
  return {.node = one.node->number(),
          .passive = one.node->figures().passive,
          .seated = seated(one),
          .least_n = has_contact(one) ? one.node->truth().least_n : 0.0,
          .needed_n = one.needed_n};
}

void World::observe() {
  const std::vector<int> held_before = part_.holders();
  const bool slipped_before = part_.slipped();
  const bool dropped_before = part_.dropped();
  std::vector<Touch> touched;
  for (Station& one : stations_) {
    observe_station(one);
    touched.push_back(touch_of(one));
  }
  part_.observe(touched, time_s());
  let_hand_go(touched);
  if (part_.holders() != held_before) log(fmt::format("holders [{}]", fmt::join(part_.holders(), " ")));
  if (part_.slipped() && !slipped_before) log("part slips");
  if (part_.dropped() && !dropped_before) log("part dropped");
}

void World::let_hand_go(const std::vector<Touch>& touched) {
  if (!part_.hand()) return;
  const bool pressed = std::ranges::any_of(touched, [](const Touch& t) { return !t.passive && touches(t); });
  const bool waits = std::ranges::any_of(
      stations_, [this](const Station& one) { return one.local_enable && touches_part(one); });
  if (removing_ && !pressed && !waits) {
    part_.remove();
    log("part removed");
  } else if (!removing_ && !part_.holders().empty()) {
    part_.set_hand(false);
    log("the hand lets go");
  }
}

void World::observe_station(Station& one) {
  const node::Truth& truth = one.node->truth();
  const double limit_n = one.node->figures().max_squeeze_n;
  const bool contact = has_contact(one);
  if (contact) one.forces.observe(truth.least_n, truth.most_n, limit_n);
  const bool over_limit = contact && truth.most_n > limit_n;
  if (over_limit != one.over_limit) {
    log(fmt::format("node {} {} its limit: {:.1f} N", one.node->number(), over_limit ? "over" : "under",
                    truth.most_n));
  }
  one.over_limit = over_limit;
  const bool touched = touches_part(one);
  if (touched != one.touched) {
    log(fmt::format("node {} {} the part at {:.3f} mm", one.node->number(), touched ? "touches" : "leaves",
                    truth.separation_mm));
  }
  one.touched = touched;
}

bench::NodeTruth World::node_truth(const Station& one) const {
  const node::Truth& truth = one.node->truth();
  const Touch touch = touch_of(one);
  const bool contact = has_contact(one);
  return {.node = one.node->number(),
          .passive = one.node->figures().passive,
          .powered = one.node->powered(),
          .touches = touches_part(one),
          .holds = part_.here() && holds(touch),
          .seated = touch.seated,
          .separation_mm = truth.separation_mm,
          .squeeze_n = contact ? truth.squeeze_n : 0.0,
          .left_n = contact ? truth.left_n : 0.0,
          .right_n = contact ? truth.right_n : 0.0,
          .needed_n = one.needed_n,
          .limit_n = one.node->figures().max_squeeze_n,
          .max_squeeze_n = one.forces.max_n(),
          .max_steady_n = one.forces.max_steady_n(),
          .over_limit_s = one.forces.over_limit_s()};
}

bench::Truth World::truth() const {
  bench::Truth truth = {.time_s = time_s(),
                        .placed = part_.placed(),
                        .disturbance = disturbance_,
                        .holders = part_.holders(),
                        .min_holders = part_.min_holders(),
                        .slipped = part_.slipped(),
                        .slip_mm = part_.slip_mm(),
                        .dropped = part_.dropped(),
                        .dropped_at_s = part_.dropped_at_s(),
                        .nodes = {}};
  for (const Station& one : stations_) truth.nodes.push_back(node_truth(one));
  return truth;
}

void World::log(const std::string& text) const {
  if (log_) log_(fmt::format("{:.3f} {}", time_s(), text));
}

}  // namespace pinjaw::world
