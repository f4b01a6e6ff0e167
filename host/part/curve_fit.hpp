#pragma once

#include <optional>
#include <span>

#include "host/part/curves.hpp"

namespace pinjaw::part {

/// A line or circle and how far the samples that it was recognised in lie from it.
struct Recognised {
  Curve3 curve;
  double error_mm = 0;
};

/// The line or circle that all `samples` (in order along one curve) lie on within `tolerance_mm`; nothing
/// where there is none. A closed curve repeats its first sample as its last.
std::optional<Recognised> recognised(std::span<const Vector3d> samples, double tolerance_mm);

}  // namespace pinjaw::part
