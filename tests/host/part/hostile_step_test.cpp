#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "host/base/random.hpp"
#include "tests/host/part/shipped_parts.hpp"

namespace pinjaw::part {
namespace {

using testing::HasSubstr;

std::filesystem::path written(const std::string& name, const std::string& bytes) {
  const auto file = std::filesystem::path(testing::TempDir()) / name;
  std::ofstream(file, std::ios::binary) << bytes;
  return file;
}

std::string text_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::stringstream text;
  text << in.rdbuf();
  return text.str();
}

std::string refusal_of(const std::string& name, const std::string& bytes) {
  const auto part = read_part(source_of(written(name, bytes)));
  return part ? "it was read" : part.error().message;
}

TEST(HostileStep, a_missing_file_is_named) {
  const auto part = read_part(source_of("no/such/part.step"));
  ASSERT_FALSE(part);
  EXPECT_THAT(part.error().message, HasSubstr("no/such/part.step: "));
}

TEST(HostileStep, a_folder_is_no_part) {
  const auto folder = std::filesystem::path(testing::TempDir()) / "folder.step";
  std::filesystem::create_directories(folder);
  EXPECT_FALSE(read_part(source_of(folder)));
}

TEST(HostileStep, another_kind_of_file_is_refused_by_its_ending) {
  EXPECT_THAT(refusal_of("part.docx", "x"), HasSubstr("part.docx: not a part file; expected .step"));
}

TEST(HostileStep, an_empty_file_is_called_empty) {
  EXPECT_THAT(refusal_of("empty.step", ""), HasSubstr("empty.step: the file is empty"));
}

TEST(HostileStep, text_is_not_step) {
  EXPECT_THAT(refusal_of("text.step", "Dear customer,\nplease find the part attached.\n"),
              HasSubstr("text.step: not a STEP file: it does not begin with ISO-10303-21"));
}

TEST(HostileStep, a_file_without_solids_says_so) {
  const std::string nothing =
      "ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION((''),'2;1');\nFILE_NAME('','',(''),(''),'','','');\n"
      "FILE_SCHEMA(('AUTOMOTIVE_DESIGN'));\nENDSEC;\nDATA;\nENDSEC;\nEND-ISO-10303-21;\n";
  EXPECT_THAT(refusal_of("nothing.step", nothing), HasSubstr("nothing.step: "));
}

TEST(HostileStep, a_file_cut_anywhere_is_refused_as_cut_short) {
  const std::string whole = text_of(shipped("l_bracket"));
  for (int percent = 5; percent < 100; percent += 5) {
    const std::string part = whole.substr(0, whole.size() * static_cast<std::size_t>(percent) / 100);
    EXPECT_THAT(refusal_of("cut.step", part), HasSubstr("the STEP file is cut short")) << percent;
  }
}

/// Whatever the bytes, the answer is a part or a sentence.
void expect_an_answer(const std::string& bytes, const std::string& what) {
  const auto part = read_part(source_of(written("damaged.step", bytes)));
  if (!part) {
    EXPECT_THAT(part.error().message, HasSubstr("damaged.step: ")) << what;
  } else {
    EXPECT_GT(part->volume_mm3, 0) << what;
  }
}

TEST(HostileStep, random_bytes_between_the_right_first_and_last_words_get_a_sentence) {
  base::Random random(1);
  for (int round = 0; round < 20; ++round) {
    std::string bytes = "ISO-10303-21;\n";
    for (int i = 0; i < 4000; ++i) bytes += static_cast<char>(random.bits());
    bytes += "\nEND-ISO-10303-21;\n";
    EXPECT_THAT(refusal_of("random.step", bytes), HasSubstr("random.step: ")) << round;
  }
}

TEST(HostileStep, damaged_entities_get_a_part_or_a_sentence) {
  const std::string whole = text_of(shipped("l_bracket"));
  base::Random random(2);
  for (int round = 0; round < 12; ++round) {
    std::string bytes = whole;
    for (int hits = 0; hits < 20; ++hits) {
      const auto at = static_cast<std::size_t>(random.uniform(700, static_cast<double>(bytes.size() - 40)));
      bytes[at] = "0123456789#(),$*'.E-"[random.bits() % 20];
    }
    expect_an_answer(bytes, "round " + std::to_string(round));
  }
}

TEST(HostileStep, a_lost_middle_gets_a_part_or_a_sentence) {
  const std::string whole = text_of(shipped("l_bracket"));
  for (const double from : {0.1, 0.4, 0.8}) {
    std::string bytes = whole;
    bytes.erase(static_cast<std::size_t>(from * static_cast<double>(whole.size())), whole.size() / 10);
    expect_an_answer(bytes, "from " + std::to_string(from));
  }
}

TEST(HostileStep, nothing_is_printed) {
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  const std::string whole = text_of(shipped("l_bracket"));
  std::string bytes = whole;
  bytes.erase(whole.size() / 2, whole.size() / 10);
  expect_an_answer(bytes, "printing");
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

}  // namespace
}  // namespace pinjaw::part
