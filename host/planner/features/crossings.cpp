#include <algorithm>
#include <cmath>

#include "host/planner/features/carrier.hpp"

namespace pinjaw::planner {
namespace {

using geometry::cross;
using geometry::Vector2d;
using Points = std::vector<Vector2d>;

constexpr double kParallelSine = 1e-9;

/// Half the chord that a line at `distance_mm` from the centre cuts; 0 where it touches within tolerance.
std::optional<double> half_chord_mm(double radius_mm, double distance_mm) {
  if (distance_mm > radius_mm + kSameCarrierMm) return std::nullopt;
  return std::sqrt(std::max(0.0, (radius_mm - distance_mm) * (radius_mm + distance_mm)));
}

void line_and_line(const Carrier& a, const Carrier& b, Points& points) {
  const double sine = cross(a.along, b.along);
  if (std::abs(sine) < kParallelSine) return;
  points.push_back(a.point_at(cross(b.origin_mm - a.origin_mm, b.along) / sine));
}

void line_and_circle(const Carrier& line, const Carrier& circle, Points& points) {
  const auto half_mm = half_chord_mm(circle.radius_mm, line.distance_mm(circle.origin_mm));
  if (!half_mm) return;
  const double nearest_mm = line.position_of(circle.origin_mm);
  points.push_back(line.point_at(nearest_mm - *half_mm));
  points.push_back(line.point_at(nearest_mm + *half_mm));
}

void circle_and_circle(const Carrier& a, const Carrier& b, Points& points) {
  const Vector2d between = b.origin_mm - a.origin_mm;
  const double distance_mm = between.norm();
  if (distance_mm < kSameCarrierMm) return;
  const double along_mm =
      (distance_mm * distance_mm + a.radius_mm * a.radius_mm - b.radius_mm * b.radius_mm) / (2 * distance_mm);
  const auto half_mm = half_chord_mm(a.radius_mm, std::abs(along_mm));
  if (!half_mm) return;
  const Vector2d towards = between / distance_mm;
  const Vector2d across(-towards.y(), towards.x());
  points.push_back(a.origin_mm + along_mm * towards - *half_mm * across);
  points.push_back(a.origin_mm + along_mm * towards + *half_mm * across);
}

Points crossings(const Carrier& a, const Carrier& b) {
  Points points;
  if (!a.round && !b.round) line_and_line(a, b, points);
  if (!a.round && b.round) line_and_circle(a, b, points);
  if (a.round && !b.round) line_and_circle(b, a, points);
  if (a.round && b.round) circle_and_circle(a, b, points);
  return points;
}

/// A cut and whether it is the end of a piece, which is exact where a crossing is rounded.
struct Cut {
  double along_mm;
  bool is_end;
};

void add_crossings(const Carrier& carrier, const Carrier& other, std::vector<Cut>& cuts) {
  for (const Vector2d& p : crossings(carrier, other)) {
    const double along_mm = carrier.position_of(p);
    if (!other.covers(other.position_of(p), kSameCarrierMm)) continue;
    if (carrier.covers(along_mm, kSameCarrierMm)) cuts.push_back({along_mm, false});
  }
}

/// Of cuts nearer than kSameCarrierMm to each other one stays, the end of a piece if there is one.
std::vector<double> thinned(std::vector<Cut> cuts) {
  std::ranges::sort(cuts, {}, &Cut::along_mm);
  std::vector<Cut> kept;
  for (const Cut& cut : cuts) {
    if (kept.empty() || cut.along_mm - kept.back().along_mm > kSameCarrierMm) {
      kept.push_back(cut);
    } else if (cut.is_end && !kept.back().is_end) {
      kept.back() = cut;
    }
  }
  std::vector<double> positions;
  positions.reserve(kept.size());
  for (const Cut& cut : kept) positions.push_back(cut.along_mm);
  return positions;
}

}  // namespace

std::vector<double> split_positions_mm(const std::vector<Carrier>& carriers, std::size_t which) {
  const Carrier& carrier = carriers[which];
  std::vector<Cut> cuts;
  for (const Piece& piece : carrier.pieces) {
    cuts.push_back({piece.along_mm.lo, true});
    cuts.push_back({piece.along_mm.hi, true});
  }
  for (std::size_t i = 0; i < carriers.size(); ++i) {
    if (i != which) add_crossings(carrier, carriers[i], cuts);
  }
  return thinned(std::move(cuts));
}

}  // namespace pinjaw::planner
