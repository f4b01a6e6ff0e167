#include "host/part/brep_distance.hpp"

#include <BRepBndLib.hxx>
#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakeVertex.hxx>
#include <BRepBuilderAPI_MakeWire.hxx>
#include <BRepClass3d_SolidClassifier.hxx>
#include <BRepExtrema_DistShapeShape.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakePrism.hxx>
#include <BRep_Tool.hxx>
#include <Bnd_Box.hxx>
#include <GC_MakeArcOfCircle.hxx>
#include <Standard_Failure.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Solid.hxx>
#include <algorithm>
#include <cmath>
#include <gp_Quaternion.hxx>
#include <utility>

namespace pinjaw::part {
namespace {

using geometry::Rectangle;
using geometry::Slab;
using geometry::Sweep;

constexpr double kMeets_mm = 1e-7;  // OpenCASCADE's own confusion: nearer is touching
constexpr double kBeyond_mm = 1;    // chosen: how far an endless column reaches past the body
constexpr double kPoint_mm = 1e-7;  // lengths under it are none
constexpr double kSameStep = 1.01;  // a bracket of one step, however it is rounded
constexpr double kStepGrowth = 8;   // chosen: a guess is nearly right or of no use

gp_Pnt at(const Vector2d& p_mm, double z_mm) {
  return {p_mm.x(), p_mm.y(), z_mm};
}

gp_Dir direction_of(const Vector2d& v) {
  return {v.x(), v.y(), 0};
}

TopoDS_Shape upright_line(const Vector2d& p_mm, const Slab& slab) {
  if (slab.hi_mm - slab.lo_mm < kPoint_mm) return BRepBuilderAPI_MakeVertex(at(p_mm, slab.lo_mm)).Shape();
  return BRepBuilderAPI_MakeEdge(at(p_mm, slab.lo_mm), at(p_mm, slab.hi_mm)).Shape();
}

TopoDS_Shape stadium(const Sweep& sweep, const Slab& slab) {
  const Vector2d along = (sweep.to_mm - sweep.from_mm).normalized();
  const Vector2d aside_mm = sweep.radius_mm * Vector2d(-along.y(), along.x());
  const double z_mm = slab.lo_mm;
  const gp_Pnt right_from = at(sweep.from_mm - aside_mm, z_mm);
  const gp_Pnt right_to = at(sweep.to_mm - aside_mm, z_mm);
  const gp_Pnt left_to = at(sweep.to_mm + aside_mm, z_mm);
  const gp_Pnt left_from = at(sweep.from_mm + aside_mm, z_mm);
  const auto half = [&](const gp_Pnt& a, const Vector2d& tip_mm, const gp_Pnt& b) {
    return BRepBuilderAPI_MakeEdge(GC_MakeArcOfCircle(a, at(tip_mm, z_mm), b).Value()).Edge();
  };
  BRepBuilderAPI_MakeWire wire;
  wire.Add(BRepBuilderAPI_MakeEdge(right_from, right_to).Edge());
  wire.Add(half(right_to, sweep.to_mm + sweep.radius_mm * along, left_to));
  wire.Add(BRepBuilderAPI_MakeEdge(left_to, left_from).Edge());
  wire.Add(half(left_from, sweep.from_mm - sweep.radius_mm * along, right_from));
  const TopoDS_Face face = BRepBuilderAPI_MakeFace(wire.Wire(), true).Face();
  return BRepPrimAPI_MakePrism(face, gp_Vec(0, 0, slab.hi_mm - slab.lo_mm)).Shape();
}

TopoDS_Shape solid_of(const Sweep& sweep, Slab slab) {
  const bool disc = (sweep.to_mm - sweep.from_mm).norm() < kPoint_mm;
  if (disc && sweep.radius_mm < kPoint_mm) return upright_line(sweep.from_mm, slab);
  slab.hi_mm = std::max(slab.hi_mm, slab.lo_mm + 2 * kPoint_mm);
  if (!disc) return stadium(sweep, slab);
  const gp_Ax2 axis(at(sweep.from_mm, slab.lo_mm), gp::DZ());
  return BRepPrimAPI_MakeCylinder(axis, sweep.radius_mm, slab.hi_mm - slab.lo_mm).Shape();
}

TopoDS_Shape solid_of(const Rectangle& rectangle, const Slab& slab) {
  const Vector2d across(-rectangle.direction.y(), rectangle.direction.x());
  const Vector2d corner_mm =
      rectangle.center_mm - rectangle.half_mm.x() * rectangle.direction - rectangle.half_mm.y() * across;
  const gp_Ax2 axes(at(corner_mm, slab.lo_mm), gp::DZ(), direction_of(rectangle.direction));
  return BRepPrimAPI_MakeBox(axes, 2 * rectangle.half_mm.x(), 2 * rectangle.half_mm.y(),
                             std::max(slab.hi_mm - slab.lo_mm, 2 * kPoint_mm))
      .Shape();
}

/// By how much a column can shrink before nothing is left of it.
double half_width_mm(const Column& column) {
  if (const auto* sweep = std::get_if<Sweep>(&column.region)) return sweep->radius_mm;
  return std::get<Rectangle>(column.region).half_mm.minCoeff();
}

Column shrunk(Column column, double by_mm) {
  if (auto* sweep = std::get_if<Sweep>(&column.region)) {
    sweep->radius_mm -= by_mm;
  } else {
    std::get<Rectangle>(column.region).half_mm.array() -= by_mm;
  }
  column.slab.lo_mm += by_mm;
  column.slab.hi_mm -= by_mm;
  return column;
}

Bnd_Box box_of(const TopoDS_Shape& shape) {
  Bnd_Box box;
  BRepBndLib::Add(shape, box, false);
  return box;
}

double distance_mm(const TopoDS_Face& face, const TopoDS_Shape& solid) {
  const BRepExtrema_DistShapeShape measured(face, solid);
  if (!measured.IsDone() || measured.NbSolution() == 0) {
    throw Standard_Failure("the distance to one of its faces cannot be computed");
  }
  return measured.Value();
}

}  // namespace

struct ExactFaces::Held {
  struct Face {
    TopoDS_Face face;
    Bnd_Box box;
  };
  TopoDS_Shape shape;
  std::vector<Face> faces;
  Bnd_Box box;
  double tolerance_mm = 0;

