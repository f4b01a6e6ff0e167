#include "protocol/bench/unix_socket.hpp"

#include <poll.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>

namespace pinjaw::bench {
namespace {

constexpr std::size_t kPacketBytes = 65536;  // chosen: a truth of 14 nodes takes about 5 kB
constexpr int kReplyTimeout_ms = 5000;       // chosen: a world answers within its 1 ms loop
constexpr int kBacklog = 8;
constexpr std::int64_t kNs_per_s = 1'000'000'000;

Trouble trouble(const std::string& path, const std::string& what) {
  return {path + ": " + what + ": " + std::strerror(errno)};
}

tl::expected<sockaddr_un, Trouble> address_of(const std::string& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path.empty() || path.size() >= sizeof(address.sun_path)) {
    return tl::unexpected(Trouble{path + ": a Unix socket's path has 1 to 107 bytes"});
  }
  std::memcpy(address.sun_path, path.data(), path.size());
  return address;
}

int open_socket() {
  return socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0);
}

const sockaddr* generic(const sockaddr_un& address) {
  return static_cast<const sockaddr*>(static_cast<const void*>(&address));
}

/// Whether the socket file at `path` may be replaced: it is a socket that nobody listens on.
bool left_over(const std::string& path, const sockaddr_un& address) {
  struct stat status {};
  if (lstat(path.c_str(), &status) != 0 || !S_ISSOCK(status.st_mode)) return false;
  const int probe = open_socket();
  if (probe < 0) return false;
  const bool refused = connect(probe, generic(address), sizeof(address)) != 0 && errno == ECONNREFUSED;
  close(probe);
  return refused;
}

}  // namespace

tl::expected<std::unique_ptr<SocketWorld>, Trouble> SocketWorld::connect(const std::string& path) {
  const auto address = address_of(path);
  if (!address) return tl::unexpected(address.error());
  const int socket = open_socket();
  if (socket < 0) return tl::unexpected(trouble(path, "no socket"));
  if (::connect(socket, generic(*address), sizeof(*address)) != 0) {
    const Trouble why = trouble(path, "no world answers");
    close(socket);
    return tl::unexpected(why);
  }
  return std::unique_ptr<SocketWorld>(new SocketWorld(socket));
}

SocketWorld::~SocketWorld() {
  close(socket_);
}

tl::expected<Reply, Trouble> SocketWorld::ask(const Request& request) {
  const std::string line = encode(request);
  if (send(socket_, line.data(), line.size(), MSG_NOSIGNAL) < 0) {
    return tl::unexpected(trouble("world", "cannot send"));
  }
  pollfd waiting{.fd = socket_, .events = POLLIN, .revents = 0};
  int ready = 0;
  do {
    ready = poll(&waiting, 1, kReplyTimeout_ms);
  } while (ready < 0 && errno == EINTR);
  if (ready == 0) return tl::unexpected(Trouble{"world: silent for 5 s"});
  std::string packet(kPacketBytes, '\0');
  const ssize_t count = ready < 0 ? -1 : recv(socket_, packet.data(), packet.size(), 0);
  if (count < 0) return tl::unexpected(trouble("world", "cannot receive"));
  if (count == 0) return tl::unexpected(Trouble{"world: it has ended"});
  return decode_reply(std::string_view(packet).substr(0, static_cast<std::size_t>(count)));
}

tl::expected<std::unique_ptr<SocketServer>, Trouble> SocketServer::listen(const std::string& path) {
  const auto address = address_of(path);
  if (!address) return tl::unexpected(address.error());
  const int socket = open_socket();
  if (socket < 0) return tl::unexpected(trouble(path, "no socket"));
  int bound = bind(socket, generic(*address), sizeof(*address));
  if (bound != 0 && errno == EADDRINUSE && left_over(path, *address)) {
    unlink(path.c_str());
    bound = bind(socket, generic(*address), sizeof(*address));
  }
  if (bound != 0 || ::listen(socket, kBacklog) != 0) {
    const Trouble why = trouble(path, "cannot serve the world");
    close(socket);
    return tl::unexpected(why);
  }
  return std::unique_ptr<SocketServer>(new SocketServer(path, socket));
}

SocketServer::~SocketServer() {
  for (const int client : clients_) close(client);
  close(listener_);
  unlink(path_.c_str());
}

int SocketServer::serve(const Handler& handler, std::int64_t patience_ns) {
  std::vector<pollfd> waiting = {{.fd = listener_, .events = POLLIN, .revents = 0}};
  for (const int client : clients_) waiting.push_back({.fd = client, .events = POLLIN, .revents = 0});
  const timespec patience{.tv_sec = patience_ns / kNs_per_s, .tv_nsec = patience_ns % kNs_per_s};
  if (ppoll(waiting.data(), waiting.size(), &patience, nullptr) <= 0) return 0;
  int answered = 0;
  for (std::size_t i = 1; i < waiting.size(); ++i) {
    if (waiting[i].revents == 0) continue;
    if (answer(waiting[i].fd, handler)) {
      ++answered;
    } else {
      close(waiting[i].fd);
      std::erase(clients_, waiting[i].fd);
    }
  }
  if (waiting[0].revents != 0) {
    const int client = accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC);
    if (client >= 0) clients_.push_back(client);
  }
  return answered;
}

bool SocketServer::answer(int client, const Handler& handler) {
  std::string packet(kPacketBytes, '\0');
  const ssize_t count = recv(client, packet.data(), packet.size(), MSG_DONTWAIT);
  if (count <= 0) return count < 0 && (errno == EAGAIN || errno == EINTR);
  const auto request = decode_request(std::string_view(packet).substr(0, static_cast<std::size_t>(count)));
  const std::string line = encode(request ? handler(*request) : Reply(Refused{request.error().message}));
  return send(client, line.data(), line.size(), MSG_NOSIGNAL | MSG_DONTWAIT) >= 0;
}

}  // namespace pinjaw::bench
