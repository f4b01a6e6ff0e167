#include "host/planner/interference/interference.hpp"

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>

namespace pinjaw::planner {
namespace {

using geometry::Block;
using geometry::Rectangle;
using geometry::Solid;
using geometry::Sweep;
using geometry::SweptCylinder;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// What a gripper does during a check.
enum class Motion {
  Closed,
  Moves,  ///< from closed to open, or back
  Away,   ///< open, anywhere along z between the part and far off
};

/// Far off lies below for a gripper from below, above for one from above.
Interval reach_z(const FingerSet& set, const Interval& z_mm, Motion motion) {
  if (motion != Motion::Away) return z_mm;
  return set.side == model::Side::Below ? Interval{-kInfinity, z_mm.hi} : Interval{z_mm.lo, kInfinity};
}

bool overlap_in_z(const Interval& a, const Interval& b) {
  return a.lo < b.hi && b.lo < a.hi;
}

struct Track {
  Vector2d from_mm;
  Vector2d to_mm;
};

Track track_of(const Finger& pin, Motion motion) {
  switch (motion) {
    case Motion::Closed:
      return {pin.closed_mm, pin.closed_mm};
    case Motion::Moves:
      return {pin.closed_mm, pin.open_mm};
    case Motion::Away:
      return {pin.open_mm, pin.open_mm};
  }
  return {pin.closed_mm, pin.open_mm};
}

double distance2_mm2(const Vector2d& p_mm, const Track& track) {
  const Vector2d d_mm = track.to_mm - track.from_mm;
  const double d2 = d_mm.squaredNorm();
  const double t = d2 > 0 ? std::clamp(d_mm.dot(p_mm - track.from_mm) / d2, 0.0, 1.0) : 0.0;
  return (track.from_mm + t * d_mm - p_mm).squaredNorm();
}

/// Of two tracks at least one is a point: only one gripper moves in each check.
double distance2_mm2(const Track& a, const Track& b) {
  return a.from_mm == a.to_mm ? distance2_mm2(a.from_mm, b) : distance2_mm2(b.from_mm, a);
}

/// Solids are handed to libccd in an order of their own, so that the answer does not depend on who gives.
bool comes_first(const Solid& a, const Solid& b) {
  const auto place = [](const Solid& solid) {
    if (const auto* pin = std::get_if<SweptCylinder>(&solid)) {
      return std::array{pin->z_mm.lo, pin->plan.from_mm.x(), pin->plan.from_mm.y(), pin->plan.radius_mm};
    }
    const auto& block = std::get<Block>(solid);
    return std::array{block.z_mm.lo, block.plan.center_mm.x(), block.plan.center_mm.y(),
                      block.plan.half_mm.x()};
  };
  return place(a) < place(b);
}

bool overlapping(const Solid& a, const Solid& b) {
  const auto found = comes_first(a, b) ? geometry::overlap(a, b) : geometry::overlap(b, a);
  return found != geometry::Overlap::Apart;
}

/// Two grippers in one check, giver first.
struct Scene {
  const FingerSet& giver;
  const FingerSet& receiver;
  Motion giver_motion;
  Motion receiver_motion;

