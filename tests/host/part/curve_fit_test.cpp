#include "host/part/curve_fit.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

namespace pinjaw::part {
namespace {

constexpr double kToleranceMm = 1e-3;

std::vector<Vector3d> on_circle(double radius_mm, double sweep_rad, double ripple_mm = 0) {
  const Eigen::Matrix3d tilt = Eigen::AngleAxisd(0.7, Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  std::vector<Vector3d> samples;
  for (int i = 0; i <= 16; ++i) {
    const double t_rad = 0.3 + sweep_rad * i / 16;
    const double r_mm = radius_mm + (i % 2 == 1 ? ripple_mm : 0);
    samples.push_back(Vector3d(5, 6, 7) + tilt * Vector3d(r_mm * std::cos(t_rad), r_mm * std::sin(t_rad), 0));
  }
  return samples;
}

Vector3d at(const Ellipse3& arc, double t_rad) {
  return arc.center_mm + std::cos(t_rad) * arc.u_mm + std::sin(t_rad) * arc.v_mm;
}

TEST(CurveFit, recognises_a_line_through_its_samples) {
  std::vector<Vector3d> samples;
  for (int i = 0; i <= 16; ++i) samples.push_back(Vector3d(1, 2, 3) + i * i * Vector3d(0.1, 0.2, -0.1));
  const auto curve = recognised(samples, kToleranceMm);
  ASSERT_TRUE(curve);
  const auto& line = std::get<Line3>(curve->curve);
  EXPECT_EQ(line.a_mm, samples.front());
  EXPECT_EQ(line.b_mm, samples.back());
}

class ArcSweep : public testing::TestWithParam<double> {};

TEST_P(ArcSweep, recognises_an_arc_with_its_ends_centre_and_radius) {
  const auto samples = on_circle(12, GetParam());
  const auto curve = recognised(samples, kToleranceMm);
  ASSERT_TRUE(curve);
  const auto& arc = std::get<Ellipse3>(curve->curve);
  EXPECT_NEAR((arc.center_mm - Vector3d(5, 6, 7)).norm(), 0, 1e-9);
  EXPECT_NEAR(arc.u_mm.norm(), 12, 1e-9);
  EXPECT_NEAR(arc.sweep_rad, GetParam(), 1e-9);
  EXPECT_LT((at(arc, arc.from_rad) - samples.front()).norm(), 1e-9);
  EXPECT_LT((at(arc, arc.from_rad + arc.sweep_rad) - samples.back()).norm(), 1e-9);
}

INSTANTIATE_TEST_SUITE_P(Arcs, ArcSweep, testing::Values(0.2, 1.0, 3.0, 3.3, 6.0, 2 * std::numbers::pi));

TEST(CurveFit, recognises_nothing_beyond_its_tolerance) {
  const auto rippled = recognised(on_circle(12, 2, 0.8e-3), kToleranceMm);
  ASSERT_TRUE(rippled);
  EXPECT_NEAR(rippled->error_mm, 0.8e-3, 1e-9);
  EXPECT_FALSE(recognised(on_circle(12, 2, 2.5e-3), kToleranceMm));
}

TEST(CurveFit, recognises_nothing_in_a_helix) {
  std::vector<Vector3d> samples = on_circle(12, 3);
  for (std::size_t i = 0; i < samples.size(); ++i) samples[i].z() += 0.05 * static_cast<double>(i * i);
  EXPECT_FALSE(recognised(samples, kToleranceMm));
}

TEST(CurveFit, recognises_nothing_in_a_curve_that_never_moves) {
  const std::vector<Vector3d> samples(17, Vector3d(1, 1, 1));
  EXPECT_FALSE(recognised(samples, kToleranceMm));
}

}  // namespace
}  // namespace pinjaw::part
