#pragma once

#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <cstdio>
#include <fstream>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "protocol/bus/candump.hpp"
#include "protocol/socketcan/socket_bus.hpp"
#include "tests/support/process.hpp"

/// What tests on a real vcan0 share. Times are patience only, never asserted.
namespace pinjaw::socketcan {

inline constexpr std::int64_t kPatience_us = 10'000'000;

inline std::unique_ptr<SocketBus> opened(const Settings& settings = {},
                                         const std::string& interface = "vcan0") {
  auto bus = SocketBus::open(interface, settings);
  if (!bus) {
    ADD_FAILURE() << bus.error().message;
    return nullptr;
  }
  return std::move(*bus);
}

inline void run(const std::string& command) {
  ASSERT_TRUE(test::shell(command)) << command;
}

inline std::optional<bus::Received> next(bus::Bus& bus, std::int64_t patience_us = kPatience_us) {
  for (std::int64_t waited_us = 0; waited_us <= patience_us; waited_us += 5'000) {
    auto received = bus.receive();
    if (!received) {
      ADD_FAILURE() << received.error().message;
      return std::nullopt;
    }
    if (*received) return *received;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return std::nullopt;
}

inline wire::Frame frame_of(std::uint32_t id, std::vector<std::uint8_t> data) {
  wire::Frame frame{.id = id, .length = static_cast<std::uint8_t>(data.size())};
  std::copy(data.begin(), data.end(), frame.data.begin());
  return frame;
}

/// candump running beside the test; its lines so far, without times.
class Candump {
 public:
  Candump(const std::string& options, int frames) {
    const std::string command = "exec candump " + options + " -L -n " + std::to_string(frames) + " vcan0";
    const std::size_t others = listeners();
    pipe_ = ::popen(command.c_str(), "r");
    while (listeners() == others) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  ~Candump() {
    if (pipe_ != nullptr) ::pclose(pipe_);
  }
  Candump(const Candump&) = delete;
  Candump& operator=(const Candump&) = delete;
  Candump(Candump&&) = delete;
  Candump& operator=(Candump&&) = delete;

  std::vector<bus::LogLine> lines() {
    std::vector<bus::LogLine> lines;
    std::array<char, 256> buffer{};
    while (std::fgets(buffer.data(), buffer.size(), pipe_) != nullptr) {
      std::string text = buffer.data();
      while (!text.empty() && text.back() == '\n') text.pop_back();
      auto line = bus::parse_log_line(text);
      EXPECT_TRUE(line.has_value()) << text;
      if (line) lines.push_back(*line);
    }
    return lines;
  }

 private:
  /// Sockets that hear every frame of vcan0.
  static std::size_t listeners() {
    std::ifstream list("/proc/net/can/rcvlist_all");
    std::size_t count = 0;
    for (std::string line; std::getline(list, line);)
      count += line.find(" vcan0 ") != std::string::npos ? 1 : 0;
    return count;
  }

  FILE* pipe_ = nullptr;
};

}  // namespace pinjaw::socketcan
