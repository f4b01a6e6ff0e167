#pragma once

#include <gp_XYZ.hxx>

#include "host/geometry/plane.hpp"

/// OpenCASCADE's values as ours. Only for sources of host/part that include its headers anyway.
namespace pinjaw::part {

inline geometry::Vector3d vector_of(const gp_XYZ& v) {
  return {v.X(), v.Y(), v.Z()};
}

}  // namespace pinjaw::part
