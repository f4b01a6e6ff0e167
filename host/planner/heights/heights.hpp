#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string_view>

#include "host/base/expected.hpp"
#include "host/geometry/surface.hpp"
#include "host/model/kit.hpp"
#include "host/planner/planar/planar_fixture.hpp"

/// Phase 3: how tall each pin is and where it touches (BB 3.3).
namespace pinjaw::planner {

/// How tall one pin stands and where it touches the part: z in the part frame turned by the task's side.
struct PinHeight {
  double contact_min_mm = 0;  ///< lowest part surface over a pin eps thicker (up-large)
  double height_max_mm = 0;   ///< lowest part surface over a pin eps thinner (up-small); +inf at a silhouette
  double contact_max_mm = 0;  ///< highest part surface under height_max over a pin eps thicker (down-large)
  double z_edge_mm = 0;  ///< lowest part surface eps inside the foot; a silhouette's height where it is one
  double top_mm = 0;     ///< of the pin
  double length_mm = 0;  ///< from the plate to the top
  model::Interval contact_z_mm;  ///< part surface within 2 eps of the foot, below top; one point where lo ==
                                 ///< hi, as at a silhouette
};

/// Why a pin has no height.
enum class HeightLoss {
  NoSurfaceAtFoot,  ///< no part above the point eps inside the foot, or none within 2 eps of it below the
                    ///< pin's top
  NoStockLength,    ///< every stock length is too long
  StockTooShort,    ///< the longest stock length that fits does not reach the engagement
  NoEngagement,     ///< the room above the foot's edge is under the engagement
};
inline constexpr std::array kHeightLosses{HeightLoss::NoSurfaceAtFoot, HeightLoss::NoStockLength,
                                          HeightLoss::StockTooShort, HeightLoss::NoEngagement};
/// The name in reports: `no_surface_at_foot`.
std::string_view to_string(HeightLoss loss);

using PinHeightOutcome = base::Expected<PinHeight, HeightLoss>;

/// The first pin of a fixture that has no height.
struct FixtureHeightLoss {
  std::size_t pin = 0;
  HeightLoss reason = HeightLoss::NoEngagement;
};

/// One height for each pin, in the fixture's order.
using FixtureHeights = std::array<PinHeight, 4>;

/// The foot of a pin: where it touches, in the turned part frame. The pin's axis stands at p_PFoot - r n_P.
struct Foot {
  geometry::Vector2d p_PFoot_mm = geometry::Vector2d::Zero();
  geometry::Vector2d n_P = geometry::Vector2d::UnitX();  ///< unit, from the pin into the part
};

/// z of the plates' tops: the lowest z of the turned part and of what is attached to it, less the kit's plate
/// gap.
double plate_top_mm(const model::Kit& kit, const geometry::Surface& part,
                    std::span<const geometry::Surface> attached = {});

/// Finds pin heights on one part (DESIGN 3 phase 3; 3.1 nos 1, 2, 7, 8). A height depends on the foot alone,
/// so each foot is worked out at its place rounded to 1e-7 mm, and some ten thousand are
/// remembered. May be used from many threads; answers do not depend on their order.
class Heights {
 public:
  /// `part` is the base part's surface, turned by the task's side; `plate_top_mm` as by plate_top_mm().
  Heights(const geometry::Surface& part, const model::PinStock& pins, double plate_top_mm);
  ~Heights();

  [[nodiscard]] PinHeightOutcome at(const Foot& foot) const;
  /// All four pins.
  [[nodiscard]] base::Expected<FixtureHeights, FixtureHeightLoss> of(const PlanarFixture& fixture) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// How high the top of a pin may stand at a foot: from where it engages (lo) to where it still has room (hi).
/// Empty (lo > hi) where the room is under the engagement.
struct TopRange {
  double z_edge_mm = 0;
  model::Interval top_mm;
};

/// Nothing where no part lies above the point eps inside the foot. Stock lengths are not asked.
std::optional<TopRange> top_range(const geometry::Surface& part, const model::PinStock& pins,
                                  const Foot& foot);

/// The same for one foot, not remembered and not rounded.
PinHeightOutcome pin_height(const geometry::Surface& part, const model::PinStock& pins, double plate_top_mm,
                            const Foot& foot);

}  // namespace pinjaw::planner
