#include "protocol/bus/candump.hpp"

#include <gtest/gtest.h>

#include <random>

namespace pinjaw::bus {
namespace {

using wire::Frame;
using wire::FrameKind;

TEST(Candump, writes_what_canplayer_reads) {
  Frame frame{.id = 0x62, .length = 3};
  frame.data = {0xDE, 0xAD, 0x01};
  EXPECT_EQ(to_log_line({1'700'000'000'000'042, "vcan0", frame}), "(1700000000.000042) vcan0 062#DEAD01");
  EXPECT_EQ(to_log_line({1, "can0", Frame{.id = 0x7FF, .length = 0}}), "(0000000000.000001) can0 7FF#");
  EXPECT_EQ(to_log_line({0, "can0", Frame{.id = 0x123, .extended = true, .length = 1}}),
            "(0000000000.000000) can0 00000123#00");
  EXPECT_EQ(to_log_line({0, "can0", Frame{.id = 0x123, .kind = FrameKind::Remote, .length = 0}}),
            "(0000000000.000000) can0 123#R");
  EXPECT_EQ(to_log_line({0, "can0", Frame{.id = 0x40, .kind = FrameKind::Error}}),
            "(0000000000.000000) can0 20000040#0000000000000000");
}

TEST(Candump, reads_what_it_writes) {
  std::mt19937_64 engine(5);
  for (int i = 0; i < 5000; ++i) {
    LogLine line{static_cast<std::int64_t>(engine() % 2'000'000'000'000'000), "can0", {}};
    line.frame.extended = engine() % 3 == 0;
    line.frame.id = static_cast<std::uint32_t>(engine() & (line.frame.extended ? 0x1FFFFFFFU : 0x7FFU));
    line.frame.length = static_cast<std::uint8_t>(engine() % 9);
    line.frame.kind = engine() % 5 == 0 ? FrameKind::Remote : FrameKind::Data;
    if (line.frame.kind == FrameKind::Data) {
      for (std::size_t k = 0; k < line.frame.length; ++k)
        line.frame.data.at(k) = static_cast<std::uint8_t>(engine());
    }
    const auto back = parse_log_line(to_log_line(line));
    ASSERT_TRUE(back.has_value()) << back.error().message;
    EXPECT_EQ(*back, line);
  }
}

TEST(Candump, writes_and_reads_frames_of_can_fd) {
  Frame frame{.id = 0x62, .kind = FrameKind::Fd, .length = wire::kFdLength};
  frame.data = {1, 2, 3, 4, 5, 6, 7, 8};
  frame.tail = {0xAA, 0xBB, 0xCC, 0xDD};
  const LogLine line{1, "can0", frame};
  EXPECT_EQ(to_log_line(line), "(0000000000.000001) can0 062##10102030405060708AABBCCDD");
  const auto back = parse_log_line(to_log_line(line));
  ASSERT_TRUE(back.has_value()) << back.error().message;
  EXPECT_EQ(*back, line);
  EXPECT_FALSE(parse_log_line("(1.000000) can0 20000040##10102030405060708AABBCCDD").has_value());
}

TEST(Candump, reads_lines_of_newer_tools) {
  for (const char* text :
       {"(1.000000) can0 123#01 R", "(1.000000) can0 123#01\r", "(1.000000) can0 123#01 T"}) {
    const auto line = parse_log_line(text);
    ASSERT_TRUE(line.has_value()) << text;
    EXPECT_EQ(line->frame.length, 1);
  }
}

TEST(Candump, refuses_every_other_line_and_says_why) {
  for (const char* text : {"",
                           "(",
                           "()",
                           "(1.5) can0 123#01",
                           "(1.0000000) can0 123#01",
                           "(a.000000) can0 123#01",
                           "(1.000000)",
                           "(1.000000) ",
                           "(1.000000)  123#01",
                           "(1.000000) can0",
                           "(1.000000) can0 12301",
                           "(1.000000) can0 12#01",
                           "(1.000000) can0 800#01",
                           "(1.000000) can0 1234567#01",
                           "(1.000000) can0 FFFFFFFF#01",
                           "(1.000000) can0 123#0",
                           "(1.000000) can0 123#0G",
                           "(1.000000) can0 123#001122334455667788",
                           "(1.000000) can0 123##101",
                           "(1.000000) can0 123#R9",
                           "(1.000000) can0 123#R10",
                           "(1.000000) can0 -12#00",
                           "(-1.000000) can0 123#01",
                           "(1.000000) can0 20000040#R"}) {
    const auto line = parse_log_line(text);
    EXPECT_FALSE(line.has_value()) << text;
    if (!line) {
      EXPECT_NE(line.error().message.find("candump"), std::string::npos);
    }
  }
}

TEST(Candump, survives_any_cut_and_any_byte) {
  const std::string good = "(1700000000.000042) vcan0 062#DEADBEEF";
  std::mt19937_64 engine(6);
  for (std::size_t size = 0; size < good.size(); ++size) (void)parse_log_line(good.substr(0, size));
  for (int i = 0; i < 100'000; ++i) {
    std::string bad = good;
    for (int k = 0; k < 3; ++k) bad[engine() % bad.size()] = static_cast<char>(engine());
    const auto line = parse_log_line(bad);
    if (line) {
      EXPECT_LE(line->frame.length, 8);
    }
  }
}

}  // namespace
}  // namespace pinjaw::bus