  /// The slab, its endless ends cut to just past the body.
  [[nodiscard]] Slab cut(Slab slab) const {
    if (std::isinf(slab.lo_mm)) slab.lo_mm = std::min(slab.hi_mm, box.CornerMin().Z()) - kBeyond_mm;
    if (std::isinf(slab.hi_mm)) slab.hi_mm = std::max(slab.lo_mm, box.CornerMax().Z()) + kBeyond_mm;
    return slab;
  }

  [[nodiscard]] bool meets(const Column& column) const {
    if (column.slab.lo_mm > column.slab.hi_mm) return false;
    const TopoDS_Shape solid = made(column);
    const Bnd_Box near = box_of(solid);
    return std::ranges::any_of(faces, [&](const Face& face) {
      return near.Distance(face.box) <= kMeets_mm && part::distance_mm(face.face, solid) <= kMeets_mm;
    });
  }

  /// To the nearest face, those with the nearest boxes first.
  [[nodiscard]] double distance_mm(const Column& column) const {
    const TopoDS_Shape solid = made(column);
    const Bnd_Box from = box_of(solid);
    std::vector<std::pair<double, const Face*>> near;
    near.reserve(faces.size());
    for (const Face& face : faces) near.emplace_back(from.Distance(face.box), &face);
    std::ranges::sort(near, {}, [](const auto& entry) { return entry.first; });
    double least_mm = std::numeric_limits<double>::infinity();
    for (const auto& [at_least_mm, face] : near) {
      if (at_least_mm >= least_mm || least_mm <= kMeets_mm) break;
      least_mm = std::min(least_mm, part::distance_mm(face->face, solid));
    }
    return least_mm;
  }

  /// Whether the column, which meets no face, lies in the material.
  [[nodiscard]] bool holds(const Column& column) const {
    const Slab& slab = column.slab;
    if (slab.lo_mm < box.CornerMin().Z() || slab.hi_mm > box.CornerMax().Z()) return false;
    const auto* sweep = std::get_if<Sweep>(&column.region);
    const Vector2d p_mm = sweep != nullptr ? sweep->from_mm : std::get<Rectangle>(column.region).center_mm;
    for (TopExp_Explorer it(shape, TopAbs_SOLID); it.More(); it.Next()) {
      const BRepClass3d_SolidClassifier where(it.Current(), at(p_mm, slab.lo_mm), kMeets_mm);
      if (where.State() == TopAbs_IN) return true;
    }
    return false;
  }

