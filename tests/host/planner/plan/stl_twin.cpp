#include "tests/host/planner/plan/stl_twin.hpp"

#include <BRepMesh_IncrementalMesh.hxx>
#include <BRepTools.hxx>
#include <BRep_Tool.hxx>
#include <Poly_Triangulation.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Shape.hxx>
#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <numbers>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <tuple>

#include "host/planner/features/features.hpp"
#include "host/planner/heights/heights.hpp"
#include "host/planner/planar/planar.hpp"
#include "tests/host/part/stl_bytes.hpp"

namespace pinjaw::planner {
namespace {

using geometry::Vector2d;

constexpr double kFootMm = 0.05;    // a foot this near a feature, and facing its way, is on it
constexpr double kSameWay = 0.999;  // cosine between a pin's normal and a feature's

/// Jaw, column and row of each pin, the least column of each jaw and the least row being 0.
using Holes = std::vector<std::tuple<int, int, int>>;

template <class Pins>
Holes holes_of(const Pins& pins) {
  std::array<int, 2> least_column{1000, 1000};
  int least_row = 1000;
  for (const auto& pin : pins) {
    auto& least = least_column[static_cast<std::size_t>(pin.hole.jaw)];
    least = std::min(least, pin.hole.column);
    least_row = std::min(least_row, pin.hole.row);
  }
  Holes holes;
  for (const auto& pin : pins) {
    holes.emplace_back(static_cast<int>(pin.hole.jaw),
                       pin.hole.column - least_column[static_cast<std::size_t>(pin.hole.jaw)],
                       pin.hole.row - least_row);
  }
  std::ranges::sort(holes);
  return holes;
}

/// As the gripper turned by 180 degrees has them.
Holes twin_of(const Holes& holes) {
  int most_row = 0;
  for (const auto& [jaw, column, row] : holes) most_row = std::max(most_row, row);
  Holes twin;
  for (const auto& [jaw, column, row] : holes) twin.emplace_back(1 - jaw, column, most_row - row);
  std::ranges::sort(twin);
  return twin;
}

double turn_between(double a_rad, double b_rad) {
  return std::abs(std::remainder(a_rad - b_rad, 2 * std::numbers::pi));
}

/// Feet of a design in the part frame, in any order: what a pose comes to, whatever the shifts and the twin.
std::vector<Vector2d> feet_of(const model::Design& design) {
  std::vector<Vector2d> feet;
  for (const auto& pin : design.pins) feet.emplace_back(design.part_pose.inverse() * pin.contact_mm);
  return feet;
}

bool same_feet(const std::vector<Vector2d>& a, const std::vector<Vector2d>& b, double within_mm) {
  return std::ranges::all_of(a, [&](const Vector2d& p) {
    return std::ranges::any_of(b, [&](const Vector2d& q) { return (p - q).norm() <= within_mm; });
  });
}

bool same_pose(const model::Design& a, const model::Design& b, bool twin, const PoseTolerance& tolerance) {
  const double half_turn = twin ? std::numbers::pi : 0;
  return turn_between(a.part_pose.theta_rad + half_turn, b.part_pose.theta_rad) <= tolerance.turn_rad;
}

/// The place on the curve nearest to the point, as an arc length.
double nearest_along_mm(const geometry::Curve& curve, const Vector2d& p_mm) {
  const double length_mm = geometry::length_mm(curve);
  if (const auto* segment = std::get_if<geometry::Segment>(&curve)) {
    return std::clamp((segment->b_mm - segment->a_mm).normalized().dot(p_mm - segment->a_mm), 0.0, length_mm);
  }
  const auto& arc = std::get<geometry::Arc>(curve);
  const Vector2d spoke = p_mm - arc.center_mm;
  const double along_rad = geometry::wrapped_rad(std::atan2(spoke.y(), spoke.x()) - arc.from_rad);
  if (along_rad <= arc.sweep_rad) return along_rad * arc.radius_mm;
  const bool nearer_end = along_rad - arc.sweep_rad < 2 * std::numbers::pi - along_rad;
  return nearer_end ? length_mm : 0;
}

enum class Standing { NoFeature, OutOfReach, Stands };

Standing standing_of(const Vector2d& foot_mm, const Vector2d& n_P,
                     const std::vector<model::Feature>& features) {
  Standing best = Standing::NoFeature;
  for (const model::Feature& feature : features) {
    const double along_mm = nearest_along_mm(feature.curve, foot_mm);
    if ((geometry::point_at(feature.curve, along_mm) - foot_mm).norm() > kFootMm) continue;
    if (-n_P.dot(model::outward_normal_at(feature, along_mm)) < kSameWay) continue;
    best = std::max(best, Standing::OutOfReach);
    if (std::ranges::any_of(feature.reach_mm, [&](const geometry::Interval& reach) {
          return reach.lo <= along_mm && along_mm <= reach.hi;
        })) {
      return Standing::Stands;
    }
  }
  return best;
}

/// Everything of the other part that tells why it lacks a design.
class Lacking {
 public:
  explicit Lacking(const Sound& other)
      : features_(find_features(other.scene.turned, other.task.kit.pins).features),
        fixtures_(plan_planar_fixtures(features_, other.task.kit, {.twins = Twins::Once}).fixtures),
        heights_(other.scene.turned.surface, other.task.kit.pins,
                 plate_top_mm(other.task.kit, other.scene.turned.surface)) {
    for (std::size_t i = 0; i < fixtures_.size(); ++i) by_holes_[holes_of(fixtures_[i].pins)].push_back(i);
  }

