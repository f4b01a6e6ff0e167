#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "host/planner/force/squeeze.hpp"
#include "tests/host/planner/force/peers.hpp"
#include "tests/host/planner/force/zoo.hpp"

namespace pinjaw::planner {
namespace {

peers::Result ours(SqueezeSolver& solver, const model::Wrench& wrench) {
  const SqueezeOutcome outcome = solver.least_squeeze(wrench);
  if (const auto* required = std::get_if<Required>(&outcome))
    return {peers::Status::Optimal, required->force_n};
  if (std::holds_alternative<Unbounded>(outcome)) return {peers::Status::Unbounded, 0};
  return {peers::Status::Infeasible, 0};
}

/// How often each outcome was seen.
using Tally = std::map<peers::Status, int>;

using Referee = peers::Result (*)(const Grasp&, const model::Wrench&);

struct Agreement {
  zoo::Family family;
  int grasps;
  int loads;
  double tolerance;  ///< of max(1, |F|)
};

Tally expect_agreement(const Agreement& agreement, Referee referee) {
  base::Random random(20 + static_cast<std::uint64_t>(agreement.family));
  SqueezeSolver solver;
  Tally tally;
  for (int g = 0; g < agreement.grasps; ++g) {
    const Grasp grasp = zoo::random_grasp(agreement.family, random);
    solver.take(grasp);
    for (int l = 0; l < agreement.loads; ++l) {
      const model::Wrench wrench = zoo::random_wrench(agreement.family, grasp, random);
      const peers::Result mine = ours(solver, wrench);
      const peers::Result theirs = referee(grasp, wrench);
      ++tally[mine.status];
      if (theirs.status == peers::Status::Failed) {
        ++tally[peers::Status::Failed];
        continue;
      }
      EXPECT_EQ(mine.status, theirs.status)
          << zoo::name_of(agreement.family) << " grasp " << g << " load " << l << ": ours " << to_string(mine)
          << ", theirs " << to_string(theirs);
      EXPECT_NEAR(mine.value, theirs.value, agreement.tolerance * std::max(1.0, std::abs(theirs.value)))
          << zoo::name_of(agreement.family) << " grasp " << g << " load " << l;
      if (testing::Test::HasFailure()) return tally;
    }
  }
  return tally;
}

peers::Result in_quadruple_precision(const Grasp& grasp, const model::Wrench& wrench) {
  return peers::quadruple(grasp, wrench);
}

class SqueezeOnFamily : public testing::TestWithParam<zoo::Family> {};

TEST_P(SqueezeOnFamily, equals_quadruple_precision_to_1e_9) {
  expect_agreement({GetParam(), 20, 40, 1e-9}, in_quadruple_precision);
}

/// Where a general solver and ours differ, quadruple precision decides. Returns how often they did.
int disputes_with(Referee peer, zoo::Family family) {
  base::Random random(120 + static_cast<std::uint64_t>(family));
  SqueezeSolver solver;
  int disputes = 0;
  for (int g = 0; g < 40; ++g) {
    const Grasp grasp = zoo::random_grasp(family, random);
    solver.take(grasp);
    for (int l = 0; l < 10; ++l) {
      const model::Wrench wrench = zoo::random_wrench(family, grasp, random);
      const peers::Result mine = ours(solver, wrench);
      const peers::Result theirs = peer(grasp, wrench);
      const double size = std::max(1.0, std::abs(mine.value));
      if (mine.status == theirs.status && std::abs(mine.value - theirs.value) <= 1e-7 * size) continue;
      ++disputes;
      const peers::Result decided = peers::quadruple(grasp, wrench);
      EXPECT_EQ(mine.status, decided.status) << to_string(mine) << ", the peer " << to_string(theirs);
      EXPECT_NEAR(mine.value, decided.value, 1e-9 * size) << "the peer " << to_string(theirs);
    }
  }
  return disputes;
}

/// Families whose data lie below a general solver's own tolerances of 1e-9.
bool is_extreme(zoo::Family family) {
  return family == zoo::Family::LittleFriction || family == zoo::Family::HardlyAnyFriction ||
         family == zoo::Family::NearCoincident;
}

TEST_P(SqueezeOnFamily, equals_glpk_or_is_upheld_against_it_by_quadruple_precision) {
  const int disputes = disputes_with(peers::glpk, GetParam());
  EXPECT_LE(disputes, is_extreme(GetParam()) ? 100 : 0);
}

TEST_P(SqueezeOnFamily, equals_clp_or_is_upheld_against_it_by_quadruple_precision) {
  const int disputes = disputes_with(peers::clp, GetParam());
  EXPECT_LE(disputes, is_extreme(GetParam()) ? 100 : 0);
}

INSTANTIATE_TEST_SUITE_P(Zoo, SqueezeOnFamily, testing::ValuesIn(zoo::all_families()),
                         [](const auto& family) { return zoo::name_of(family.param); });

TEST(Squeeze, equals_glpk_to_1e_7_on_thousands_of_grasps) {
  Tally closed = expect_agreement({zoo::Family::Mixed, 1500, 3, 1e-7}, peers::glpk);
  EXPECT_EQ(closed[peers::Status::Failed], 0);
  Tally open = expect_agreement({zoo::Family::NotFormClosed, 1500, 3, 1e-7}, peers::glpk);
  EXPECT_GT(open[peers::Status::Infeasible], 300);
  EXPECT_GT(open[peers::Status::Optimal], 300);
  Tally steep = expect_agreement({zoo::Family::Steep, 500, 3, 1e-7}, peers::glpk);
  EXPECT_GT(steep[peers::Status::Optimal], 100);
  EXPECT_GT(steep[peers::Status::Unbounded], 10);
}

TEST(Squeeze, equals_clp_to_1e_7_on_thousands_of_grasps) {
  expect_agreement({zoo::Family::Mixed, 1500, 3, 1e-7}, peers::clp);
  Tally open = expect_agreement({zoo::Family::NotFormClosed, 1500, 3, 1e-7}, peers::clp);
  EXPECT_GT(open[peers::Status::Infeasible], 300);
}

TEST(Squeeze, of_the_rays_is_that_of_the_papers_3n_variables) {
  expect_agreement({zoo::Family::FormClosed, 200, 3, 1e-7}, peers::glpk_paper_form);
  expect_agreement({zoo::Family::NotFormClosed, 200, 3, 1e-7}, peers::glpk_paper_form);
}

TEST(Squeeze, never_needs_quadruple_precision_on_ordinary_grasps) {
  base::Random random(7);
  SqueezeSolver solver;
  for (int g = 0; g < 300; ++g) {
    const Grasp grasp = zoo::random_grasp(zoo::Family::Mixed, random);
    solver.take(grasp);
    for (int l = 0; l < 100; ++l) solver.least_squeeze(zoo::random_wrench(zoo::Family::Mixed, grasp, random));
  }
  EXPECT_EQ(solver.exact_solves(), 0);
}

}  // namespace
}  // namespace pinjaw::planner
