#include "host/planner/plan/check.hpp"

#include <algorithm>
#include <functional>
#include <iterator>

#include "host/planner/plan/check_feet.hpp"
#include "tests/host/planner/plan/planned.hpp"

namespace pinjaw::planner {
namespace {

std::vector<std::string> failures(const std::vector<Claim>& claims) {
  std::vector<std::string> failed;
  for (const Claim& claim : claims) {
    if (!claim.holds) failed.push_back(claim.claim + ": " + claim.found);
  }
  return failed;
}

TEST(Check, finds_every_claim_of_the_valve_housings_best_designs_true) {
  const Planned& valve = valve_pedestal();
  EXPECT_EQ(failures(check_plan(valve.plan, valve.scene)), std::vector<std::string>{});
  std::vector<const model::Design*> designs;
  for (const model::Design& design : valve.plan.designs) designs.push_back(&design);
  EXPECT_EQ(failures(check_feet(valve.plan, valve.scene, designs)), std::vector<std::string>{});
  for (std::size_t i = 0; i < 30; ++i) {
    EXPECT_EQ(failures(check_design(valve.plan, valve.scene, valve.plan.designs[i])),
              std::vector<std::string>{});
  }
}

TEST(Check, finds_every_claim_of_a_grip_from_above_under_the_cone_true) {
  const Planned arm = plan_of("valve-arm", {.friction = model::FrictionModel::Cone, .top = 5});
  for (const model::Design& design : arm.plan.designs) {
    EXPECT_EQ(failures(check_design(arm.plan, arm.scene, design)), std::vector<std::string>{});
  }
}

std::vector<Claim> all_claims(const Planned& planned, const model::Design& design) {
  std::vector<Claim> claims = check_design(planned.plan, planned.scene, design);
  const model::Design* one = &design;
  std::ranges::move(check_feet(planned.plan, planned.scene, {&one, 1}), std::back_inserter(claims));
  return claims;
}

struct Lie {
  const char* claim;  ///< that must fail
  std::function<void(model::Design&)> tell;
};

TEST(Check, catches_every_kind_of_lie_about_a_design) {
  const Planned& valve = valve_pedestal();
  const std::vector<Lie> lies = {
      {"four pins in four holes of the kit", [](auto& d) { d.pins[1].hole = d.pins[0].hole; }},
      {"touches at its stated contact", [](auto& d) { d.pins[0].contact_mm.x() += 0.01; }},
      {"touches at its stated contact", [](auto& d) { d.jaw_separation_mm += 0.01; }},
      {"pushes the part inwards", [](auto& d) { d.pins[0].normal = -d.pins[0].normal; }},
      {"has room to stand", [](auto& d) { d.part_pose.t_mm.x() += 2; }},
      {" top", [](auto& d) { d.pins[2].top_z_mm += 0.01; }},
      {" length", [](auto& d) { d.pins[2].length_mm += 0.01; }},
      {"lowest contact", [](auto& d) { d.pins[3].contact_z_mm.lo += 0.01; }},
      {"highest contact", [](auto& d) { d.pins[3].contact_z_mm.hi -= 0.01; }},
      {"closure margin", [](auto& d) { d.closure_margin += 1e-4; }},
      {"the jaws open as far as the kit lets them", [](auto& d) { d.jaw_open_mm -= 1; }},
      {"required squeeze over all disturbances", [](auto& d) { d.squeeze.required_n -= 0.01; }},
      {"required squeeze of the critical disturbance", [](auto& d) { d.squeeze.critical = "spray[0]"; }},
      {"usable squeeze", [](auto& d) { d.squeeze.usable_n += 1; }},
      {"margin", [](auto& d) { d.squeeze.margin_n += 1; }},
      {"the split is that of the pins",
       [](auto& d) {
         d.split = d.split == model::Split::TwoTwo ? model::Split::ThreeOne : model::Split::TwoTwo;
       }},
      {"the id is that of the layout", [](auto& d) { d.id = "0badc0de"; }},
      {"stands on its feature", [](auto& d) { d.pins[0].feature += 1; }},
      {"stands on its feature", [](auto& d) { d.pins[0].feature = 1000000; }},
      {"foot margin", [](auto& d) { d.pins[1].foot_margin_mm += 0.01; }},
      {"the other column shifts are those that load",
       [](auto& d) {
         d.alternatives.push_back({5, 5, d.jaw_separation_mm});
       }},
  };
  for (const Lie& lie : lies) {
    model::Design design = valve.plan.designs.front();
    ASSERT_NE(design.squeeze.critical, "spray[0]");
    lie.tell(design);
    const auto failed = failures(all_claims(valve, design));
    EXPECT_TRUE(std::ranges::any_of(failed, [&](const std::string& f) {
      return f.find(lie.claim) != std::string::npos;
    })) << lie.claim;
  }
}

TEST(Check, catches_lies_about_the_plan_as_a_whole) {
  const Planned& valve = valve_pedestal();
  Plan plan = valve.plan;
  std::swap(plan.designs.front(), plan.designs.back());
  plan.part.sha256[0] = plan.part.sha256[0] == '0' ? '1' : '0';
  plan.part.mass_kg *= 2;
  plan.funnel.strong = plan.funnel.resistable + 1;  // nor do the losses of force close then
  plan.losses["heights"]["no_engagement"] += 1;
  plan.losses["loading"]["pin_sweep"] += 1;
  plan.designs[1].id = plan.designs[0].id;
  EXPECT_EQ(failures(check_plan(plan, valve.scene)).size(), 8U);
}

}  // namespace
}  // namespace pinjaw::planner