  [[nodiscard]] std::string why(const model::Design& design) const {
    const geometry::Pose2 back = design.part_pose.inverse();
    Standing worst = Standing::Stands;
    for (const auto& pin : design.pins) {
      worst = std::min(worst, standing_of(back * pin.contact_mm, back.turned(pin.normal), features_));
    }
    if (worst == Standing::NoFeature) return "a foot is on no feature";
    if (worst == Standing::OutOfReach) return "a foot is out of a feature's reach";
    const auto feet = feet_of(design);
    for (const Holes& holes : {holes_of(design.pins), twin_of(holes_of(design.pins))}) {
      const auto found = by_holes_.find(holes);
      if (found == by_holes_.end()) continue;
      for (const std::size_t i : found->second) {
        std::vector<Vector2d> others;
        for (const auto& pin : fixtures_[i].pins) others.push_back(pin.p_PFoot_mm);
        if (!same_feet(feet, others, 2 * kFootMm)) continue;
        const auto heights = heights_.of(fixtures_[i]);
        if (!heights) return "height: " + std::string(to_string(heights.error().reason));
        return "loading, or a pose beyond the tolerance";
      }
    }
    return "no such planar fixture";
  }

 private:
  std::vector<model::Feature> features_;
  std::vector<PlanarFixture> fixtures_;
  Heights heights_;
  std::map<Holes, std::vector<std::size_t>> by_holes_;
};

}  // namespace

std::string stl_of(const part::Shape& shape, double deflection_mm) {
  constexpr double kAngularRad = 0.5;
  BRepTools::Clean(*shape);
  const BRepMesh_IncrementalMesh mesher(*shape, deflection_mm, false, kAngularRad, false);
  geometry::TriangleMesh mesh;
  for (TopExp_Explorer it(*shape, TopAbs_FACE); it.More(); it.Next()) {
    const TopoDS_Face& face = TopoDS::Face(it.Current());
    TopLoc_Location location;
    const Handle(Poly_Triangulation) triangles = BRep_Tool::Triangulation(face, location);
    if (triangles.IsNull()) continue;
    const int first = static_cast<int>(mesh.vertices_mm.size()) - 1;
    for (Standard_Integer i = 1; i <= triangles->NbNodes(); ++i) {
      const gp_Pnt p = triangles->Node(i).Transformed(location.Transformation());
      mesh.vertices_mm.emplace_back(p.X(), p.Y(), p.Z());
    }
    for (Standard_Integer i = 1; i <= triangles->NbTriangles(); ++i) {
      Standard_Integer a = 0;
      Standard_Integer b = 0;
      Standard_Integer c = 0;
      triangles->Triangle(i).Get(a, b, c);
      if (face.Orientation() == TopAbs_REVERSED) std::swap(b, c);
      mesh.triangles.push_back({first + a, first + b, first + c});
    }
  }
  BRepTools::Clean(*shape);
  return part::binary_stl(mesh);
}

part::Shape shape_in(const std::string& file) {
  std::ifstream in(file);
  std::stringstream text;
  text << in.rdbuf();
  auto solids = part::read_step(text.str(), file);
  if (!solids) throw std::runtime_error(solids.error().message);
  return part::compound_of(*solids);
}

Sound sound_designs(const std::string& file, const model::Kit& kit) {
  model::Task task;
  task.name = file;
  task.part.file = file;
  task.part.density_g_cm3 = 2.7;
  task.kit = kit;
  task.friction = 0.3;
  auto scene = read_scene(task);
  if (!scene) throw std::runtime_error(scene.error().message);
  std::vector<model::Design> designs;
  auto counts = find_candidates(task, *scene, {.top = 0}, {}, [&](std::vector<model::Design> more) {
    std::ranges::move(more, std::back_inserter(designs));
  });
  if (!counts) throw std::runtime_error(counts.error().message);
  return {std::move(task), std::move(*scene), std::move(*counts), std::move(designs)};
}

std::vector<int> matches(const std::vector<model::Design>& a, const std::vector<model::Design>& b,
                         const PoseTolerance& tolerance) {
  std::map<Holes, std::vector<int>> by_holes;
  for (std::size_t i = 0; i < b.size(); ++i) by_holes[holes_of(b[i].pins)].push_back(static_cast<int>(i));
  std::vector<int> result;
  for (const model::Design& design : a) {
    const auto feet = feet_of(design);
    const Holes holes = holes_of(design.pins);
    int match = -1;
    for (const bool twin : {false, true}) {
      const auto found = by_holes.find(twin ? twin_of(holes) : holes);
      if (found == by_holes.end()) continue;
      for (const int i : found->second) {
        const model::Design& other = b[static_cast<std::size_t>(i)];
        if (match < 0 && same_pose(design, other, twin, tolerance) &&
            same_feet(feet, feet_of(other), tolerance.shift_mm)) {
          match = i;
        }
      }
    }
    result.push_back(match);
  }
  return result;
}

Share share_of(const Sound& in, const Sound& other) {
  const auto found = matches(in.designs, other.designs);
  Share share{.designs = found.size(), .matched = 0, .lacking = {}};
  std::optional<Lacking> lacking;
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (found[i] >= 0) {
      ++share.matched;
      continue;
    }
    if (!lacking) lacking.emplace(other);
    ++share.lacking[lacking->why(in.designs[i])];
  }
  return share;
}

}  // namespace pinjaw::planner
