// Features against OpenCASCADE's own hidden line removal and its rays on the exact faces, seen from below.
#include <gtest/gtest.h>

#include <BRepAdaptor_Curve.hxx>
#include <BRepLib.hxx>
#include <GCPnts_AbscissaPoint.hxx>
#include <HLRAlgo_Projector.hxx>
#include <HLRBRep_Algo.hxx>
#include <HLRBRep_HLRToShape.hxx>
#include <IntCurvesFace_ShapeIntersector.hxx>
#include <Precision.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <algorithm>
#include <limits>

#include "host/planner/features/features.hpp"
#include "tests/host/planner/features/made_shapes.hpp"

namespace pinjaw::planner {
namespace {

struct Sample {
  Vector2d p_mm;
  Vector2d tangent;
};

struct Visible {
  double edges_mm = 0;     ///< sharp and smooth edges
  double outlines_mm = 0;  ///< outlines that are no edges
  std::vector<Sample> samples;
};

/// Appends samples of the edges; gives their length.
double add_edges(TopoDS_Shape edges, double step_mm, Visible& visible) {
  double sum_mm = 0;
  if (edges.IsNull()) return 0;
  BRepLib::BuildCurves3d(edges);
  for (TopExp_Explorer it(edges, TopAbs_EDGE); it.More(); it.Next()) {
    const BRepAdaptor_Curve curve(TopoDS::Edge(it.Current()));
    const double length_mm = GCPnts_AbscissaPoint::Length(curve);
    sum_mm += length_mm;
    const int steps = std::max(1, static_cast<int>(length_mm / step_mm));
    for (int i = 0; i < steps; ++i) {
      const double t =
          curve.FirstParameter() + (i + 0.5) / steps * (curve.LastParameter() - curve.FirstParameter());
      gp_Pnt p;
      gp_Vec along;
      curve.D1(t, p, along);
      // The view's y axis points the other way, as the viewer looks up.
      visible.samples.push_back({{p.X(), -p.Y()}, Vector2d(along.X(), -along.Y()).normalized()});
    }
  }
  return sum_mm;
}

Visible seen_from_below(const TopoDS_Shape& shape, double step_mm) {
  Handle(HLRBRep_Algo) algorithm = new HLRBRep_Algo();
  algorithm->Add(shape);
  algorithm->Projector(HLRAlgo_Projector(gp_Ax2(gp::Origin(), -gp::DZ(), gp::DX())));
  algorithm->Update();
  algorithm->Hide();
  HLRBRep_HLRToShape shapes(algorithm);
  Visible visible;
  visible.edges_mm = add_edges(shapes.VCompound(), step_mm, visible);
  visible.edges_mm += add_edges(shapes.Rg1LineVCompound(), step_mm, visible);
  visible.outlines_mm = add_edges(shapes.OutLineVCompound(), step_mm, visible);
  return visible;
}

/// Lowest z of the exact faces above a point of the plan.
class ExactRays {
 public:
  explicit ExactRays(const TopoDS_Shape& shape) { faces_.Load(shape, Precision::Confusion()); }

  double lowest_z_mm(const Vector2d& p_mm) {
    constexpr double kBelowMm = -1000;
    faces_.PerformNearest(gp_Lin(gp_Pnt(p_mm.x(), p_mm.y(), kBelowMm), gp::DZ()), 0, 1e6);
    return faces_.NbPnt() > 0 ? faces_.Pnt(1).Z() : std::numeric_limits<double>::infinity();
  }

  double jump_mm(const Sample& at) {
    const Vector2d aside = model::kEps_mm * Vector2d(at.tangent.y(), -at.tangent.x());
    const double right_mm = lowest_z_mm(at.p_mm + aside);
    const double left_mm = lowest_z_mm(at.p_mm - aside);
    return right_mm == left_mm ? 0 : std::abs(right_mm - left_mm);
  }

