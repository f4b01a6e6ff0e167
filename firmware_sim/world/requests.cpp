// What a run may ask of a world, one function a message.
#include <fmt/format.h>

#include <algorithm>

#include "firmware_sim/world/world.hpp"

namespace pinjaw::world {
namespace {

bench::Reply refused(std::string why) {
  return bench::Refused{std::move(why)};
}

std::string no_such(int number) {
  return fmt::format("there is no node {}", number);
}

/// Empty, or why the part does not go between the jaws of `one`, which meet it at `contact_mm`.
std::string why_no_room(const node::Node& one, double contact_mm) {
  const double separation_mm = one.truth().separation_mm;
  if (one.figures().passive || separation_mm >= contact_mm) return {};
  return fmt::format("the jaws of node {} are closed to {:.2f} mm, the part needs {:.2f} mm", one.number(),
                     separation_mm, contact_mm);
}

}  // namespace

bench::Reply World::handle(const bench::Request& request) {
  bench::Reply reply = std::visit([this](const auto& asked) { return carry_out(asked); }, request);
  if (!std::holds_alternative<bench::AskTruth>(request)) {
    const auto* why = std::get_if<bench::Refused>(&reply);
    log(fmt::format("{} {}", why == nullptr ? "done" : "refused", bench::encode(request)));
    if (why != nullptr) log("because " + why->reason);
  }
  return reply;
}

std::string World::why_not_at_part(const std::vector<int>& nodes) {
  for (const int number : nodes) {
    Station* one = station(number);
    if (one == nullptr) return no_such(number);
    if (one->meets || !one->known_grasp) continue;
    if (std::string why = why_no_room(*one->node, one->contact_mm); !why.empty()) return why;
  }
  return {};
}

bench::Reply World::carry_out(const bench::Place& request) {
  if (part_.here()) return refused("a part is there already");
  Station* on = station(request.on);
  if (on == nullptr) return refused(no_such(request.on));
  for (const bench::Grasp& grasp : request.grasps) {
    if (station(grasp.node) == nullptr) return refused(no_such(grasp.node));
  }
  const bool told = std::ranges::any_of(request.grasps, [&](const auto& g) { return g.node == request.on; });
  if (!told && !on->node->figures().passive) {
    return refused(fmt::format("no grasp of node {} was told", request.on));
  }
  for (const bench::Grasp& grasp : request.grasps) {
    if (grasp.node != request.on) continue;
    if (std::string why = why_no_room(*on->node, grasp.separation_mm); !why.empty()) {
      return refused(std::move(why));
    }
  }
  for (Station& one : stations_) {
    one.known_grasp = false;
    one.meets = false;
    one.needed_n = 0;
    one.forces.clear();
  }
  for (const bench::Grasp& grasp : request.grasps) {
    Station& one = *station(grasp.node);
    one.known_grasp = true;
    one.contact_mm = grasp.separation_mm;
    one.needed_n = grasp.needed_n;
  }
  on->meets = true;
  disturbance_ = "rest";
  removing_ = false;
  part_.place();
  part_.set_hand(!on->node->figures().passive);
  return bench::Done{};
}

bench::Reply World::carry_out(const bench::Remove& request) {
  Station* from = station(request.from);
  if (from == nullptr) return refused(no_such(request.from));
  if (!touches_part(*from)) return refused(fmt::format("node {} does not touch the part", request.from));
  part_.set_hand(true);
  removing_ = true;
  return bench::Done{};
}

bench::Reply World::carry_out(const bench::Meet& request) {
  if (std::string why = why_not_at_part(request.nodes); !why.empty()) return refused(std::move(why));
  const auto named = [&](const Station& one) {
    return std::ranges::find(request.nodes, one.node->number()) != request.nodes.end();
  };
  bool carried = !part_.here() || part_.hand();
  for (const Station& one : stations_) {
    const bool grips = touches_part(one) && !one.node->figures().passive;
    if (grips && !named(one)) return refused(fmt::format("node {} grips the part", one.node->number()));
    carried = carried || (touches_part(one) && named(one));
  }
  if (!carried) return refused("the part would stay behind");
  for (Station& one : stations_) one.meets = named(one);
  return bench::Done{};
}

bench::Reply World::carry_out(const bench::Enable& request) {
  Station* one = station(request.node);
  if (one == nullptr) return refused(no_such(request.node));
  one->local_enable = request.on;
  return bench::Done{};
}

bench::Reply World::travel(int number, const char* how) {
  Station* one = station(number);
  if (one == nullptr) return refused(no_such(number));
  const bool carries = has_contact(*one) && touches_part(*one);
  if (carries) {
    if (const Station* other = gripping_beside(*one)) {
      return refused(
          fmt::format("node {} cannot {}: node {} grips the part too", number, how, other->node->number()));
    }
    for (Station& each : stations_) each.meets = &each == one;
  } else if (!one->node->figures().passive) {
    one->meets = false;
  } else if (seated(*one)) {
    for (Station& each : stations_) each.meets = &each == one;
  }
  return bench::Done{};
}

bench::Reply World::carry_out(const bench::Move& request) {
  return travel(request.node, "move");
}

bench::Reply World::carry_out(const bench::Rotate& request) {
  return travel(request.node, "turn");
}

bench::Reply World::carry_out(const bench::Disturb& request) {
  for (const bench::NeededSqueeze& needed : request.needed) {
    if (station(needed.node) == nullptr) return refused(no_such(needed.node));
  }
  for (const bench::NeededSqueeze& needed : request.needed) station(needed.node)->needed_n = needed.squeeze_n;
  disturbance_ = request.name;
  return bench::Done{};
}

bench::Reply World::carry_out(const bench::Power& request) {
  Station* one = station(request.node);
  if (one == nullptr) return refused(no_such(request.node));
  one->node->set_power(request.on);
  return bench::Done{};
}

bench::Reply World::carry_out(const bench::Break& request) {
  Station* one = station(request.node);
  if (one == nullptr) return refused(no_such(request.node));
  const auto fault = node::parse_fault(request.fault);
  if (!fault) return refused(fault.error());
  one->node->apply(*fault);
  return bench::Done{};
}

bench::Reply World::carry_out(const bench::AskTruth&) const {
  return truth();
}

}  // namespace pinjaw::world
