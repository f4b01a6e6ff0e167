#include <gtest/gtest.h>

#include <STEPControl_Writer.hxx>
#include <TopoDS_Shape.hxx>
#include <filesystem>
#include <fstream>
#include <numbers>

#include "host/config/read.hpp"
#include "tests/host/planner/plan/stl_twin.hpp"
#include "tests/support/places.hpp"

namespace pinjaw::planner {
namespace {

constexpr double kPi = std::numbers::pi;

model::Kit kit() {
  auto read = config::read_kit(test::source_dir("configs/kits/acc-pedestal.yaml"));
  if (!read) throw std::runtime_error(base::render(read.error(), "no kit"));
  return *read;
}

std::filesystem::path file_named(const std::string& name) {
  return std::filesystem::path(testing::TempDir()) / name;
}

/// Rounded at two corners, with a bite, a round bore and a six-sided one.
model::Profile bitten_plate() {
  using geometry::Arc;
  using geometry::Segment;
  model::Profile profile{.name = "bitten", .thickness_mm = 7, .loops = {}};
  profile.loops.push_back({{.curve = Segment{{0, 0}, {38, 0}}},
                           {.curve = Arc{{38, 6}, 6, -kPi / 2, kPi / 2}},
                           {.curve = Segment{{44, 6}, {44, 25}}},
                           {.curve = Arc{{34, 25}, 10, 0, kPi / 2}},
                           {.curve = Segment{{34, 35}, {25, 35}}},
                           {.curve = Arc{{17, 35}, 8, kPi, kPi}, .reversed = true},
                           {.curve = Segment{{9, 35}, {0, 31}}},
                           {.curve = Segment{{0, 31}, {0, 0}}}});
  profile.loops.push_back({{.curve = Arc{{30, 17}, 7, 0, kPi}, .reversed = true},
                           {.curve = Arc{{30, 17}, 7, kPi, kPi}, .reversed = true}});
  std::vector<model::ProfileEdge> hexagon;
  for (int i = 0; i < 6; ++i) {
    const geometry::Vector2d middle_mm(10, 12);
    hexagon.push_back({.curve = Segment{middle_mm + 6 * geometry::direction(-i * kPi / 3),
                                        middle_mm + 6 * geometry::direction(-(i + 1) * kPi / 3)}});
  }
  profile.loops.push_back(hexagon);
  return profile;
}

model::Profile shipped(const std::string& name) {
  auto profile = config::read_profile(test::source_dir("configs/parts/" + name + ".yaml"));
  if (!profile) throw std::runtime_error(base::render(profile.error(), "no profile"));
  return *profile;
}

struct Prism {
  std::string name;
  part::Shape shape;
  Sound step;
};

Prism prism(const model::Profile& profile) {
  auto shape = part::prism_of(profile);
  if (!shape) throw std::runtime_error(shape.error().message);
  const std::string file = file_named(profile.name + ".step");
  STEPControl_Writer writer;
  writer.Transfer(**shape, STEPControl_AsIs);
  writer.Write(file.c_str());
  return {profile.name, *shape, sound_designs(file, kit())};
}

Sound as_stl(const Prism& of, double deflection_mm) {
  const std::string file = file_named(of.name + ".stl");
  std::ofstream(file, std::ios::binary) << stl_of(of.shape, deflection_mm);
  return sound_designs(file, kit());
}

void expect_same_designs(const Sound& a, const Sound& b) {
  EXPECT_EQ(a.counts.funnel.features, b.counts.funnel.features);
  const Share share = share_of(a, b);
  EXPECT_GT(share.designs, 20U);
  EXPECT_EQ(share.matched, share.designs);
  for (const auto& [why, count] : share.lacking) ADD_FAILURE() << count << " lacking: " << why;
}

TEST(StlDesigns, of_prisms_are_those_of_step_however_coarse_the_mesh) {
  for (const model::Profile& profile : {bitten_plate(), shipped("cam"), shipped("l-plate")}) {
    const Prism made = prism(profile);
    for (const double deflection_mm : {0.005, 0.02, 0.1}) {
      SCOPED_TRACE(profile.name + " at " + std::to_string(deflection_mm));
      const Sound stl = as_stl(made, deflection_mm);
      expect_same_designs(made.step, stl);
      expect_same_designs(stl, made.step);
    }
  }
}

TEST(StlDesigns, have_pins_of_the_same_height_touching_at_the_same_heights) {
  const Prism made = prism(bitten_plate());
  const Sound stl = as_stl(made, 0.05);
  const auto& designs = made.step.designs;
  const auto found = matches(designs, stl.designs);
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (found[i] < 0) continue;  // counted above
    const model::Design& other = stl.designs[static_cast<std::size_t>(found[i])];
    for (std::size_t pin = 0; pin < 4; ++pin) {
      EXPECT_NEAR(designs[i].pins[pin].length_mm, other.pins[pin].length_mm, 1e-4);
      EXPECT_NEAR(designs[i].pins[pin].contact_z_mm.lo, other.pins[pin].contact_z_mm.lo, 1e-4);
      EXPECT_NEAR(designs[i].pins[pin].contact_z_mm.hi, other.pins[pin].contact_z_mm.hi, 1e-4);
    }
  }
}

}  // namespace
}  // namespace pinjaw::planner
