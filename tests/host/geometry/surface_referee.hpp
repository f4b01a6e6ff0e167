#pragma once

#include "host/geometry/surface.hpp"

/// The surface's questions answered another way: each facet is cut to the slab and the region's outline,
/// taken as a fine polygon, by Sutherland and Hodgman's clipping; no index, no closed form.
namespace pinjaw::geometry::testing {

struct Bracket {
  double outer = 0;  ///< over a region that holds the exact one
  double inner = 0;  ///< over a region that the exact one holds
};

/// Between these the exact lowest (highest) z lies, up to rounding.
Bracket lowest_bracket_mm(const TriangleMesh& mesh, const Sweep& region, const Slab& slab);
Bracket highest_bracket_mm(const TriangleMesh& mesh, const Sweep& region, const Slab& slab);

/// Whether any facet reaches into the rectangle with each half extent grown by `grown_mm`, within the slab.
bool meets_rectangle(const TriangleMesh& mesh, const Rectangle& region, const Slab& slab, double grown_mm);

/// Distance to the first facet along the ray by testing all of them with plain Moeller-Trumbore; +inf where
/// none.
double first_hit_mm(const TriangleMesh& mesh, const Ray& ray);

}  // namespace pinjaw::geometry::testing
