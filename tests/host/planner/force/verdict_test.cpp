#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "host/planner/force/force.hpp"
#include "tests/host/planner/force/peers.hpp"
#include "tests/host/planner/force/zoo.hpp"

namespace pinjaw::planner {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

Vector2d direction_deg(double angle_deg) {
  return {std::cos(angle_deg * kDegree), std::sin(angle_deg * kDegree)};
}

model::Wrench force(double x, double y, double z) {
  model::Wrench wrench;
  wrench << x, y, z, 0, 0, 0;
  return wrench;
}

Grasp boxed_grasp() {
  base::Random unused(1);
  return zoo::random_grasp(zoo::Family::SymmetricBox, unused);
}

/// One jaw's planar contacts as a grasp at height 0, for the referee.
Grasp flat_grasp(const std::vector<PlanarContact>& contacts, double mu) {
  Grasp grasp;
  grasp.mu = mu;
  for (const PlanarContact& contact : contacts) {
    grasp.contacts.push_back(
        {{contact.p_mm.x(), contact.p_mm.y(), 0}, contact.normal, model::JawSide::Left, 0});
  }
  return grasp;
}

/// Closure by linear programs: both ways along x, y and the turn can be resisted by the cones of half-width
/// mu.
bool closes_by_programs(const std::vector<PlanarContact>& contacts, double mu) {
  const Grasp grasp = flat_grasp(contacts, mu);
  for (const int axis : {0, 1, 5}) {
    for (const double sign : {-1.0, 1.0}) {
      model::Wrench wrench = model::Wrench::Zero();
      wrench[axis] = axis == 5 ? 20 * sign : sign;
      if (peers::quadruple(grasp, wrench, mu).status == peers::Status::Infeasible) return false;
    }
  }
  return true;
}

TEST(PlanarForceClosure, equals_linear_programs_on_random_jaws) {
  base::Random random(11);
  int closed = 0;
  for (int n = 0; n < 400; ++n) {
    std::vector<PlanarContact> contacts;
    for (int i = 0; i < 2 + n % 2; ++i) {
      contacts.push_back({Vector2d(random.uniform(-20, 20), random.uniform(-20, 20)),
                          direction_deg(random.uniform(0, 360))});
    }
    const double mu = n % 3 == 0 ? 1 : 0.3;
    const bool closes = planar_force_closure(contacts, mu);
    EXPECT_EQ(closes, closes_by_programs(contacts, mu)) << n;
    closed += closes ? 1 : 0;
  }
  EXPECT_GT(closed, 20);
}

TEST(PlanarForceClosure, needs_friction_that_reaches_the_other_contact) {
  const std::vector<PlanarContact> wedge{{{0, -10}, direction_deg(80)}, {{0, 10}, direction_deg(-80)}};
  EXPECT_FALSE(planar_force_closure(wedge, std::tan(9 * kDegree)));
  EXPECT_TRUE(planar_force_closure(wedge, std::tan(11 * kDegree)));
}

TEST(PlanarForceClosure, holds_for_pins_spread_inside_a_slot) {
  EXPECT_TRUE(planar_force_closure({{{0, -10}, Vector2d(0, -1)}, {{0, 10}, Vector2d(0, 1)}}, 0.2));
}

TEST(PlanarForceClosure, is_not_given_by_one_contact_or_without_friction) {
  EXPECT_FALSE(planar_force_closure({{{0, 0}, Vector2d(1, 0)}}, 1));
  EXPECT_FALSE(planar_force_closure({{{0, -10}, Vector2d(0, 1)}, {{0, 10}, Vector2d(0, -1)}}, 0));
}

/// Left pins against two faces inclined by `angle_deg` from the closing axis, as a wedge; one right pin
/// behind.
Grasp wedge_grasp(double angle_deg, double mu) {
  Grasp grasp;
  grasp.mu = mu;
  for (const double z : {0.0, 8.0}) {
    grasp.contacts.push_back({{0, -10, z}, direction_deg(angle_deg), model::JawSide::Left, 0});
    grasp.contacts.push_back({{0, 10, z}, direction_deg(-angle_deg), model::JawSide::Left, 1});
    grasp.contacts.push_back({{30, -5, z}, Vector2d(-1, 0), model::JawSide::Right, 2});
    grasp.contacts.push_back({{30, 5, z}, Vector2d(-1, 0), model::JawSide::Right, 3});
  }
  return grasp;
}

TEST(Verdict, discards_a_grasp_that_wedges_in_one_jaw) {
  const std::vector<model::Wrench> loads{force(0, 0, -2)};
  const ForceVerdict sticky = evaluate(wedge_grasp(60, std::tan(31 * kDegree)), loads, {});
  ASSERT_TRUE(std::holds_alternative<Wedges>(sticky));
  EXPECT_EQ(std::get<Wedges>(sticky).jaw, model::JawSide::Left);
  EXPECT_TRUE(std::holds_alternative<Holds>(evaluate(wedge_grasp(60, std::tan(29 * kDegree)), loads, {})));
}

TEST(Verdict, never_finds_a_grasp_that_wedges_but_does_not_jam) {
  base::Random random(13);
  int wedged = 0;
  for (int n = 0; n < 3000; ++n) {
    Grasp grasp = zoo::random_grasp(zoo::Family::NotFormClosed, random);
    grasp.mu = 0.8;
    if (!wedging_jaw(grasp)) continue;
    ++wedged;
    EXPECT_TRUE(jamming_contact(grasp).has_value());
  }
  EXPECT_GT(wedged, 10);
}

TEST(Verdict, discards_a_grasp_whose_pin_jams) {
  Grasp grasp = boxed_grasp();
  for (PointContact& contact : grasp.contacts) {
    if (contact.pin == 1) contact.n_P = direction_deg(80);  // 10 degrees from the face, friction of 11.3
  }
  const ForceVerdict verdict = evaluate(grasp, std::vector<model::Wrench>{force(0, 0, -2)}, {});
  ASSERT_TRUE(std::holds_alternative<Jams>(verdict));
  EXPECT_EQ(std::get<Jams>(verdict).pin, 1);
}

TEST(Verdict, names_the_first_wrench_that_no_squeeze_resists) {
  Grasp grasp = boxed_grasp();
  grasp.mu = 0;
  const std::vector<model::Wrench> loads{force(3, 0, 0), force(0, 0, -1), force(0, 0, 1)};
  const ForceVerdict verdict = evaluate(grasp, loads, {});
  ASSERT_TRUE(std::holds_alternative<NotResistable>(verdict));
  EXPECT_EQ(std::get<NotResistable>(verdict).critical, 1U);
}

TEST(Verdict, names_the_first_of_equally_hard_wrenches) {
  const std::vector<model::Wrench> loads{force(3, 0, 0), force(0, 0, -1), force(0, 0, 1)};
  const ForceVerdict verdict = evaluate(boxed_grasp(), loads, {});
  ASSERT_TRUE(std::holds_alternative<Holds>(verdict));
  EXPECT_EQ(std::get<Holds>(verdict).critical, 1U);
  EXPECT_NEAR(std::get<Holds>(verdict).required_n, std::sqrt(2.0) / 0.2, 1e-9);
}

TEST(Verdict, tells_how_much_a_grasp_would_need_beyond_the_usable_force) {
  ForceOptions options;
  options.usable_n = 7;
  const std::vector<model::Wrench> loads{force(0, 0, -1)};
  const ForceVerdict verdict = evaluate(boxed_grasp(), loads, options);
  ASSERT_TRUE(std::holds_alternative<TooStrong>(verdict));
  EXPECT_NEAR(std::get<TooStrong>(verdict).required_n, 7.07, 0.01);
  options.friction = model::FrictionModel::Cone;  // needs 5 N
  EXPECT_TRUE(std::holds_alternative<Holds>(evaluate(boxed_grasp(), loads, options)));
}

TEST(Verdict, that_nothing_is_required_without_loads) {
  const ForceVerdict verdict = evaluate(boxed_grasp(), {}, {});
  ASSERT_TRUE(std::holds_alternative<Holds>(verdict));
  EXPECT_EQ(std::get<Holds>(verdict).required_n, 0);
}

struct Sample {
  std::vector<Grasp> grasps;
  std::vector<model::Wrench> loads;
};

Sample sample() {
  Sample result;
  base::Random random(12);
  for (int g = 0; g < 60; ++g) result.grasps.push_back(zoo::random_grasp(zoo::Family::Mixed, random));
  for (int l = 0; l < 40; ++l) {
    result.loads.push_back(zoo::random_wrench(zoo::Family::Mixed, result.grasps.front(), random));
  }
  return result;
}

/// The verdict's kind, force bits and wrench as one comparable value.
std::vector<double> digits(const std::vector<ForceVerdict>& verdicts) {
  std::vector<double> all;
  for (const ForceVerdict& verdict : verdicts) {
    all.push_back(static_cast<double>(verdict.index()));
    if (const auto* holds = std::get_if<Holds>(&verdict)) {
      all.push_back(holds->required_n);
      all.push_back(static_cast<double>(holds->critical));
    }
  }
  return all;
}

TEST(Verdicts, are_the_same_bits_for_any_number_of_threads) {
  const Sample of = sample();
  for (const model::FrictionModel friction : {model::FrictionModel::Pyramid, model::FrictionModel::Cone}) {
    ForceOptions options;
    options.friction = friction;
    const auto one = digits(evaluate_all(of.grasps, of.loads, options, 1));
    EXPECT_EQ(one, digits(evaluate_all(of.grasps, of.loads, options, 2)));
    EXPECT_EQ(one, digits(evaluate_all(of.grasps, of.loads, options, 5)));
  }
}

TEST(Verdicts, that_stop_early_agree_with_the_full_ones) {
  const Sample of = sample();
  ForceOptions stop;
  stop.stop_above_n = 120;
  const auto full = evaluate_all(of.grasps, of.loads, {}, 1);
  const auto early = evaluate_all(of.grasps, of.loads, stop, 1);
  int stopped = 0;
  for (std::size_t i = 0; i < full.size(); ++i) {
    const auto* holds = std::get_if<Holds>(&full[i]);
    if (holds == nullptr) continue;
    const bool above = holds->required_n > *stop.stop_above_n;
    EXPECT_EQ(std::holds_alternative<TooStrong>(early[i]), above);
    stopped += above ? 1 : 0;
  }
  EXPECT_GT(stopped, 0);
}

TEST(Grasp, of_a_design_has_two_points_for_a_pin_that_touches_a_line_and_one_for_a_point) {
  model::Design design;
  design.part_pose = {90 * kDegree, Vector2d(1, 2)};
  model::PinDesign pin;
  pin.contact_mm = {-10, 5};
  pin.normal = {1, 0};
  pin.contact_z_mm = {2, 9};
  design.pins = {pin, pin};
  design.pins[1].contact_z_mm = {4, 4};
  design.pins[1].hole.jaw = model::JawSide::Right;
  const Grasp grasp = grasp_of(design, 0.2);
  ASSERT_EQ(grasp.contacts.size(), 3U);
  EXPECT_TRUE(grasp.x_P.isApprox(Vector2d(0, -1)));
  EXPECT_TRUE(grasp.contacts[1].p_P_mm.isApprox(Vector3d(3, 11, 9)));
  EXPECT_TRUE(grasp.contacts[0].n_P.isApprox(Vector2d(0, -1)));
  EXPECT_NEAR(squeeze_share(grasp, grasp.contacts[0], {0, -3, 0}), 3, 1e-12);
  EXPECT_NEAR(squeeze_share(grasp, grasp.contacts[2], {0, -3, 0}), -3, 1e-12);
}

}  // namespace
}  // namespace pinjaw::planner
