#include "host/config/key_file.hpp"

#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "host/config/read.hpp"
#include "tests/support/places.hpp"

namespace pinjaw::config {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

/// A folder of its own, removed at the end.
class KeyFile : public testing::Test {
 protected:
  KeyFile() {
    std::string name = (fs::temp_directory_path() / "pinjaw-key-XXXXXX").string();
    folder_ = mkdtemp(name.data());
  }
  ~KeyFile() override { fs::remove_all(folder_); }
  fs::path write(const std::string& name, const std::string& text, fs::perms permissions = kOwners) {
    const fs::path path = folder_ / name;
    std::ofstream(path) << text;
    fs::permissions(path, permissions);
    return path;
  }
  static std::string why(const fs::path& path) {
    const auto key = read_key_file(path);
    return key ? "" : key.error().message;
  }
  static constexpr fs::perms kOwners = fs::perms::owner_read | fs::perms::owner_write;
  const std::string digits_ = "000102030405060708090a0B0C0D0E0F";
  fs::path folder_;
};

TEST_F(KeyFile, holds_32_hexadecimal_digits) {
  const auto key = read_key_file(write("cell.key", " " + digits_ + "\n"));
  ASSERT_TRUE(key.has_value()) << key.error().message;
  for (std::size_t i = 0; i < key->size(); ++i) EXPECT_EQ((*key)[i], i);
}

TEST_F(KeyFile, of_anything_else_is_refused_and_never_told) {
  for (const std::string& text : {std::string(), digits_ + "0", digits_.substr(1), "0x" + digits_.substr(2),
                                  digits_ + "\n" + digits_, std::string(5000, '0')}) {
    const std::string told = why(write("cell.key", text));
    EXPECT_THAT(told, HasSubstr("expected 32 hexadecimal digits"));
    EXPECT_EQ(told.find("0203"), std::string::npos) << told;
  }
}

TEST_F(KeyFile, that_everyone_may_read_or_change_is_refused) {
  for (const fs::perms open : {fs::perms::others_read, fs::perms::others_write}) {
    EXPECT_THAT(why(write("cell.key", digits_, kOwners | open)), HasSubstr("chmod 600"));
  }
  EXPECT_EQ(why(write("cell.key", digits_, kOwners | fs::perms::group_read)), "");
}

TEST_F(KeyFile, that_is_missing_or_a_folder_is_told) {
  EXPECT_THAT(why(folder_ / "none.key"), HasSubstr("No such file"));
  EXPECT_THAT(why(folder_), HasSubstr("not a regular file"));
}

TEST_F(KeyFile, named_by_a_controller_or_a_cell_turns_authentication_on) {
  write("cell.key", digits_);
  const std::string kit = "kit: " + test::source_dir("configs/kits/acc-pallet.yaml") + "\n";
  const auto controller =
      read_controller(write("pallet.yaml", "controller: pallet\nnode: 3\npassive: true\n" + kit +
                                               "authentication: {key_file: cell.key}\n"));
  ASSERT_TRUE(controller.has_value());
  ASSERT_TRUE(controller->authentication.has_value());
  EXPECT_EQ(controller->authentication->key[15], 15);

  std::ifstream shipped(test::source_dir("configs/cells/acc.yaml"));
  std::string text((std::istreambuf_iterator<char>(shipped)), {});
  for (auto at = text.find("../"); at != std::string::npos; at = text.find("../"))
    text.replace(at, 3, test::source_dir("configs/"));
  const auto cell = read_cell(write("cell.yaml", text + "authentication: {key_file: cell.key}\n"));
  ASSERT_TRUE(cell.has_value()) << base::render(cell.error(), "");
  EXPECT_TRUE(cell->authentication.has_value());
}

}  // namespace
}  // namespace pinjaw::config
