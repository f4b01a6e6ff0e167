#include "host/planner/loading/path.hpp"

#include <algorithm>
#include <limits>

#include "host/model/tolerance.hpp"
#include "host/planner/loading/covered.hpp"

namespace pinjaw::planner {
namespace {

using geometry::Slab;
using geometry::Surface;
using geometry::Sweep;
using geometry::Vector2d;
using model::JawSide;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

}  // namespace

Path::Path(const PlanarFixture& fixture, std::span<const PinToLoad> pins, const model::Kit& kit,
           const Surroundings& surroundings, const LoadingOptions& options)
    : kit_(kit),
      surroundings_(surroundings),
      options_(options),
      solids_(model::jaw_solids(kit)),
      clear_mm_(-1),
      blocked_mm_(kInfinity) {
  const Vector2d closing_P = geometry::direction(-fixture.theta_rad);
  for (const PinToLoad& pin : pins) {
    const PlanarPin& planar = fixture.pins[pin.pin];
    pins_.push_back({.closed_mm = planar.p_PFoot_mm - kit.pins.radius_mm * planar.n_P,
                     .outwards = sign_of_outwards(planar.hole.jaw) * closing_P,
                     .top_mm = pin.top_mm});
    if (options.sweeps == SweepHeights::Infinite) pins_.back().top_mm = kInfinity;
    if (std::find(jaws_.begin(), jaws_.end(), planar.hole.jaw) == jaws_.end())
      jaws_.push_back(planar.hole.jaw);
  }
}

std::optional<LoadingLoss> Path::loss_at(const PlacedFixture& placed) {
  double opening_mm = 0;
  if (options_.motion == JawMotion::Closes) {
    opening_mm =
        (model::open_separation_mm(kit_.jaws, placed.jaw_separation_mm) - placed.jaw_separation_mm) / 2;
    if (opening_mm < kLeastOpening_mm) return LoadingLoss::NoOpening;
  }
  if (pins_meet_part(opening_mm)) return LoadingLoss::PinSweep;
  if (pins_meet_others(opening_mm)) return LoadingLoss::PinMeetsObstacle;
  if (jaws_meet_anything(placed, opening_mm)) return LoadingLoss::PlateMeetsObstacle;
  return std::nullopt;
}

bool Path::pins_meet_part(double opening_mm) {
  if (opening_mm <= clear_mm_) return false;
  if (opening_mm >= blocked_mm_) return true;
  const bool met = std::any_of(pins_.begin(), pins_.end(), [&](const Pin& pin) {
    const Sweep sweep{pin.closed_mm, pin.closed_mm + opening_mm * pin.outwards,
                      kit_.pins.radius_mm - model::kEps_mm};
    return surroundings_.part->meets(sweep, Slab{.hi_mm = pin.top_mm});
  });
  (met ? blocked_mm_ : clear_mm_) = opening_mm;
  return met;
}

bool Path::pins_meet_others(double opening_mm) const {
  const double clearance_mm = kit_.pins.clearance_mm;
  const double radius_mm = kit_.pins.radius_mm + clearance_mm;
  for (const Pin& pin : pins_) {
    const Vector2d open_mm = pin.closed_mm + opening_mm * pin.outwards;
    const Slab standing{surroundings_.plate_top_mm, pin.top_mm + clearance_mm};
    const Slab coming{.hi_mm = pin.top_mm + clearance_mm};
    for (const Surface& other : surroundings_.others) {
      if (other.meets(Sweep{pin.closed_mm, open_mm, radius_mm}, standing)) return true;
      if (other.meets(Sweep{open_mm, open_mm, radius_mm}, coming)) return true;
    }
  }
  return false;
}

bool Path::solid_meets_anything(const model::JawBody& solid, const PlacedFixture& placed, JawSide jaw,
                                double opening_mm) const {
  const Slab standing = heights_of(solid, surroundings_.plate_top_mm);
  const Slab coming{.hi_mm = standing.hi_mm};
  const ClosedJaw closed{jaw, placed.jaw_separation_mm, placed.part_pose};
  const double clearance_mm = kit_.pins.clearance_mm;
  const auto in_the_way = [&](const Surface& surface) {
    if (surface.z_range_mm().lo > standing.hi_mm) return false;
    return surface.meets(covered(solid, closed, {0, opening_mm}, clearance_mm), standing) ||
           surface.meets(covered(solid, closed, {opening_mm, opening_mm}, clearance_mm), coming);
  };
  return in_the_way(*surroundings_.part) ||
         std::any_of(surroundings_.others.begin(), surroundings_.others.end(), in_the_way);
}

bool Path::jaws_meet_anything(const PlacedFixture& placed, double opening_mm) const {
  return std::any_of(jaws_.begin(), jaws_.end(), [&](JawSide jaw) {
    return std::any_of(solids_.begin(), solids_.end(), [&](const model::JawBody& solid) {
      return solid_meets_anything(solid, placed, jaw, opening_mm);
    });
  });
}

}  // namespace pinjaw::planner
