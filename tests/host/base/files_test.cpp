#include "host/base/files.hpp"

#include <gmock/gmock.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmath>
#include <limits>

#include "host/base/json_number.hpp"
#include "host/base/random.hpp"
#include "host/base/sha256.hpp"

namespace pinjaw::base {
namespace {

namespace fs = std::filesystem;

/// A folder of the test's own, removed at the end.
class Files : public testing::Test {
 protected:
  Files() : folder_(fs::temp_directory_path() / ("pinjaw-files-" + std::to_string(::getpid()))) {
    fs::create_directories(folder_);
  }
  ~Files() override { fs::remove_all(folder_); }
  [[nodiscard]] std::size_t count() const {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
  }
  fs::path folder_;
};

TEST_F(Files, what_is_written_reads_back) {
  const std::string bytes("a\0b\n", 4);
  ASSERT_TRUE(write_file_whole(folder_ / "out", bytes));
  EXPECT_EQ(read_file(folder_ / "out").value(), bytes);
  EXPECT_EQ(count(), 1U);
}

TEST_F(Files, a_failed_write_leaves_the_old_file_and_no_other) {
  ASSERT_TRUE(write_file_whole(folder_ / "out", "old"));
  const fs::path into_nowhere = folder_ / "no" / "such" / "out";
  EXPECT_THAT(write_file_whole(into_nowhere, "new").error().message,
              testing::HasSubstr("No such file or directory"));
  EXPECT_THAT(write_file_whole(folder_, "new").error().message, testing::HasSubstr("Is a directory"));
  EXPECT_EQ(read_file(folder_ / "out").value(), "old");
  EXPECT_EQ(count(), 1U);
}

TEST_F(Files, a_link_is_followed_and_permissions_kept) {
  ASSERT_TRUE(write_file_whole(folder_ / "out", "old"));
  ASSERT_EQ(::chmod((folder_ / "out").c_str(), 0640), 0);
  fs::create_symlink("out", folder_ / "link");
  ASSERT_TRUE(write_file_whole(folder_ / "link", "new"));
  EXPECT_TRUE(fs::is_symlink(folder_ / "link"));
  EXPECT_EQ(read_file(folder_ / "out").value(), "new");
  EXPECT_EQ(fs::status(folder_ / "out").permissions(), fs::perms(0640));
}

TEST_F(Files, a_device_is_written_straight) {
  EXPECT_TRUE(write_file_whole("/dev/null", "x"));
}

TEST_F(Files, a_full_disk_is_told) {
  EXPECT_THAT(write_file_whole("/dev/full", "x").error().message, testing::HasSubstr("No space left"));
}

TEST_F(Files, reading_stops_at_the_limit) {
  ASSERT_TRUE(write_file_whole(folder_ / "out", "12345"));
  EXPECT_EQ(read_file(folder_ / "out", 5).value(), "12345");
  EXPECT_EQ(read_file(folder_ / "out", 4).error().message, "is longer than 4 bytes");
}

TEST_F(Files, sha256_is_the_standard_one) {
  const std::string abc = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";  // FIPS 180-4
  EXPECT_EQ(sha256("abc"), abc);
  ASSERT_TRUE(write_file_whole(folder_ / "out", "abc"));
  EXPECT_EQ(sha256_of_file(folder_ / "out").value(), abc);
  EXPECT_FALSE(sha256_of_file(folder_ / "none").has_value());
}

TEST(JsonNumber, reads_back_as_the_same_double) {
  Random random(3);
  for (int i = 0; i < 10000; ++i) {
    const double value = random.normal() * std::pow(10.0, random.uniform(-30, 30));
    EXPECT_EQ(std::strtod(json_number(value).c_str(), nullptr), value);
  }
}

TEST(JsonNumber, rounds_and_drops_trailing_zeros) {
  EXPECT_EQ(json_number(1.23456, 2), "1.23");
  EXPECT_EQ(json_number(1.999, 2), "2");
  EXPECT_EQ(json_number(-0.001, 2), "0");
  EXPECT_EQ(json_number(1e300, 3), "1e+300");
}

TEST(JsonNumber, stops_at_what_JSON_cannot_say) {
  EXPECT_THROW(json_number(std::nan("")), std::logic_error);
  EXPECT_THROW(json_number(std::numeric_limits<double>::infinity()), std::logic_error);
}

}  // namespace
}  // namespace pinjaw::base