  [[nodiscard]] double clearance_mm() const { return std::max(giver.clearance_mm, receiver.clearance_mm); }
};

struct Actor {
  const FingerSet& set;
  Motion motion;
};

Solid solid_of(const Actor& actor, const Finger& pin, double grown_mm) {
  const Track track = track_of(pin, actor.motion);
  return SweptCylinder{Sweep{track.from_mm, track.to_mm, actor.set.radius_mm + grown_mm},
                       reach_z(actor.set, pin.z_mm, actor.motion)};
}

/// Plates move along their own first axis, so what one sweeps is a longer rectangle.
Solid solid_of(const Actor& actor, const Plate& plate, double grown_mm) {
  Rectangle plan = plate.closed;
  plan.half_mm.array() += grown_mm;
  if (actor.motion == Motion::Away) plan.center_mm += plate.opening_mm;
  if (actor.motion == Motion::Moves) {
    plan.center_mm += plate.opening_mm / 2;
    plan.half_mm.x() += plate.opening_mm.norm() / 2;
  }
  return Block{plan, reach_z(actor.set, plate.z_mm, actor.motion)};
}

bool pins_clash(const Actor& a, const Finger& a_pin, const Actor& b, const Finger& b_pin,
                double clearance_mm) {
  const bool away = a.motion == Motion::Away || b.motion == Motion::Away;
  // Pins side by side are told from each other by the check of the way to where the open gripper leaves from.
  if (away && overlap_in_z(a_pin.z_mm, b_pin.z_mm)) return false;
  if (!overlap_in_z(reach_z(a.set, a_pin.z_mm, a.motion), reach_z(b.set, b_pin.z_mm, b.motion))) return false;
  const double reach_mm = a.set.radius_mm + b.set.radius_mm + clearance_mm;
  if (distance2_mm2(track_of(a_pin, a.motion), track_of(b_pin, b.motion)) >= reach_mm * reach_mm)
    return false;
  return overlapping(solid_of(a, a_pin, clearance_mm / 2), solid_of(b, b_pin, clearance_mm / 2));
}

/// Any of the checks of two pins, most of which end with their heights.
bool pins_ever_clash(const FingerSet& a, const Finger& a_pin, const FingerSet& b, const Finger& b_pin,
                     double clearance_mm) {
  const auto clash = [&](Motion a_motion, Motion b_motion) {
    return pins_clash({a, a_motion}, a_pin, {b, b_motion}, b_pin, clearance_mm);
  };
  if (overlap_in_z(a_pin.z_mm, b_pin.z_mm)) {
    return clash(Motion::Moves, Motion::Closed) || clash(Motion::Closed, Motion::Moves);
  }
  return clash(Motion::Away, Motion::Closed) || clash(Motion::Closed, Motion::Away);
}

bool pins_ever_clash(const FingerSet& a, const FingerSet& b) {
  const double clearance_mm = std::max(a.clearance_mm, b.clearance_mm);
  for (int i = 0; i < a.pin_count; ++i) {
    for (int j = 0; j < b.pin_count; ++j) {
      const Finger& a_pin = a.pins[static_cast<std::size_t>(i)];
      if (pins_ever_clash(a, a_pin, b, b.pins[static_cast<std::size_t>(j)], clearance_mm)) return true;
    }
  }
  return false;
}

using Clash = std::pair<FingerName, FingerName>;

std::optional<Clash> pin_clash(const Scene& scene) {
  const Actor giver{scene.giver, scene.giver_motion};
  const Actor receiver{scene.receiver, scene.receiver_motion};
  for (int i = 0; i < giver.set.pin_count; ++i) {
    for (int j = 0; j < receiver.set.pin_count; ++j) {
      const auto& a = giver.set.pins[static_cast<std::size_t>(i)];
      const auto& b = receiver.set.pins[static_cast<std::size_t>(j)];
      if (pins_clash(giver, a, receiver, b, scene.clearance_mm())) {
        return Clash{{FingerKind::Pin, i}, {FingerKind::Pin, j}};
      }
    }
  }
  return std::nullopt;
}

/// Whether the plates of `a` may meet anything of `b`, by heights alone.
bool plates_reach(const Actor& a, const Actor& b) {
  if (a.set.plate_count == 0) return false;
  const Interval z_mm = reach_z(a.set, a.set.plates_z_mm, a.motion);
  if (overlap_in_z(z_mm, reach_z(b.set, b.set.pins_z_mm, b.motion))) return true;
  return b.set.plate_count > 0 && overlap_in_z(z_mm, reach_z(b.set, b.set.plates_z_mm, b.motion));
}

/// First finger of `b` that a plate of `a` meets.
std::optional<Clash> plate_clash(const Actor& a, const Actor& b, double clearance_mm) {
  if (!plates_reach(a, b)) return std::nullopt;
  for (int i = 0; i < a.set.plate_count; ++i) {
    const Solid plate = solid_of(a, a.set.plates[static_cast<std::size_t>(i)], clearance_mm / 2);
    for (int j = 0; j < b.set.pin_count; ++j) {
      const Solid pin = solid_of(b, b.set.pins[static_cast<std::size_t>(j)], clearance_mm / 2);
      if (overlapping(plate, pin)) return Clash{{FingerKind::Plate, i}, {FingerKind::Pin, j}};
    }
    for (int j = 0; j < b.set.plate_count; ++j) {
      const Solid other = solid_of(b, b.set.plates[static_cast<std::size_t>(j)], clearance_mm / 2);
      if (overlapping(plate, other)) return Clash{{FingerKind::Plate, i}, {FingerKind::Plate, j}};
    }
  }
  return std::nullopt;
}

std::optional<Clash> plate_clash(const Scene& scene) {
  const Actor giver{scene.giver, scene.giver_motion};
  const Actor receiver{scene.receiver, scene.receiver_motion};
  if (const auto plates = plate_clash(giver, receiver, scene.clearance_mm())) return plates;
  if (const auto plates = plate_clash(receiver, giver, scene.clearance_mm())) {
    return Clash{plates->second, plates->first};
  }
  return std::nullopt;
}

std::optional<Clash> clash(const Scene& scene) {
  if (const auto pins = pin_clash(scene)) return pins;
  return plate_clash(scene);
}

/// The first pin of `reaching` that reaches the floor on which the part of `resting` lies, touching included.
std::optional<int> floor_clash(const FingerSet& resting, const FingerSet& reaching) {
  if (!resting.floor_z_mm || reaching.side == resting.side) return std::nullopt;
  for (int i = 0; i < reaching.pin_count; ++i) {
    const Interval& z_mm = reaching.pins[static_cast<std::size_t>(i)].z_mm;
    const bool reaches =
        resting.side == model::Side::Below ? z_mm.lo <= *resting.floor_z_mm : z_mm.hi >= *resting.floor_z_mm;
    if (reaches) return i;
  }
  return std::nullopt;
}

struct Check {
  HandoffCheck name;
  Motion giver;
  Motion receiver;
};
constexpr std::array kChecks{Check{HandoffCheck::BothClosed, Motion::Closed, Motion::Closed},
                             Check{HandoffCheck::GiverMoves, Motion::Moves, Motion::Closed},
                             Check{HandoffCheck::ReceiverMoves, Motion::Closed, Motion::Moves},
                             Check{HandoffCheck::GiverLeaves, Motion::Away, Motion::Closed},
                             Check{HandoffCheck::ReceiverComes, Motion::Closed, Motion::Away}};

}  // namespace

std::string_view to_string(HandoffCheck check) {
  switch (check) {
    case HandoffCheck::None:
      return "none";
    case HandoffCheck::Floor:
      return "floor";
    case HandoffCheck::BothClosed:
      return "both_closed";
    case HandoffCheck::GiverMoves:
      return "giver_moves";
    case HandoffCheck::ReceiverMoves:
      return "receiver_moves";
    case HandoffCheck::GiverLeaves:
      return "giver_leaves";
    case HandoffCheck::ReceiverComes:
      return "receiver_comes";
  }
  return "?";
}

HandoffVerdict check_handoff(const FingerSet& giver, const FingerSet& receiver) {
  if (const auto pin = floor_clash(giver, receiver)) {
    return {HandoffCheck::Floor, {FingerKind::Floor, 0}, {FingerKind::Pin, *pin}};
  }
  if (const auto pin = floor_clash(receiver, giver)) {
    return {HandoffCheck::Floor, {FingerKind::Pin, *pin}, {FingerKind::Floor, 0}};
  }
  for (const Check& check : kChecks) {
    const auto found = clash({giver, receiver, check.giver, check.receiver});
    if (found) return {check.name, found->first, found->second};
  }
  return {};
}

bool reaches_floor(const FingerSet& giver, const FingerSet& receiver) {
  return floor_clash(giver, receiver) || floor_clash(receiver, giver);
}

bool compatible(const FingerSet& giver, const FingerSet& receiver) {
  if (reaches_floor(giver, receiver)) return false;
  if (pins_ever_clash(giver, receiver)) return false;
  return std::none_of(kChecks.begin(), kChecks.end(), [&](const Check& check) {
    return plate_clash({giver, receiver, check.giver, check.receiver}).has_value();
  });
}

}  // namespace pinjaw::planner
