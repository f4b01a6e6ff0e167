#pragma once

#include <vector>

#include "tests/host/planner/features/brep_part.hpp"

/// Shapes whose outline no model edge draws, or whose edges are no lines and circles.
namespace pinjaw::planner {

part::Shape ball(const Vector3d& center_mm, double radius_mm);
/// A cylinder about `axis` through the point, with its seam turned by `seam_rad` about the axis.
part::Shape rod(const Vector3d& from_mm, const Vector3d& axis, double radius_mm, double length_mm,
                double seam_rad = 0);
part::Shape cone(const Vector3d& from_mm, const Vector3d& axis, double radius_mm, double top_radius_mm,
                 double length_mm);
part::Shape ring(const Vector3d& center_mm, const Vector3d& axis, double radius_mm, double tube_mm);
/// A smooth body through ellipses of changing size, lying along x.
part::Shape lofted();
/// A prism upright over a closed smooth spline through the points.
part::Shape spline_prism(const std::vector<Vector2d>& through_mm, double height_mm);
/// A sheet bent by 90 degrees twice, inner radius r, as a channel that opens downwards; it lies along y.
part::Shape bent_sheet(double width_mm, double height_mm, double length_mm, double sheet_mm,
                       double radius_mm);
/// A box that widens upwards by the draft, its upright edges rounded.
part::Shape drafted_box(const Vector3d& size_mm, double draft_rad, double radius_mm);
/// A wire of round section wound about the z axis.
part::Shape coil(double radius_mm, double pitch_mm, double turns, double wire_mm);
part::Shape fused(const part::Shape& a, const part::Shape& b);
part::Shape cut(const part::Shape& a, const part::Shape& b);

}  // namespace pinjaw::planner
