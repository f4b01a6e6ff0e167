#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "host/base/expected.hpp"
#include "host/geometry/plane.hpp"

/// What stands in an STL file, before anything is made of it. Private to host/part.
namespace pinjaw::part {

using geometry::Vector3d;

struct StlFacet {
  std::array<Vector3d, 3> corners_mm;
};

/// One `solid` of an ASCII file; a binary file is one without a name.
struct StlSolid {
  std::string name;
  std::vector<StlFacet> facets;
};

/// STL has no unit; its numbers are taken as mm. A coordinate beyond this is a mistake: single precision
/// would place it to 0.008 mm only.
inline constexpr double kFarthestMm = 1e5;

/// The facets of a binary or ASCII STL file's bytes, in the file's order; at least one, at most
/// `most_facets`. Normals and attributes are passed over: the order of the corners tells the outside.
///
/// A sentence that begins with `file` and the line and column (ASCII) or the facet (binary) where the bytes
/// are empty, are no STL, are cut short, hold another number of facets than their header states, name a
/// corner that is no number or out of range, or hold too many facets. A file of 84 + 50 n bytes whose header
/// states n is binary whatever words it begins with.
base::Expected<std::vector<StlSolid>> read_stl(std::string_view bytes, const std::string& file,
                                               int most_facets);

}  // namespace pinjaw::part
