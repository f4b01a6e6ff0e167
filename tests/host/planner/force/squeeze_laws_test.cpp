#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <cstring>

#include "host/planner/force/force.hpp"
#include "host/planner/force/ray_program.hpp"
#include "tests/host/planner/force/peers.hpp"
#include "tests/host/planner/force/zoo.hpp"

namespace pinjaw::planner {
namespace {

using model::FrictionModel;

double force_n(SqueezeSolver& solver, const model::Wrench& wrench,
               FrictionModel friction = FrictionModel::Pyramid) {
  const SqueezeOutcome outcome = solver.least_squeeze(wrench, friction);
  if (const auto* required = std::get_if<Required>(&outcome)) return required->force_n;
  return std::numeric_limits<double>::infinity();
}

model::Wrench wrench_of(const Vector3d& force_n, const Vector3d& torque_nmm = Vector3d::Zero()) {
  model::Wrench wrench;
  wrench << force_n, torque_nmm;
  return wrench;
}

/// The zoo's box: eight points at (+-20, +-10, +-5) mm, mu 0.2, the jaws closing along its x, its first axis.
Grasp box() {
  base::Random unused(1);
  return zoo::random_grasp(zoo::Family::SymmetricBox, unused);
}

TEST(Squeeze, of_a_box_against_weight_is_weight_over_friction_counting_both_jaws) {
  SqueezeSolver solver(box());
  const double weight_n = 0.18 * 9.80665;
  EXPECT_NEAR(force_n(solver, wrench_of({0, 0, -weight_n}), FrictionModel::Cone), weight_n / 0.2, 1e-7);
  EXPECT_NEAR(force_n(solver, wrench_of({0, 0, -weight_n}), FrictionModel::Cone), 8.8,
              0.05);  // BB's part and friction
  EXPECT_NEAR(force_n(solver, wrench_of({0, 0, -weight_n})), weight_n * std::sqrt(2.0) / 0.2, 1e-9);
}

TEST(Squeeze, of_a_box_pushed_at_one_jaw_is_the_push_itself) {
  SqueezeSolver solver(box());
  EXPECT_NEAR(force_n(solver, wrench_of({10, 0, 0})), 10, 1e-9);
  EXPECT_NEAR(force_n(solver, wrench_of({-10, 0, 0})), 10, 1e-9);
}

TEST(Squeeze, of_a_box_pulled_along_the_jaws_is_shared_by_the_friction_of_both) {
  SqueezeSolver solver(box());
  EXPECT_NEAR(force_n(solver, wrench_of({0, 10, 0})), 10 * std::sqrt(2.0) / 0.2, 1e-8);
  EXPECT_NEAR(force_n(solver, wrench_of({0, 10, 0}), FrictionModel::Cone), 50, 1e-7);
}

TEST(Squeeze, without_a_load_is_zero) {
  SqueezeSolver solver(box());
  EXPECT_EQ(force_n(solver, model::Wrench::Zero()), 0);
  EXPECT_EQ(force_n(solver, model::Wrench::Zero(), FrictionModel::Cone), 0);
}

class SqueezeLaws : public testing::TestWithParam<FrictionModel> {};

TEST_P(SqueezeLaws, scales_with_the_load) {
  base::Random random(3);
  for (int g = 0; g < 40; ++g) {
    const Grasp grasp = zoo::random_grasp(zoo::Family::Mixed, random);
    SqueezeSolver solver(grasp);
    const model::Wrench wrench = zoo::random_wrench(zoo::Family::Mixed, grasp, random);
    const double once_n = force_n(solver, wrench, GetParam());
    for (const double t : {1e-3, 0.5, 7.0, 1000.0}) {
      const double scaled_n = force_n(solver, t * wrench, GetParam());
      if (std::isinf(once_n)) {
        EXPECT_EQ(scaled_n, once_n);
      } else {
        EXPECT_NEAR(scaled_n, t * once_n, 4e-9 * std::max(1.0, t) * std::max(1.0, once_n));
      }
    }
  }
}

TEST_P(SqueezeLaws, of_two_loads_together_is_at_most_the_sum) {
  base::Random random(4);
  for (int g = 0; g < 100; ++g) {
    const Grasp grasp = zoo::random_grasp(zoo::Family::Mixed, random);
    SqueezeSolver solver(grasp);
    const model::Wrench a = zoo::random_wrench(zoo::Family::Mixed, grasp, random);
    const model::Wrench b = zoo::random_wrench(zoo::Family::Mixed, grasp, random);
    const double sum_n = force_n(solver, a, GetParam()) + force_n(solver, b, GetParam());
    EXPECT_LE(force_n(solver, model::Wrench(a + b), GetParam()), sum_n + 4e-9 * std::max(1.0, sum_n));
  }
}

TEST_P(SqueezeLaws, is_reached_by_contact_forces_that_balance_the_load_within_friction) {
  base::Random random(5);
  const double slack = 1e-7;
  for (int g = 0; g < 100; ++g) {
    const Grasp grasp = zoo::random_grasp(zoo::Family::Mixed, random);
    SqueezeSolver solver(grasp);
    const model::Wrench wrench = zoo::random_wrench(zoo::Family::Mixed, grasp, random);
    const double required_n = force_n(solver, wrench, GetParam());
    const auto forces_n = solver.balancing_forces_n(wrench, GetParam());
    ASSERT_EQ(forces_n.has_value(), std::isfinite(required_n));
    if (!forces_n) continue;
    model::Wrench sum = wrench;
    double squeeze_n = 0;
    for (std::size_t i = 0; i < forces_n->size(); ++i) {
      const Vector3d& f = (*forces_n)[i];
      const PointContact& contact = grasp.contacts[i];
      sum += wrench_of(f, contact.p_P_mm.cross(f));
      squeeze_n += squeeze_share(grasp, contact, f);
      const double normal_n = contact.n_P.dot(f.head<2>());
      const Vector3d slip_n = f - normal_n * Vector3d(contact.n_P.x(), contact.n_P.y(), 0);
      EXPECT_LE(slip_n.norm(), grasp.mu * normal_n + slack * std::max(1.0, required_n));
    }
    EXPECT_LT(sum.norm(), slack * std::max(1.0, required_n) * 25);
    EXPECT_NEAR(squeeze_n, required_n, slack * std::max(1.0, required_n));
  }
}

INSTANTIATE_TEST_SUITE_P(Models, SqueezeLaws, testing::Values(FrictionModel::Pyramid, FrictionModel::Cone));

TEST(Cone, lies_between_the_pyramid_around_it_and_the_pyramid_inside) {
  base::Random random(6);
  int compared = 0;
  for (const zoo::Family family : zoo::all_families()) {
    for (int g = 0; g < 80; ++g) {
      const Grasp grasp = zoo::random_grasp(family, random);
      if (jamming_contact(grasp)) continue;
      SqueezeSolver solver(grasp);
      for (int l = 0; l < 4; ++l) {
        const model::Wrench wrench = zoo::random_wrench(family, grasp, random);
        const SqueezeOutcome cone = solver.least_squeeze(wrench, FrictionModel::Cone);
        const auto* required = std::get_if<Required>(&cone);
        if (required == nullptr) {
          EXPECT_TRUE(std::isinf(force_n(solver, wrench))) << zoo::name_of(family);
          EXPECT_TRUE(std::holds_alternative<Unresistable>(cone)) << zoo::name_of(family);
          continue;
        }
        const double slack_n = 1e-8 * std::max(1.0, required->force_n);
        const peers::Result outside = peers::quadruple(grasp, wrench, grasp.mu);
        ASSERT_EQ(outside.status, peers::Status::Optimal) << zoo::name_of(family);
        EXPECT_LE(required->force_n, force_n(solver, wrench) + slack_n) << zoo::name_of(family);
        EXPECT_GE(required->force_n, outside.value - slack_n) << zoo::name_of(family);
        EXPECT_LE(required->gap_n, slack_n) << zoo::name_of(family);
        ++compared;
      }
    }
  }
  EXPECT_GT(compared, 2500);
}

TEST(Cone, equals_a_general_non_linear_solver) {
  base::Random random(8);
  int compared = 0;
  for (int g = 0; g < 12; ++g) {
    const Grasp grasp = zoo::random_grasp(zoo::Family::FormClosed, random);
    SqueezeSolver solver(grasp);
    const model::Wrench wrench = zoo::random_wrench(zoo::Family::FormClosed, grasp, random);
    const double required_n = force_n(solver, wrench, FrictionModel::Cone);
    const auto by_nlopt_n = cone_squeeze_by_nlopt_n(grasp, wrench);
    if (!by_nlopt_n || std::isinf(required_n)) continue;
    EXPECT_NEAR(*by_nlopt_n, required_n, 1e-3 * std::max(1.0, required_n));
    ++compared;
  }
  EXPECT_GT(compared, 8);
}

/// One kernel's answers to the loads of one grasp.
std::vector<kernel::Answer> answers_of(const kernel::Kernel& kernel, const kernel::Program& program,
                                       const std::vector<RightHandSide>& loads) {
  const std::size_t stride = (loads.size() + 7) / 8 * 8;
  struct alignas(64) Eight {
    double entry[8] = {};
  };
  std::vector<Eight> b(6 * stride / 8);
  for (std::size_t i = 0; i < loads.size(); ++i) {
    for (std::size_t k = 0; k < 6; ++k) b[(k * stride + i) / 8].entry[i % 8] = loads[i][k];
  }
  const auto memory = std::make_unique<kernel::Memory>();
  kernel::forget(*memory);
  std::vector<kernel::Answer> answers(loads.size());
  kernel.solve(program, *memory, b.front().entry, static_cast<int>(stride), static_cast<int>(loads.size()),
               answers.data());
  return answers;
}

TEST(Kernels, of_every_instruction_set_give_the_same_bits) {
  base::Random random(9);
  int count = 0;
  const kernel::Kernel* const* all = kernel::kernels(count);
  for (const zoo::Family family : zoo::all_families()) {
    for (int g = 0; g < 12; ++g) {
      const Grasp grasp = zoo::random_grasp(family, random);
      const GraspFrame frame = frame_of(grasp);
      kernel::Program program;
      fill_program(grasp, frame, grasp.mu / std::sqrt(2.0), program);
      if (program.least_cost <= 0) continue;
      std::vector<RightHandSide> loads;
      for (int l = 0; l < 61; ++l)
        loads.push_back(frame.right_hand_side(zoo::random_wrench(family, grasp, random)));
      const auto first = answers_of(*all[0], program, loads);
      for (int k = 1; k < count; ++k) {
        const auto other = answers_of(*all[k], program, loads);
        for (std::size_t i = 0; i < loads.size(); ++i) {
          EXPECT_EQ(std::memcmp(&first[i].value, &other[i].value, sizeof first[i].value), 0)
              << all[k]->name << " on " << zoo::name_of(family);
          EXPECT_EQ(first[i].status, other[i].status) << all[k]->name << " on " << zoo::name_of(family);
        }
      }
    }
  }
}

TEST(Kernels, end_with_the_one_that_solvers_use) {
  int count = 0;
  const kernel::Kernel* const* all = kernel::kernels(count);
  EXPECT_STREQ(all[0]->name, "baseline");
  EXPECT_EQ(all[count - 1], &kernel::best_kernel());
#if defined(__x86_64__)
  const bool has_avx2 = __builtin_cpu_supports("avx2") != 0;
  const bool has_avx512 = has_avx2 && __builtin_cpu_supports("avx512f") != 0;
  EXPECT_EQ(count, 1 + (has_avx2 ? 1 : 0) + (has_avx512 ? 1 : 0));
#endif
}

TEST(Kernels, forget_and_go_on_when_their_memory_is_full) {
  base::Random random(10);
  const Grasp grasp = zoo::random_grasp(zoo::Family::FormClosed, random);
  std::vector<model::Wrench> wrenches;
  for (int l = 0; l < 20000; ++l) {
    model::Wrench wrench;
    for (int k = 0; k < 6; ++k) wrench[k] = random.normal() * (k < 3 ? 1 : 20);
    wrenches.push_back(wrench);
  }
  SqueezeSolver solver(grasp);
  std::vector<SqueezeOutcome> outcomes;
  solver.least_squeeze_all(wrenches, outcomes);
  for (std::size_t i = 0; i < wrenches.size(); i += 500) {
    SqueezeSolver fresh(grasp);
    const double alone_n = force_n(fresh, wrenches[i]);
    const auto* among = std::get_if<Required>(&outcomes[i]);
    ASSERT_EQ(among != nullptr, std::isfinite(alone_n));
    if (among == nullptr) continue;
    EXPECT_NEAR(among->force_n, alone_n, 1e-9 * std::max(1.0, alone_n));
  }
}

/// Everything that a solver says of a load, by both models, as bits.
std::vector<double> all_said(SqueezeSolver& solver, const model::Wrench& wrench) {
  std::vector<double> said;
  for (const FrictionModel friction : {FrictionModel::Pyramid, FrictionModel::Cone}) {
    const SqueezeOutcome outcome = solver.least_squeeze(wrench, friction);
    said.push_back(static_cast<double>(outcome.index()));
    if (const auto* required = std::get_if<Required>(&outcome)) {
      said.push_back(required->force_n);
      said.push_back(required->gap_n);
    }
    if (const auto forces_n = solver.balancing_forces_n(wrench, friction)) {
      for (const Vector3d& force : *forces_n) said.insert(said.end(), force.begin(), force.end());
    }
  }
  return said;
}

TEST(Squeeze, of_a_grasp_does_not_depend_on_the_grasps_before_it) {
  base::Random random(14);
  SqueezeSolver used;
  std::vector<SqueezeOutcome> outcomes;
  for (int round = 0; round < 6; ++round) {
    for (const zoo::Family family : zoo::all_families()) {
      const Grasp grasp = zoo::random_grasp(family, random);
      std::vector<model::Wrench> wrenches;
      for (int l = 0; l < 12; ++l) wrenches.push_back(zoo::random_wrench(family, grasp, random));
      SqueezeSolver fresh(grasp);
      used.take(grasp);
      for (const model::Wrench& wrench : wrenches)
        EXPECT_EQ(all_said(used, wrench), all_said(fresh, wrench)) << zoo::name_of(family);
      used.least_squeeze_all(wrenches, outcomes);  // leave something behind
    }
  }
}

TEST(Squeeze, of_many_loads_at_once_is_that_of_each_alone) {
  base::Random random(11);
  std::vector<SqueezeOutcome> outcomes;
  for (const zoo::Family family : zoo::all_families()) {
    const Grasp grasp = zoo::random_grasp(family, random);
    std::vector<model::Wrench> wrenches;
    for (int l = 0; l < 37; ++l) wrenches.push_back(zoo::random_wrench(family, grasp, random));
    SqueezeSolver(grasp).least_squeeze_all(wrenches, outcomes);
    ASSERT_EQ(outcomes.size(), wrenches.size());
    for (std::size_t i = 0; i < wrenches.size(); ++i) {
      SqueezeSolver alone(grasp);
      const SqueezeOutcome of_one = alone.least_squeeze(wrenches[i]);
      ASSERT_EQ(of_one.index(), outcomes[i].index()) << zoo::name_of(family) << " load " << i;
      const auto* required = std::get_if<Required>(&of_one);
      if (required == nullptr) continue;
      EXPECT_NEAR(std::get<Required>(outcomes[i]).force_n, required->force_n,
                  1e-9 * std::max(1.0, required->force_n))
          << zoo::name_of(family) << " load " << i;
    }
  }
}

}  // namespace
}  // namespace pinjaw::planner
