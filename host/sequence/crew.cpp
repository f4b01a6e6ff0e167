#include "host/sequence/crew.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "host/planner/plan/layout.hpp"

namespace pinjaw::sequence {

namespace {

std::uint16_t tenths_up(double force_n) {
  return wire::requirement_dn(std::llround(force_n * 1e6));
}

bool has_room(const Member& member) {
  return member.layout().peer_count < wire::kMaxPeers;
}

/// Names each of two stations in the other's layout.
void make_peers(Member& one, Member& other) {
  const wire::PairSide one_side{one.node(), wire::layout_crc_of(one.layout())};
  const wire::PairSide other_side{other.node(), wire::layout_crc_of(other.layout())};
  const std::uint16_t pair = wire::pair_crc_of(one.layout().part_id, one_side, other_side);
  const auto add = [pair](wire::Layout& layout, const wire::PairSide& peer, const wire::Layout& of_peer) {
    layout.peers[layout.peer_count++] = {peer.node, peer.layout_crc, of_peer.f_required_dn, pair};
  };
  add(one.layout(), other_side, other.layout());
  add(other.layout(), one_side, one.layout());
}

}  // namespace

Member::Member(const model::Station& station, const model::Design& design, const wire::Layout& layout)
    : name_(station.name),
      node_(static_cast<std::uint8_t>(station.node)),
      grips_(station.grips),
      side_(station.task.side),
      design_(design),
      layout_(layout) {
  if (!grips_) return;
  const int set_dn = layout.f_required_dn + tenths_up(station.task.kit.actuator.force_uncertainty_n);
  squeeze_ = {static_cast<std::uint16_t>(set_dn), layout.f_limit_dn};
  solver_.emplace(planner::grasp_of(design, station.task.friction));
}

double Member::needed_n(const model::Wrench& wrench) {
  if (!solver_) return 0;
  const planner::SqueezeOutcome outcome =
      solver_->least_squeeze(planner::turned(wrench, side_), model::FrictionModel::Cone);
  const auto* required = std::get_if<planner::Required>(&outcome);
  return required != nullptr ? std::max(0.0, required->force_n) : std::numeric_limits<double>::infinity();
}

model::Vector3d Member::in_part_frame(const model::Vector3d& v_G) const {
  const model::Vector2d plan = design_.part_pose.inverse().turned(v_G.head<2>());
  const model::Vector3d v_turned(plan.x(), plan.y(), v_G.z());
  model::Wrench as_force = model::Wrench::Zero();
  as_force.head<3>() = v_turned;
  return planner::turned(as_force, side_).head<3>();  // turning by pi undoes itself
}

base::Expected<Crew> Crew::of(const model::Cell& cell, const cell::CellDesign& design,
                              const planner::Scene& scene) {
  Crew crew;
  for (const model::Station& station : cell.stations) {
    const auto chosen = std::ranges::find(design.stations, station.name, &cell::StationDesign::station);
    const auto layout =
        planner::layout_of({station.task.kit, chosen->design, scene.part.sha256, !station.grips});
    if (!layout) return base::failure("station " + station.name + ": " + layout.error().message);
    crew.members_.emplace_back(station, chosen->design, *layout);
  }
  for (const model::Handoff& handoff : cell.handoffs) {
    Member& giver = crew.at(handoff.giver);
    Member& receiver = crew.at(handoff.receiver);
    if (!has_room(giver) || !has_room(receiver)) {
      return base::failure(
          fmt::format("station {}: it hands over to more than {} stations, which no layout can say",
                      has_room(giver) ? receiver.name() : giver.name(), wire::kMaxPeers));
    }
    make_peers(giver, receiver);
  }
  return crew;
}

Member& Crew::at(const std::string& station) {
  return *std::ranges::find(members_, station, &Member::name);
}

}  // namespace pinjaw::sequence
