#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

#include "protocol/bus/candump.hpp"
#include "tests/protocol/describe/our_decoding.hpp"
#include "tests/support/places.hpp"

/// The log that candump wrote of a whole run on vcan, decoded by canmatrix with our DBC and by our codec.
namespace pinjaw::wire {
namespace {

TEST(CandumpLog, says_the_same_to_canmatrix_and_to_our_codec) {
  const std::string log = OUT_DIR "/candump.log";
  const std::string decoded_file = OUT_DIR "/decoded.json";
  const std::string command = "/usr/bin/python3 " +
                              test::source_dir("tests/protocol/describe/decode_with_canmatrix.py") + " " +
                              test::source_dir("protocol/pinjaw.dbc") + " " + log + " > " + decoded_file;
  ASSERT_EQ(std::system(command.c_str()), 0) << "needs Debian's python3-canmatrix: " << command;

  std::ifstream lines(log);
  std::ifstream decoded(decoded_file);
  std::string text;
  std::string line;
  std::set<std::string> messages;
  int frames = 0;
  while (std::getline(lines, text)) {
    ASSERT_TRUE(std::getline(decoded, line));
    const auto read = bus::parse_log_line(text);
    ASSERT_TRUE(read) << text;
    const Frame frame = read->frame;
    testing::Collect ours{frame};
    ASSERT_FALSE(dispatch(frame, ours).has_value()) << text;
    const auto theirs = nlohmann::json::parse(line);
    ASSERT_EQ(theirs.at("message"), ours.decoded.message) << text;
    ASSERT_EQ((theirs.at("raw").get<std::map<std::string, std::uint64_t>>()), ours.decoded.raw) << text;
    ASSERT_EQ((theirs.at("physical").get<std::map<std::string, double>>()), ours.decoded.physical) << text;
    messages.insert(ours.decoded.message);
    ++frames;
  }
  EXPECT_GT(frames, 3000);
  for (const std::string name :
       {"HOST_HB", "CUSTODY_1", "CUSTODY_2", "STATE_3", "FORCE_1", "CMD_2", "ACK_2"}) {
    EXPECT_TRUE(messages.contains(name)) << name;
  }
}

}  // namespace
}  // namespace pinjaw::wire
