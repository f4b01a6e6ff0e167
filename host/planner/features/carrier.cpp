#include "host/planner/features/carrier.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace pinjaw::planner {
namespace {

using geometry::Vector2d;

constexpr double kTurn = 2 * std::numbers::pi;

Carrier carrier_of(const geometry::Curve& curve) {
  Carrier carrier;
  if (const auto* segment = std::get_if<geometry::Segment>(&curve)) {
    carrier.origin_mm = segment->a_mm;
    carrier.along = (segment->b_mm - segment->a_mm).normalized();
    return carrier;
  }
  const auto& arc = std::get<geometry::Arc>(curve);
  carrier.round = true;
  carrier.origin_mm = arc.center_mm;
  carrier.radius_mm = arc.radius_mm;
  return carrier;
}

bool lies_on(const Carrier& carrier, const PlanCurve& candidate) {
  const double length_mm = geometry::length_mm(candidate.curve);
  const auto* arc = std::get_if<geometry::Arc>(&candidate.curve);
  if (carrier.round != (arc != nullptr)) return false;
  if (arc != nullptr && candidate.error_mm <= model::kExactMm) {
    return (arc->center_mm - carrier.origin_mm).norm() <= kSameCarrierMm &&
           std::abs(arc->radius_mm - carrier.radius_mm) <= kSameCarrierMm;
  }
  return std::ranges::all_of(std::array{0.0, length_mm / 2, length_mm}, [&](double along_mm) {
    return carrier.distance_mm(geometry::point_at(candidate.curve, along_mm)) <= kSameCarrierMm;
  });
}

void add_piece(Carrier& carrier, const PlanCurve& candidate) {
  const auto add = [&](double lo_mm, double hi_mm) {
    carrier.pieces.push_back({{lo_mm, hi_mm}, &candidate});
  };
  const double length_mm = geometry::length_mm(candidate.curve);
  const double from_mm = carrier.position_of(geometry::point_at(candidate.curve, 0));
  if (!carrier.round) {
    const double to_mm = carrier.position_of(geometry::point_at(candidate.curve, length_mm));
    add(std::min(from_mm, to_mm), std::max(from_mm, to_mm));
    return;
  }
  const double whole_mm = carrier.circumference_mm();
  if (length_mm > whole_mm - kSameCarrierMm) {
    add(0, whole_mm);
  } else if (from_mm + length_mm <= whole_mm) {
    add(from_mm, from_mm + length_mm);
  } else {
    add(from_mm, whole_mm);
    add(0, from_mm + length_mm - whole_mm);
  }
}

void bridge(Carrier& carrier) {
  std::ranges::stable_sort(carrier.pieces, {}, [](const Piece& piece) { return piece.along_mm.lo; });
  Piece* reaching = nullptr;
  for (Piece& piece : carrier.pieces) {
    if (reaching != nullptr) {
      const double gap_mm = piece.along_mm.lo - reaching->along_mm.hi;
      if (0 < gap_mm && gap_mm < kBridgedMm) reaching->along_mm.hi = piece.along_mm.lo;
    }
    if (reaching == nullptr || piece.along_mm.hi > reaching->along_mm.hi) reaching = &piece;
  }
}

}  // namespace

Vector2d Carrier::point_at(double along_mm) const {
  if (!round) return origin_mm + along_mm * along;
  return origin_mm + radius_mm * geometry::direction(along_mm / radius_mm);
}

Vector2d Carrier::right_at(double along_mm) const {
  return round ? geometry::direction(along_mm / radius_mm) : Vector2d(along.y(), -along.x());
}

double Carrier::position_of(const Vector2d& p_mm) const {
  const Vector2d spoke = p_mm - origin_mm;
  return round ? radius_mm * geometry::wrapped_rad(std::atan2(spoke.y(), spoke.x())) : along.dot(spoke);
}

double Carrier::distance_mm(const Vector2d& p_mm) const {
  const Vector2d spoke = p_mm - origin_mm;
  if (round) return std::abs(spoke.norm() - radius_mm);
  return std::abs(along.x() * spoke.y() - along.y() * spoke.x());
}

double Carrier::circumference_mm() const {
  return kTurn * radius_mm;
}

bool Carrier::covers(double along_mm, double margin_mm) const {
  return std::ranges::any_of(pieces, [&](const Piece& piece) {
    return piece.along_mm.lo - margin_mm <= along_mm && along_mm <= piece.along_mm.hi + margin_mm;
  });
}

std::vector<const PlanCurve*> Carrier::curves_at(double along_mm) const {
  std::vector<const PlanCurve*> curves;
  for (const Piece& piece : pieces) {
    if (piece.along_mm.contains(along_mm)) curves.push_back(piece.curve);
  }
  return curves;
}

geometry::Curve Carrier::curve_over(const geometry::Interval& stretch_mm, FreeSide side) const {
  if (round) {
    return geometry::Arc{origin_mm, radius_mm, stretch_mm.lo / radius_mm,
                         std::min(stretch_mm.length() / radius_mm, kTurn)};
  }
  if (side == FreeSide::Left) return geometry::Segment{point_at(stretch_mm.hi), point_at(stretch_mm.lo)};
  return geometry::Segment{point_at(stretch_mm.lo), point_at(stretch_mm.hi)};
}

std::vector<Carrier> carriers_of(const Projection& projection) {
  std::vector<const PlanCurve*> longest_first;
  longest_first.reserve(projection.curves.size());
  for (const PlanCurve& curve : projection.curves) longest_first.push_back(&curve);
  std::ranges::stable_sort(longest_first, {}, [](const PlanCurve* curve) {
    return std::pair(curve->error_mm > model::kExactMm, -geometry::length_mm(curve->curve));
  });
  std::vector<Carrier> carriers;
  for (const PlanCurve* curve : longest_first) {
    auto found =
        std::ranges::find_if(carriers, [&](const Carrier& carrier) { return lies_on(carrier, *curve); });
    if (found == carriers.end()) found = carriers.insert(carriers.end(), carrier_of(curve->curve));
    add_piece(*found, *curve);
  }
  for (Carrier& carrier : carriers) bridge(carrier);
  return carriers;
}

}  // namespace pinjaw::planner
