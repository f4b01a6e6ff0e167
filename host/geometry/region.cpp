#include "host/geometry/region.hpp"

#include <algorithm>
#include <cmath>

namespace pinjaw::geometry {
namespace {

constexpr Interval kNothing{1, 0};

/// The part of a + t d inside the disc. Half the chord comes from the distance of the line, which loses
/// nothing on long pieces, rather than from the discriminant.
Interval clip_to_disc(const Vector2d& a_mm, const Vector2d& d_mm, const Vector2d& center_mm,
                      double radius_mm) {
  const Vector2d m_mm = a_mm - center_mm;
  const double d2 = d_mm.squaredNorm();
  if (d2 < kPoint_mm * kPoint_mm) return m_mm.norm() <= radius_mm ? Interval{0, 1} : kNothing;
  const double area = cross(m_mm, d_mm);
  const double chord2 = radius_mm * radius_mm * d2 - area * area;
  if (chord2 < 0) return kNothing;
  const double middle = -m_mm.dot(d_mm) / d2;
  const double half = std::sqrt(chord2) / d2;
  return {std::max(0.0, middle - half), std::min(1.0, middle + half)};
}

/// Cuts `t` to where lo <= start + t slope <= hi.
void cut(Interval& t, double start, double slope, const Interval& range) {
  if (slope == 0) {
    if (!range.contains(start)) t = kNothing;
    return;
  }
  const double t1 = (range.lo - start) / slope;
  const double t2 = (range.hi - start) / slope;
  t.lo = std::max(t.lo, std::min(t1, t2));
  t.hi = std::min(t.hi, std::max(t1, t2));
}

Interval hull(const Interval& a, const Interval& b) {
  if (a.lo > a.hi) return b;
  if (b.lo > b.hi) return a;
  return {std::min(a.lo, b.lo), std::max(a.hi, b.hi)};
}

}  // namespace

Stadium::Stadium(const Sweep& sweep)
    : from_mm_(sweep.from_mm),
      to_mm_(sweep.to_mm),
      radius_mm_(sweep.radius_mm + kTouch_mm),
      length_mm_((sweep.to_mm - sweep.from_mm).norm()),
      along_(Vector2d::Zero()),
      across_(Vector2d::Zero()),
      reach_{sweep.from_mm.cwiseMin(sweep.to_mm).array() - radius_mm_,
             sweep.from_mm.cwiseMax(sweep.to_mm).array() + radius_mm_} {
  if (length_mm_ < kPoint_mm) return;
  along_ = (to_mm_ - from_mm_) / length_mm_;
  across_ = across(along_);
  along_span_mm_ = span(along_);
  across_span_mm_ = span(across_);
}

Interval Stadium::clip(const Vector2d& a_mm, const Vector2d& b_mm) const {
  const Vector2d d_mm = b_mm - a_mm;
  const Interval first = clip_to_disc(a_mm, d_mm, from_mm_, radius_mm_);
  if (length_mm_ < kPoint_mm) return first;
  const Interval last = clip_to_disc(a_mm, d_mm, to_mm_, radius_mm_);
  Interval middle{0, 1};
  cut(middle, along_.dot(a_mm - from_mm_), along_.dot(d_mm), {0, length_mm_});
  cut(middle, across_.dot(a_mm - from_mm_), across_.dot(d_mm), {-radius_mm_, radius_mm_});
  return hull(hull(first, last), middle);
}

Vector2d Stadium::support(const Vector2d& direction) const {
  const Vector2d& end_mm = direction.dot(to_mm_ - from_mm_) > 0 ? to_mm_ : from_mm_;
  const double length = direction.norm();
  if (length == 0) return end_mm;
  return end_mm + direction * (radius_mm_ / length);
}

Oblong::Oblong(const Rectangle& rectangle)
    : center_mm_(rectangle.center_mm),
      along_(rectangle.direction),
      across_(across(rectangle.direction)),
      half_mm_(rectangle.half_mm.array() + kTouch_mm) {
  const Vector2d half_mm = along_.cwiseAbs() * half_mm_.x() + across_.cwiseAbs() * half_mm_.y();
  reach_ = {center_mm_ - half_mm, center_mm_ + half_mm};
  along_span_mm_ = span(along_);
  across_span_mm_ = span(across_);
}

Interval Oblong::clip(const Vector2d& a_mm, const Vector2d& b_mm) const {
  Interval t{0, 1};
  const Vector2d d_mm = b_mm - a_mm;
  cut(t, along_.dot(a_mm - center_mm_), along_.dot(d_mm), {-half_mm_.x(), half_mm_.x()});
  cut(t, across_.dot(a_mm - center_mm_), across_.dot(d_mm), {-half_mm_.y(), half_mm_.y()});
  return t;
}

Vector2d Oblong::support(const Vector2d& direction) const {
  return center_mm_ + along_ * std::copysign(half_mm_.x(), along_.dot(direction)) +
         across_ * std::copysign(half_mm_.y(), across_.dot(direction));
}

}  // namespace pinjaw::geometry
