#include "host/planner/plan/layout.hpp"

#include "tests/host/planner/plan/planned.hpp"

namespace pinjaw::planner {
namespace {

TEST(LayoutOf, a_design_travels_as_the_controller_will_read_it) {
  const Plan& plan = valve_pedestal().plan;
  const model::Design& design = plan.designs.front();
  const auto layout = layout_of({plan.kit, design, plan.part.sha256, false});
  ASSERT_TRUE(layout.has_value()) << layout.error().message;
  const wire::EncodedLayout encoded = wire::encode(*layout);
  const auto decoded = wire::decode_layout(encoded.span());
  ASSERT_TRUE(decoded.has_value());
  EXPECT_EQ(*decoded, *layout);
  EXPECT_EQ(layout->pin_count, 4);
  EXPECT_NEAR(layout->separation_contact_10um / 100.0, design.jaw_separation_mm, 0.005);
  EXPECT_NEAR(layout->grid_pitch_nm * 1e-6, plan.kit.grid.spacing_mm, 1e-6);
  EXPECT_EQ(layout->part_id, std::stoul(plan.part.sha256.substr(0, 8), nullptr, 16));
}

TEST(LayoutOf, rounds_what_is_required_up_and_what_is_allowed_down) {
  Plan plan = cam().plan;
  model::Design design = plan.designs.front();
  plan.kit.actuator.max_squeeze_n = 139.98;
  design.squeeze.required_n = 40.01;
  const auto layout = layout_of({plan.kit, design, plan.part.sha256, false});
  ASSERT_TRUE(layout.has_value());
  EXPECT_EQ(layout->f_required_dn, 401);
  EXPECT_EQ(layout->f_limit_dn, 1399);
}

TEST(LayoutOf, asks_at_least_twice_the_light_squeeze) {
  Plan plan = cam().plan;
  model::Design design = plan.designs.front();
  design.squeeze.required_n = 1;
  const auto layout = layout_of({plan.kit, design, plan.part.sha256, false});
  ASSERT_TRUE(layout.has_value());
  EXPECT_EQ(layout->f_required_dn, 2 * layout->f_light_dn);
}

TEST(LayoutOf, a_pallet_requires_no_force) {
  const Plan& plan = cam().plan;
  const auto layout = layout_of({plan.kit, plan.designs.front(), plan.part.sha256, true});
  ASSERT_TRUE(layout.has_value());
  EXPECT_TRUE(layout->passive);
  EXPECT_EQ(layout->f_required_dn, 0);
  EXPECT_EQ(layout->f_light_dn, 0);
}

TEST(LayoutOf, says_why_a_kit_cannot_be_sent) {
  Plan plan = cam().plan;
  plan.kit.actuator.max_squeeze_n = 300;
  const auto strong = layout_of({plan.kit, plan.designs.front(), plan.part.sha256, false});
  ASSERT_FALSE(strong.has_value());
  EXPECT_NE(strong.error().message.find("the bus carries up to 250 N"), std::string::npos);

  plan = cam().plan;
  model::Design wide = plan.designs.front();
  wide.jaw_open_mm = 205;
  const auto far = layout_of({plan.kit, wide, plan.part.sha256, false});
  ASSERT_FALSE(far.has_value());
  EXPECT_NE(far.error().message.find("the bus carries up to 204 mm"), std::string::npos);
}

}  // namespace
}  // namespace pinjaw::planner
