#pragma once

#include <span>

#include "host/part/placing.hpp"
#include "host/part/stl_file.hpp"

/// From an STL file's facets to a part. Private to host/part.
namespace pinjaw::part {

/// The part made of the `chosen` ones among a file's `solids`, after `rotation`; its name, file and mass are
/// left to the caller. A failure where no facet has an area.
///
/// Its features come from the mesh (contours_of), its surface is the mesh with the arcs found rounded
/// (kMeshDeflectionMm), its volume and centroid are those of the file's own facets: 0 and the centroid of the
/// area where the mesh is not closed.
base::Expected<Part> stl_part(std::span<const StlSolid> solids, std::span<const StlSolid> chosen,
                              const Matrix3d& rotation);

}  // namespace pinjaw::part
