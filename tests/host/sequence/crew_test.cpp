#include "host/sequence/crew.hpp"

#include <gtest/gtest.h>

#include "host/sequence/loads.hpp"
#include "tests/host/sequence/small_cell.hpp"

namespace pinjaw::sequence {
namespace {

Crew crew() {
  const testing::SmallCell& small = testing::small_cell();
  return Crew::of(small.cell, small.design, small.scene).value();
}

TEST(Crew, names_both_stations_of_a_handoff_in_each_others_layouts) {
  Crew all = crew();
  for (const model::Handoff& handoff : testing::small_cell().cell.handoffs) {
    const Member& giver = all.at(handoff.giver);
    const Member& receiver = all.at(handoff.receiver);
    const wire::LayoutPeer* takes = giver.layout().peer(receiver.node());
    const wire::LayoutPeer* gives = receiver.layout().peer(giver.node());
    ASSERT_TRUE(takes != nullptr && gives != nullptr);
    EXPECT_EQ(takes->pair_crc, gives->pair_crc);
    EXPECT_EQ(takes->layout_crc, wire::layout_crc_of(receiver.layout()));
    EXPECT_EQ(gives->layout_crc, wire::layout_crc_of(giver.layout()));
    EXPECT_EQ(takes->f_required_dn, receiver.layout().f_required_dn);
  }
  EXPECT_EQ(all.at("arm").layout().peer_count, 2);
  EXPECT_EQ(all.at("pallet").layout().peer(all.at("pedestal").node()), nullptr);
}

TEST(Crew, squeezes_so_that_even_the_least_force_inferred_suffices) {
  Crew all = crew();
  for (const Member& member : all.members()) {
    if (!member.grips()) continue;
    EXPECT_EQ(member.squeeze().set_dn, member.layout().f_required_dn + 120) << member.name();
    EXPECT_EQ(member.squeeze().permit_dn, 1400) << member.name();
    EXPECT_GE(member.layout().f_required_dn, member.design().squeeze.required_n * 10);
  }
  EXPECT_EQ(all.at("pallet").squeeze().set_dn, 0);
}

TEST(Crew, needs_no_more_for_the_weight_than_was_planned_and_nothing_of_a_pallet) {
  Crew all = crew();
  const Carried block{.mass_kg = 0.2, .centroid_mm = testing::small_cell().scene.part.centroid_mm};
  for (const std::string name : {"arm", "pedestal"}) {
    Member& member = all.at(name);
    EXPECT_GT(member.needed_n(weight(block)), 0);
    EXPECT_LE(member.needed_n(weight(block)), member.design().squeeze.required_n);
  }
  EXPECT_EQ(all.at("pallet").needed_n(weight(block)), 0);
}

TEST(Crew, needs_twice_the_squeeze_for_twice_the_load) {
  Crew all = crew();
  Member& member = all.at("pedestal");
  const model::Wrench once = weight({.mass_kg = 1, .centroid_mm = {20, 15, 20}});
  EXPECT_NEAR(member.needed_n(2 * once), 2 * member.needed_n(once), 1e-6);
}

TEST(Crew, turns_directions_of_a_station_into_the_part) {
  Crew all = crew();
  const model::Vector3d up = model::Vector3d::UnitZ();
  EXPECT_TRUE(all.at("pedestal").in_part_frame(up).isApprox(up));
  EXPECT_TRUE(all.at("arm").in_part_frame(up).isApprox(-up));  // it reaches the part from above
  for (const Member& member : all.members()) {
    const model::Vector3d along = member.in_part_frame(model::Vector3d::UnitX());
    EXPECT_NEAR(along.norm(), 1, 1e-12);
    EXPECT_NEAR(along.z(), 0, 1e-12);
  }
}

TEST(Crew, of_a_station_with_more_handoffs_than_a_layout_can_name_is_refused) {
  testing::SmallCell small = testing::small_cell();
  for (int i = 0; i < 3; ++i) {
    const std::string name = "pallet " + std::to_string(i);
    small.cell.stations.push_back(small.cell.stations.back());
    small.cell.stations.back().name = name;
    small.cell.stations.back().node = 4 + i;
    small.design.stations.push_back(small.design.stations.back());
    small.design.stations.back().station = name;
    small.cell.handoffs.push_back({name, "arm"});
  }
  const auto refused = Crew::of(small.cell, small.design, small.scene);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().message,
            "station arm: it hands over to more than 4 stations, which no layout can say");
}

}  // namespace
}  // namespace pinjaw::sequence