  [[nodiscard]] static TopoDS_Shape made(const Column& column) {
    return std::visit([&](const auto& region) { return solid_of(region, column.slab); }, column.region);
  }
};

ExactFaces::ExactFaces(const Shape& shape, const Eigen::Isometry3d& pose) {
  const Eigen::Quaterniond turn(pose.linear());
  gp_Trsf motion;
  motion.SetRotation(gp_Quaternion(turn.x(), turn.y(), turn.z(), turn.w()));
  motion.SetTranslationPart({pose.translation().x(), pose.translation().y(), pose.translation().z()});
  auto held = std::make_unique<Held>();
  held->shape = shape->Moved(motion);
  for (TopExp_Explorer it(held->shape, TopAbs_FACE); it.More(); it.Next()) {
    const TopoDS_Face& face = TopoDS::Face(it.Current());
    held->faces.push_back({face, box_of(face)});
    held->box.Add(held->faces.back().box);
    held->tolerance_mm = std::max(held->tolerance_mm, BRep_Tool::Tolerance(face));
  }
  for (TopExp_Explorer it(held->shape, TopAbs_EDGE); it.More(); it.Next()) {
    held->tolerance_mm = std::max(held->tolerance_mm, BRep_Tool::Tolerance(TopoDS::Edge(it.Current())));
  }
  held_ = std::move(held);
}

ExactFaces::~ExactFaces() = default;

double ExactFaces::tolerance_mm() const {
  return held_->tolerance_mm;
}

double ExactFaces::distance_mm(const Column& asked) const {
  const auto by = [&](double shrunk_mm) {
    const Column column = shrunk(asked, shrunk_mm);
    return Column{column.region, held_->cut(column.slab)};
  };
  const auto meets = [&](double shrunk_mm) {
    const Column column = by(shrunk_mm);
    return held_->meets(column) || held_->holds(column);
  };
  const Column whole = by(0);
  const double apart_mm = held_->distance_mm(whole);
  if (apart_mm > kMeets_mm) return held_->holds(whole) ? -apart_mm : apart_mm;
  const double most_mm =
      std::min(half_width_mm(asked), (asked.slab.hi_mm - asked.slab.lo_mm) / 2) - kPoint_mm;
  double meets_mm = 0;
  double clear_mm = kHeightStep_mm;
  while (clear_mm < most_mm && meets(clear_mm)) {
    meets_mm = clear_mm;
    clear_mm *= kStepGrowth;
  }
  if (meets_mm == 0) return 0;
  if (clear_mm >= most_mm) {
    if (meets(most_mm)) return -most_mm;
    clear_mm = most_mm;
  }
  while (clear_mm - meets_mm > kHeightStep_mm) {
    const double middle_mm = std::midpoint(meets_mm, clear_mm);
    (meets(middle_mm) ? meets_mm : clear_mm) = middle_mm;
  }
  return -clear_mm;
}

double ExactFaces::height_mm(const Column& asked, End end, double guess_mm) const {
  const Slab slab = held_->cut(asked.slab);
  // counted the way the column grows: upwards to the lowest z, downwards to the highest
  const double way = end == End::Lowest ? 1 : -1;
  double clear_mm = end == End::Lowest ? slab.lo_mm : -slab.hi_mm;
  double met_mm = end == End::Lowest ? slab.hi_mm : -slab.lo_mm;
  const auto reached = [&](double along_mm) {
    Column column{asked.region, slab};
    (end == End::Lowest ? column.slab.hi_mm : column.slab.lo_mm) = way * along_mm;
    return held_->meets(column);
  };
  const double end_mm = met_mm;
  const auto within = [&](double along_mm) { return along_mm > clear_mm && along_mm < met_mm; };
  const auto narrow = [&](double along_mm) {
    const bool met = reached(along_mm);
    (met ? met_mm : clear_mm) = along_mm;
    return met;
  };
  const double guess_along_mm = way * guess_mm;
  double step_mm = kHeightStep_mm / 2;
  if (within(guess_along_mm +
             step_mm)) {  // from the guess in growing steps until the surface lies between two
    const bool past = narrow(guess_along_mm + step_mm);
    double next_mm = 0;
    do {
      next_mm = guess_along_mm + (past ? -step_mm : step_mm * kStepGrowth);
      step_mm *= kStepGrowth;
    } while (within(next_mm) && narrow(next_mm) == past);
  }
  if (met_mm == end_mm && !reached(end_mm)) return way * std::numeric_limits<double>::infinity();
  while (met_mm - clear_mm > kSameStep * kHeightStep_mm) {
    narrow(std::midpoint(clear_mm, met_mm));
  }
  return way * std::midpoint(clear_mm, met_mm);
}

}  // namespace pinjaw::part
