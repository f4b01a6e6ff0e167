#include "protocol/bench/unix_socket.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <atomic>
#include <cstring>
#include <fstream>
#include <thread>

namespace pinjaw::bench {
namespace {

using ::testing::HasSubstr;

std::string fresh_path(const char* name) {
  return testing::TempDir() + "pinjaw-" + std::to_string(getpid()) + "-" + name;
}

/// A server answering in its own thread.
class Serving {
 public:
  Serving(SocketServer& server, Handler handler)
      : thread_([this, &server, handler = std::move(handler)] {
          while (!stop_) {
            server.serve(handler);
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
          }
        }) {}
  Serving(const Serving&) = delete;
  Serving& operator=(const Serving&) = delete;
  ~Serving() {
    stop_ = true;
    thread_.join();
  }

 private:
  std::atomic<bool> stop_ = false;
  std::thread thread_;
};

Reply truth_at_7(const Request& request) {
  if (std::holds_alternative<AskTruth>(request)) {
    Truth truth;
    truth.time_s = 7;
    truth.nodes.resize(14);
    return truth;
  }
  return Done{};
}

TEST(UnixSocket, carries_requests_and_replies) {
  const std::string path = fresh_path("carry");
  auto server = SocketServer::listen(path);
  ASSERT_TRUE(server) << server.error().message;
  const Serving serving(**server, truth_at_7);
  auto first = SocketWorld::connect(path);
  auto second = SocketWorld::connect(path);
  ASSERT_TRUE(first);
  ASSERT_TRUE(second);
  for (auto* world : {first->get(), second->get(), first->get()}) {
    const auto reply = world->ask(AskTruth{});
    ASSERT_TRUE(reply) << reply.error().message;
    EXPECT_EQ(std::get<Truth>(*reply).time_s, 7);
    EXPECT_EQ(std::get<Truth>(*reply).nodes.size(), 14U);
  }
}

TEST(UnixSocket, nobody_there_is_told_with_the_path) {
  const std::string path = fresh_path("nobody");
  const auto world = SocketWorld::connect(path);
  ASSERT_FALSE(world);
  EXPECT_THAT(world.error().message, HasSubstr(path));
}

TEST(UnixSocket, a_path_too_long_is_told) {
  EXPECT_FALSE(SocketServer::listen(std::string(200, 'x')));
  EXPECT_FALSE(SocketWorld::connect(std::string(200, 'x')));
}

TEST(UnixSocket, a_living_server_is_not_replaced) {
  const std::string path = fresh_path("living");
  auto server = SocketServer::listen(path);
  ASSERT_TRUE(server);
  EXPECT_FALSE(SocketServer::listen(path));
}

TEST(UnixSocket, a_file_that_is_no_socket_is_not_replaced) {
  const std::string path = fresh_path("file");
  std::ofstream(path) << "precious";
  EXPECT_FALSE(SocketServer::listen(path));
  EXPECT_EQ(access(path.c_str(), F_OK), 0);
  unlink(path.c_str());
}

TEST(UnixSocket, a_dead_server_s_socket_is_replaced) {
  const std::string path = fresh_path("dead");
  const int left = socket(AF_UNIX, SOCK_SEQPACKET, 0);
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::memcpy(address.sun_path, path.data(), path.size());
  ASSERT_EQ(bind(left, static_cast<const sockaddr*>(static_cast<const void*>(&address)), sizeof(address)), 0);
  close(left);
  EXPECT_TRUE(SocketServer::listen(path));
}

TEST(UnixSocket, the_socket_file_goes_with_its_server) {
  const std::string path = fresh_path("gone");
  {
    auto server = SocketServer::listen(path);
    ASSERT_TRUE(server);
    EXPECT_EQ(access(path.c_str(), F_OK), 0);
  }
  EXPECT_NE(access(path.c_str(), F_OK), 0);
}

TEST(UnixSocket, a_world_that_ended_is_told) {
  const std::string path = fresh_path("ended");
  auto server = SocketServer::listen(path);
  ASSERT_TRUE(server);
  auto world = SocketWorld::connect(path);
  ASSERT_TRUE(world);
  server->reset();
  const auto reply = (*world)->ask(AskTruth{});
  EXPECT_FALSE(reply);
}

}  // namespace
}  // namespace pinjaw::bench
