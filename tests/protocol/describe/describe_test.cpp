#include "protocol/describe/describe.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cctype>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "protocol/describe/fault_help.hpp"
#include "protocol/describe/physical.hpp"
#include "protocol/wire/names.hpp"
#include "protocol/wire/table.hpp"
#include "tests/support/places.hpp"

namespace pinjaw::describe {
namespace {

std::string content(const std::string& path) {
  std::ifstream file(test::source_dir(path));
  EXPECT_TRUE(file.good()) << path;
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

TEST(Dbc, checked_in_is_the_one_the_table_gives) {
  EXPECT_TRUE(content("protocol/pinjaw.dbc") == to_dbc(all_nodes()))
      << "write it anew: build/bin/write_descriptions .";
}

TEST(BusPage, carries_the_tables_the_code_gives) {
  const std::string page = content("docs/bus.md");
  EXPECT_TRUE(page.find(to_markdown()) != std::string::npos)
      << "write it anew: build/bin/write_descriptions .";
}

TEST(Dbc, of_some_nodes_names_only_them) {
  const std::string dbc = to_dbc({1, 3});
  EXPECT_THAT(dbc, ::testing::HasSubstr("BU_: HOST NODE1 NODE3 SERVICE\n"));
  EXPECT_THAT(dbc, ::testing::HasSubstr("BO_ 99 STATE_3: 8 NODE3\n"));
  EXPECT_THAT(dbc, ::testing::Not(::testing::HasSubstr("STATE_2")));
}

TEST(Dbc, has_ascii_and_no_quotes_within_quotes) {
  for (const wire::MessageSpec& spec : wire::kMessages) {
    std::string texts = spec.comment;
    for (const wire::FieldSpec& field : spec.fields) texts += std::string(field.comment) + field.unit;
    for (const char c : texts) EXPECT_TRUE(c >= ' ' && c <= '~' && c != '"') << spec.name;
  }
}

TEST(Json, lists_every_message_and_field) {
  const auto json = nlohmann::json::parse(to_json());
  EXPECT_EQ(json.at("format"), "pinjaw-bus/1");
  ASSERT_EQ(json.at("messages").size(), wire::kMessages.size());
  for (std::size_t i = 0; i < wire::kMessages.size(); ++i) {
    const auto& message = json.at("messages").at(i);
    EXPECT_EQ(message.at("name"), wire::kMessages.at(i).name);
    EXPECT_EQ(message.at("fields").size(), wire::kMessages.at(i).fields.size());
  }
}

/// SUPPLY_VOLTAGE as the sources spell it: FaultCode::SupplyVoltage.
std::string in_source(const std::string& name) {
  std::string text = "FaultCode::";
  bool begins = true;
  for (const char c : name) {
    if (c != '_') text += begins ? c : static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    begins = c == '_';
  }
  return text;
}

TEST(FaultHelps, tell_which_faults_the_simulated_controller_reports) {
  std::string core;
  for (const auto& file : std::filesystem::directory_iterator(test::source_dir("firmware_sim/core"))) {
    if (file.path().extension() == ".cpp")
      core += content("firmware_sim/core/" + file.path().filename().string());
  }
  for (const FaultHelp& help : fault_helps()) {
    const std::string name = in_source(std::string(wire::to_string(help.code)));
    EXPECT_EQ(core.find(name) != std::string::npos, help.simulated) << name;
  }
}

TEST(Physical, is_exact) {
  EXPECT_EQ(physical(771, {1, 10}), "77.1");
  EXPECT_EQ(physical(1, {1, 20}), "0.05");
  EXPECT_EQ(physical(3, {5, 2}), "7.5");
  EXPECT_EQ(physical(4, {5, 2}), "10");
  EXPECT_EQ(physical((std::uint64_t{1} << 48) - 1, {1, 1}), "281474976710655");
}

}  // namespace
}  // namespace pinjaw::describe
