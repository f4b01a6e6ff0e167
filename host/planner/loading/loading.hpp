#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string_view>

#include "host/base/expected.hpp"
#include "host/geometry/surface.hpp"
#include "host/model/design.hpp"
#include "host/model/kit.hpp"
#include "host/planner/planar/planar_fixture.hpp"

/// Phase 4: can the gripper come along z with open jaws and close on the part (BB 3.4)?
namespace pinjaw::planner {

/// Why a fixture does not load: what stopped its least shift.
enum class LoadingLoss {
  NoShift,    ///< no column shift brings the jaw separation into range, or the pins do not fit the plates
  NoOpening,  ///< the jaws cannot open by kLeastOpening_mm each
  PinSweep,   ///< a pin meets the part on its way from open to closed
  PinMeetsObstacle,    ///< a pin meets an obstacle or attached part, closing or while the open gripper comes
                       ///< along z
  PlateMeetsObstacle,  ///< a plate meets the part, an obstacle or attached part
};
inline constexpr std::array kLoadingLosses{LoadingLoss::NoShift, LoadingLoss::NoOpening,
                                           LoadingLoss::PinSweep, LoadingLoss::PinMeetsObstacle,
                                           LoadingLoss::PlateMeetsObstacle};
/// The name in reports: `no_shift`.
std::string_view to_string(LoadingLoss loss);

/// Least travel of a jaw that counts as opening (CONTRACT: kit file, opening_mm).
inline constexpr double kLeastOpening_mm = 1.0;

enum class SweepHeights {
  Pins,      ///< each pin sweeps as high as it stands
  Infinite,  ///< `--loading 2d`: pins as tall as the part, BB's fast test
};

/// What the gripper must not touch, in the part frame turned by the task's side.
struct Surroundings {
  const geometry::Surface* part = nullptr;    ///< the base part; not null
  std::span<const geometry::Surface> others;  ///< attached parts and obstacles
  double plate_top_mm = 0;                    ///< as by plate_top_mm() of phase 3
};

/// The height that phase 3 found for one pin of a planar fixture.
struct PinToLoad {
  std::size_t pin = 0;  ///< its place in the fixture's pins
  double length_mm = 0;
  double top_mm = 0;
  model::Interval contact_z_mm;
};

/// What a gripper does when it loads.
enum class JawMotion {
  Closes,  ///< a vise: comes along z open, then closes
  None,    ///< a pallet: the part comes down along z on pins that stand still (three pins, DESIGN 3)
};

struct LoadingOptions {
  SweepHeights sweeps = SweepHeights::Pins;
  JawMotion motion = JawMotion::Closes;
};

/// The geometry of the design at the least column shift that loads, rows centred; the other loading shifts as
/// its alternatives. Id and squeeze are left empty.
///
/// Rule of contact: every pin sweeps with radius r - eps, the thinner pin of phase 3, so that the contact
/// itself is no hit; nor is what lies above the pin's top. Since a pin is a column from below, a sweep that
/// misses the part also clears the way along z. Obstacles and attached parts must stay clear of the full pins
/// by the kit's clearance, and of the plates by it in plan. `pins` are those of the fixture that stand, in
/// its order: all four; a pallet's three.
base::Expected<model::Design, LoadingLoss> load(const PlanarFixture& fixture, std::span<const PinToLoad> pins,
                                                const model::Kit& kit, const Surroundings& surroundings,
                                                const LoadingOptions& options = {});

}  // namespace pinjaw::planner
