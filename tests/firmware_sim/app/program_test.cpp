// Promises: SIM.
#include "firmware_sim/app/program.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <thread>

#include "protocol/wire/codec.hpp"

namespace pinjaw::jaw_app {
namespace {

/// A bus that nobody else is on.
class LonelyBus final : public bus::Bus {
 public:
  explicit LonelyBus(std::atomic<int>& sent) : sent_(&sent) {}
  bus::Expected<void> send(const wire::Frame&) override {
    ++*sent_;
    return {};
  }
  bus::Expected<std::optional<bus::Received>> receive() override { return std::nullopt; }
  [[nodiscard]] bus::Statistics statistics() const override { return {}; }

 private:
  std::atomic<int>* sent_;
};

TEST(Program, runs_its_nodes_serves_its_world_and_stops_when_told) {
  std::atomic<int> sent = 0;
  const std::string path = testing::TempDir() + "pinjaw-program-" + std::to_string(getpid());
  auto server = bench::SocketServer::listen(path);
  ASSERT_TRUE(server) << server.error().message;
  std::vector<std::unique_ptr<bus::Bus>> buses;
  buses.push_back(std::make_unique<LonelyBus>(sent));
  Options options;
  options.faults = {{.node = 2, .text = "spool_stuck", .at_s = 0.01}};
  Program program({{.node = 2}}, std::move(buses), std::move(*server), options);
  std::atomic<bool> stop = false;
  std::thread running([&] { program.run(stop); });

  auto world = bench::SocketWorld::connect(path);
  ASSERT_TRUE(world) << world.error().message;
  double time_s = 0;
  while (time_s < 0.3) {
    const auto reply = (*world)->ask(bench::AskTruth{});
    if (!reply) break;
    time_s = std::get<bench::Truth>(*reply).time_s;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  stop = true;
  running.join();
  EXPECT_GE(time_s, 0.3);
  EXPECT_GT(sent, 5);
}

bool passes(const std::vector<bus::Filter>& filters, std::uint32_t id) {
  return std::ranges::any_of(
      filters, [&](const bus::Filter& filter) { return (id & filter.mask) == (filter.id & filter.mask); });
}

TEST(Program, a_controller_listens_to_its_host_and_to_every_node_and_to_no_other_s_commands) {
  using wire::MessageType;
  const std::vector<bus::Filter> filters = filters_of(2);
  const auto hears = [&](MessageType type, std::uint8_t node) {
    return passes(filters, wire::id_of({type, node}));
  };
  EXPECT_TRUE(hears(MessageType::GlobalHold, 15));
  EXPECT_TRUE(hears(MessageType::HostHeartbeat, 0));
  EXPECT_TRUE(hears(MessageType::Command, 2));
  EXPECT_TRUE(hears(MessageType::TransferRequest, 2));
  for (std::uint8_t node = 1; node <= 14; ++node) {
    EXPECT_TRUE(hears(MessageType::Custody, node));
    EXPECT_TRUE(hears(MessageType::State, node));
    EXPECT_TRUE(hears(MessageType::Fault, node));
  }
  EXPECT_FALSE(hears(MessageType::Command, 3));
  for (const MessageType own : {MessageType::Force, MessageType::Acknowledge, MessageType::Pneumatics,
                                MessageType::LayoutStatus, MessageType::Identity}) {
    EXPECT_TRUE(hears(own, 2)) << "another that speaks under its number is found out";
    EXPECT_FALSE(hears(own, 3));
  }
  EXPECT_FALSE(hears(MessageType::TransferResponse, 2));
}

}  // namespace
}  // namespace pinjaw::jaw_app
