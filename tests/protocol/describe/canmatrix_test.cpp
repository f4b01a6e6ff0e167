#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "protocol/bus/candump.hpp"
#include "tests/protocol/describe/our_decoding.hpp"
#include "tests/protocol/wire/sample_messages.hpp"
#include "tests/support/places.hpp"

/// Random frames of every message go into a candump log; canmatrix decodes it by our DBC; its numbers must be
/// ours.
namespace pinjaw::wire {
namespace {

using testing::Collect;
using testing::Engine;

template <class... Messages>
struct AllMessages {
  static void append(std::vector<Frame>& frames, Engine& engine) {
    (frames.push_back(
         pack(testing::random_message<Messages>(engine), testing::random_label<Messages>(engine))),
     ...);
  }
};
using Catalogue = AllMessages<GlobalHold, FaultReport, Custody, NodeState, Force, HostHeartbeat, HostTime,
                              Command, Acknowledge, Pneumatics, LayoutStatus, Identity>;

std::vector<Frame> random_frames(int rounds) {
  Engine engine(31);
  std::vector<Frame> frames;
  for (int i = 0; i < rounds; ++i) {
    Catalogue::append(frames, engine);
    Segment segment{{MessageType::TransferRequest, static_cast<std::uint8_t>(1 + engine() % 14)},
                    to_payload(engine())};
    segment.data[0] &= 0x3F;
    frames.push_back(pack_segment(segment));
    segment.identifier.type = MessageType::TransferResponse;
    frames.push_back(pack_segment(segment));
  }
  return frames;
}

TEST(Canmatrix, reads_in_a_log_what_our_codec_reads) {
  const std::vector<Frame> frames = random_frames(120);
  const std::string folder = std::filesystem::temp_directory_path().string() + "/canmatrix_test." +
                             std::to_string(::testing::UnitTest::GetInstance()->random_seed()) + '.' +
                             std::to_string(std::hash<std::string>{}(test::program()));
  std::filesystem::create_directories(folder);
  {
    std::ofstream log(folder + "/frames.log");
    std::int64_t time_us = 0;
    for (const Frame& frame : frames) log << bus::to_log_line({time_us += 270, "can0", frame}) << '\n';
  }
  const std::string command = "/usr/bin/python3 " +
                              test::source_dir("tests/protocol/describe/decode_with_canmatrix.py") + " " +
                              test::source_dir("protocol/pinjaw.dbc") + " " + folder + "/frames.log > " +
                              folder + "/decoded.json 2> " + folder + "/errors.txt";
  ASSERT_EQ(std::system(command.c_str()), 0) << "needs Debian's python3-canmatrix: " << command;

  std::ifstream decoded(folder + "/decoded.json");
  std::string line;
  for (const Frame& frame : frames) {
    ASSERT_TRUE(std::getline(decoded, line));
    const auto theirs = nlohmann::json::parse(line);
    Collect ours{frame};
    ASSERT_FALSE(dispatch(frame, ours).has_value());
    std::string name = ours.decoded.message;
    EXPECT_EQ(theirs.at("message"), name);
    EXPECT_EQ((theirs.at("raw").get<std::map<std::string, std::uint64_t>>()), ours.decoded.raw) << name;
    EXPECT_EQ((theirs.at("physical").get<std::map<std::string, double>>()), ours.decoded.physical) << name;
  }
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace pinjaw::wire
