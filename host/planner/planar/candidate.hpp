#pragma once

#include <array>
#include <optional>
#include <vector>

#include "host/model/kit.hpp"
#include "host/planner/planar/contact_state.hpp"

namespace pinjaw::planner::planar {

/// Which curve a pin touches and its hole, counted from the innermost used column of its jaw and a common
/// row.
struct CandidatePin {
  int curve = 0;
  bool left = true;
  int column = 0;
  int row = 0;
};

/// Four pins and roughly where they hold the part.
struct Candidate {
  std::array<CandidatePin, 4> pins;
  Placement placement;
  double closure_margin = 0;
};

/// Decides whether candidates are planar fixtures, cheapest test first.
class Judge {
 public:
  Judge(const std::vector<ContactCurve>& curves, const std::vector<model::Feature>& features,
        const model::Kit& kit);

  /// `candidate` with its exact placement and margin where it is a fixture; nothing where it is none.
  [[nodiscard]] std::optional<Candidate> judged(Candidate candidate) const;

  [[nodiscard]] Touch touch(const CandidatePin& pin) const {
    return touch_of(curves_[static_cast<std::size_t>(pin.curve)], pin.left, pin.column, pin.row,
                    kit_.grid.spacing_mm);
  }

  /// Distance from the foot of a pin centred at `q_mm` in the part frame to the nearer end of its feature.
  [[nodiscard]] double foot_margin_mm(const ContactCurve& curve, const Vector2d& q_mm) const;
  /// Arc length of that foot on its feature.
  [[nodiscard]] double foot_along_mm(const ContactCurve& curve, const Vector2d& q_mm) const;

 private:
  [[nodiscard]] bool fits_plates(const Candidate& candidate) const;
  [[nodiscard]] bool span_in_range(const Candidate& candidate) const;
  [[nodiscard]] bool jaws_overlap(const Candidate& candidate) const;
  [[nodiscard]] bool feet_hold(const std::array<Touch, 4>& touches, const std::array<ContactState, 4>& states,
                               double theta_rad) const;

  const std::vector<ContactCurve>& curves_;
  const std::vector<model::Feature>& features_;
  const model::Kit& kit_;
};

}  // namespace pinjaw::planner::planar
