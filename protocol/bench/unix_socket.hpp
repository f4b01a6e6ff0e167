#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "protocol/bench/bench.hpp"

namespace pinjaw::bench {

/// The run's end of a world served on a Unix socket (SOCK_SEQPACKET, one message a packet).
class SocketWorld final : public WorldPort {
 public:
  /// Trouble names the path and the cause where nothing answers there.
  static tl::expected<std::unique_ptr<SocketWorld>, Trouble> connect(const std::string& path);

  ~SocketWorld() override;

  /// Trouble when the world is gone, or is silent for 5 s.
  tl::expected<Reply, Trouble> ask(const Request& request) override;

 private:
  explicit SocketWorld(int socket) : socket_(socket) {}
  int socket_;
};

/// The world's end: listens on `path`, answers any number of runs, never blocks.
class SocketServer {
 public:
  /// Takes the place of a dead server's left-over socket, never of a living one's or of another file.
  static tl::expected<std::unique_ptr<SocketServer>, Trouble> listen(const std::string& path);

  SocketServer(const SocketServer&) = delete;
  SocketServer& operator=(const SocketServer&) = delete;
  /// Removes the socket file.
  ~SocketServer();

  /// Answers what has arrived, then returns; gives the number of requests answered. A line that is no request
  /// is answered with Refused. Where nothing has arrived, waits for it `patience_ns` at most, or until a
  /// signal.
  int serve(const Handler& handler, std::int64_t patience_ns = 0);

 private:
  SocketServer(std::string path, int listener) : path_(std::move(path)), listener_(listener) {}
  bool answer(int client, const Handler& handler);

  std::string path_;
  int listener_;
  std::vector<int> clients_;
};

}  // namespace pinjaw::bench