 private:
  IntCurvesFace_ShapeIntersector faces_;
};

double distance_mm(const geometry::Curve& curve, const Vector2d& p_mm) {
  if (const auto* segment = std::get_if<geometry::Segment>(&curve)) {
    const Vector2d ab = segment->b_mm - segment->a_mm;
    const double t = std::clamp(ab.dot(p_mm - segment->a_mm) / ab.squaredNorm(), 0.0, 1.0);
    return (p_mm - segment->a_mm - t * ab).norm();
  }
  const auto& arc = std::get<geometry::Arc>(curve);
  const Vector2d spoke = p_mm - arc.center_mm;
  if (geometry::wrapped_rad(std::atan2(spoke.y(), spoke.x()) - arc.from_rad) <= arc.sweep_rad) {
    return std::abs(spoke.norm() - arc.radius_mm);
  }
  return std::min((p_mm - geometry::point_at(curve, 0)).norm(),
                  (p_mm - geometry::point_at(curve, geometry::length_mm(curve))).norm());
}

double distance_mm(const std::vector<model::Feature>& features, const Vector2d& p_mm) {
  double nearest_mm = std::numeric_limits<double>::infinity();
  for (const model::Feature& feature : features)
    nearest_mm = std::min(nearest_mm, distance_mm(feature.curve, p_mm));
  return nearest_mm;
}

double distance_mm(const Visible& visible, const Vector2d& p_mm) {
  double nearest_mm = std::numeric_limits<double>::infinity();
  for (const Sample& sample : visible.samples) nearest_mm = std::min(nearest_mm, (sample.p_mm - p_mm).norm());
  return nearest_mm;
}

/// Lengths that the removal shows, measured with OpenCASCADE 7.6.3.
struct Case {
  const char* name;
  double edges_mm;
};
std::ostream& operator<<(std::ostream& out, const Case& c) {
  return out << c.name;
}

class HiddenLine : public testing::TestWithParam<Case> {};

/// Every feature is seen by hidden line removal, and what that sees is a feature where the exact faces jump.
void expect_agreement(const part::Shape& shape, const Visible& visible, double step_mm, int least_jumps) {
  model::PinStock pins;
  pins.radius_mm = 2;
  pins.min_engagement_mm = 1;
  const Features found = find_features(part_of(shape), pins);
  int unseen = 0;
  for (const model::Feature& feature : found.features) {
    const double length_mm = geometry::length_mm(feature.curve);
    for (double at_mm = 0.3; at_mm < length_mm - 0.3; at_mm += 1) {
      if (distance_mm(visible, geometry::point_at(feature.curve, at_mm)) > 0.8 * step_mm) ++unseen;
    }
  }
  EXPECT_EQ(unseen, 0) << "samples of features that are hidden";

  ExactRays rays(*shape);
  int missed = 0;
  int jumps = 0;
  for (std::size_t i = 0; i < visible.samples.size(); i += 3) {
    if (rays.jump_mm(visible.samples[i]) < pins.min_engagement_mm) continue;
    ++jumps;
    if (distance_mm(found.features, visible.samples[i].p_mm) > 0.03) ++missed;
  }
  EXPECT_GT(jumps, least_jumps);
  EXPECT_EQ(missed, 0) << "of " << jumps << " visible samples that jump";
}

constexpr double kStepMm = 0.5;

TEST_P(HiddenLine, removal_sees_every_feature_and_every_jump_it_sees_is_a_feature) {
  const part::Shape shape = shipped_shape(GetParam().name);
  const Visible visible = seen_from_below(*shape, kStepMm);
  EXPECT_NEAR(visible.edges_mm, GetParam().edges_mm, 0.01);
  expect_agreement(shape, visible, kStepMm, 100);
}

INSTANTIATE_TEST_SUITE_P(Parts, HiddenLine,
                         testing::Values(Case{"cassette_chassis", 706.729}, Case{"pump_cover", 614.576},
                                         Case{"connecting_rod", 530.924}, Case{"glue_gun_housing", 1557.253},
                                         Case{"hex_flange", 686.452}, Case{"l_bracket", 302.885},
                                         Case{"valve_housing", 570.997}),
                         [](const auto& tested) { return std::string(tested.param.name); });

struct Made {
  const char* name;
  part::Shape (*make)();
  double outlines_mm;  ///< that the removal shows besides edges, to 1 %
};

std::ostream& operator<<(std::ostream& out, const Made& made) {
  return out << made.name;
}

class MadeHiddenLine : public testing::TestWithParam<Made> {};

TEST_P(MadeHiddenLine, removal_sees_every_feature_and_every_jump_it_sees_is_a_feature) {
  const part::Shape shape = GetParam().make();
  const Visible visible = seen_from_below(*shape, kStepMm);
  EXPECT_NEAR(visible.outlines_mm, GetParam().outlines_mm, 0.01 * GetParam().outlines_mm + 0.01);
  expect_agreement(shape, visible, kStepMm, 20);
}

INSTANTIATE_TEST_SUITE_P(
    Shapes, MadeHiddenLine,
    testing::Values(Made{"ball",
                         [] {
                           return ball({0, 0, 0}, 10);
                         },
                         62.83},
                    Made{"tilted_ring",
                         [] {
                           return ring({0, 0, 0}, {1, 0, 2}, 20, 5);
                         },
                         238.25},
                    Made{"tilted_cone",
                         [] {
                           return cone({0, 0, 0}, {4, 0, 1}, 10, 4, 40);
                         },
                         78.42},
                    Made{"lofted", [] { return lofted(); }, 67.14},
                    Made{"spline_prism",
                         [] {
                           return spline_prism({{0, 0}, {20, -6}, {40, 3}, {36, 20}, {18, 14}, {4, 22}}, 12);
                         },
                         0},
                    Made{"bent_sheet", [] { return bent_sheet(40, 25, 60, 1.5, 3); }, 0},
                    Made{"drafted_box",
                         [] {
                           return drafted_box({50, 30, 20}, 0.035, 6);
                         },
                         0},
                    Made{"drafted_box_upside_down",
                         [] {
                           return drafted_box({50, 30, 20}, -0.035, 6);
                         },
                         0},
                    Made{"coil", [] { return coil(15, 8, 1.5, 2); }, 241.90}),
    [](const auto& tested) { return std::string(tested.param.name); });

}  // namespace
}  // namespace pinjaw::planner
