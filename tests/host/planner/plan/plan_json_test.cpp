#include "host/planner/plan/plan_json.hpp"

#include <fstream>
#include <nlohmann/json.hpp>

#include "host/base/files.hpp"
#include "tests/host/planner/plan/planned.hpp"

namespace pinjaw::planner {
namespace {

using nlohmann::json;

std::filesystem::path written(const std::string& name, const std::string& text) {
  const auto path = std::filesystem::path(testing::TempDir()) / name;
  std::ofstream(path) << text;
  return path;
}

std::string message_of(const json& document) {
  const auto path = written("damaged.json", document.dump());
  const auto plan = read_plan(path);
  if (plan) return "no mistake";
  return base::render(plan.error(), "");
}

TEST(PlanJson, reads_back_as_the_same_plan) {
  const Plan& plan = cam().plan;
  const auto again = read_plan(written("cam.json", to_json(plan)));
  ASSERT_TRUE(again.has_value()) << base::render(again.error(), "");
  EXPECT_EQ(to_json(*again).substr(0, 2000), to_json(plan).substr(0, 2000));
  ASSERT_EQ(again->designs.size(), plan.designs.size());
  for (std::size_t i = 0; i < plan.designs.size(); ++i) {
    EXPECT_EQ(again->designs[i].squeeze.required_n, plan.designs[i].squeeze.required_n);
    EXPECT_EQ(again->designs[i].pins[2].contact_mm, plan.designs[i].pins[2].contact_mm);
  }
}

TEST(PlanJson, has_the_fields_that_users_script_against) {
  const json document = json::parse(to_json(cam().plan));
  EXPECT_EQ(document.at("format"), "pinjaw-plan/1");
  for (const char* key :
       {"features", "planar", "heights", "loadable", "not_wedging", "resistable", "strong"}) {
    EXPECT_TRUE(document.at("funnel").at(key).is_number_integer()) << key;
  }
  const json& design = document.at("designs").at(0);
  for (const char* key : {"id", "split", "jaw_separation_mm", "jaw_open_mm", "closure_margin", "part_pose",
                          "pins", "squeeze"}) {
    EXPECT_TRUE(design.contains(key)) << key;
  }
  for (const char* key : {"jaw", "col", "row", "length_mm", "top_z_mm", "contact_z_mm", "contact_mm",
                          "normal", "foot_margin_mm", "feature"}) {
    EXPECT_TRUE(design.at("pins").at(0).contains(key)) << key;
  }
  for (const char* key : {"required_n", "usable_n", "limit_n", "margin_n", "critical"}) {
    EXPECT_TRUE(design.at("squeeze").contains(key)) << key;
  }
  EXPECT_EQ(document.at("part").at("sha256").get<std::string>().size(), 64U);
  EXPECT_EQ(document.at("kit").at("sha256").get<std::string>().size(), 64U);
}

TEST(PlanJson, tells_the_path_of_every_damaged_field) {
  json document = json::parse(to_json(cam().plan));
  document["designs"][1]["pins"][0]["col"] = "two";
  document["designs"][2]["squeeze"].erase("required_n");
  const std::string message = message_of(document);
  EXPECT_NE(message.find("designs[1].pins[0].col: expected the number of a hole from 0 to 63, found \"two\""),
            std::string::npos)
      << message;
  EXPECT_NE(message.find("designs[2].squeeze.required_n: missing"), std::string::npos) << message;
  EXPECT_NE(message.find("2 mistakes"), std::string::npos) << message;
}

TEST(PlanJson, refuses_another_format) {
  EXPECT_NE(message_of({{"format", "pinjaw-plan/9"}}).find("format: expected pinjaw-plan/1"),
            std::string::npos);
}

TEST(PlanJson, survives_every_truncation) {
  const std::string text = to_json(plan_of("cam", {.top = 1}).plan);
  for (std::size_t size = 0; size + 2 < text.size(); size += 97) {
    EXPECT_FALSE(read_plan(written("cut.json", text.substr(0, size))).has_value()) << size;
  }
}

TEST(PlanJson, survives_every_field_being_replaced_by_something_else) {
  const json whole = json::parse(to_json(plan_of("cam", {.top = 1}).plan));
  const json flat = whole.flatten();
  for (const auto& [path, value] : flat.items()) {
    if (path.starts_with("/disturbances/") && !path.starts_with("/disturbances/0/"))
      continue;  // they are all alike
    for (const json& other : {json(nullptr), json("x"), json(-1e308), json::array(), json::object()}) {
      json damaged = whole;
      damaged[json::json_pointer(path)] = other;
      static_cast<void>(
          read_plan(written("odd.json", damaged.dump())));  // an answer of either kind, no crash
    }
  }
}

}  // namespace
}  // namespace pinjaw::planner
