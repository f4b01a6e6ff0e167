#include "firmware_sim/app/board_line.hpp"

#include <fcntl.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>

namespace pinjaw::jaw_app {
namespace {

constexpr int kWatchdog_ms = 100;  // chosen: a hundred missed turns of the board's loop
constexpr int kAskAgain_ms = 20;   // chosen: readings or their answer were lost on the line

}  // namespace

tl::expected<std::unique_ptr<BoardLine>, std::string> BoardLine::connect(const std::string& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path.size() >= sizeof(address.sun_path)) return tl::unexpected(path + ": too long for a Unix socket");
  std::memcpy(address.sun_path, path.data(), path.size());
  const int socket = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  const auto* generic = static_cast<const sockaddr*>(static_cast<const void*>(&address));
  if (socket < 0 || ::connect(socket, generic, sizeof(address)) != 0) {
    const std::string why = path + ": no board's serial line: " + std::strerror(errno);
    if (socket >= 0) close(socket);
    return tl::unexpected(why);
  }
  fcntl(socket, F_SETFL, O_NONBLOCK);
  return std::unique_ptr<BoardLine>(new BoardLine(socket));
}

BoardLine::~BoardLine() {
  close(socket_);
}

void BoardLine::listen() {
  std::array<std::uint8_t, 1024> bytes{};
  ++silent_ms_;
  ++asked_ms_;
  for (ssize_t count = 0; (count = read(socket_, bytes.data(), bytes.size())) > 0;) {
    for (ssize_t i = 0; i < count; ++i) {
      const auto packet = packets_.take(bytes.at(static_cast<std::size_t>(i)));
      if (!packet) continue;
      valves_ = link::valves_of(*packet);
      silent_ms_ = 0;
      if (link::number_of(*packet) == number_) answered_ = true;
    }
  }
  if (silent_ms_ > kWatchdog_ms) valves_ = {};
}

core::Valves BoardLine::exchange(const core::Sensors& sensors) {
  listen();
  if (to_send_.empty() && (answered_ || asked_ms_ >= kAskAgain_ms)) {
    answered_ = false;
    asked_ms_ = 0;
    const link::SensorsPacket packet = link::pack(sensors, ++number_);
    to_send_.assign(packet.begin(), packet.end());
  }
  const ssize_t sent = send(socket_, to_send_.data(), to_send_.size(), MSG_NOSIGNAL);
  if (sent > 0) to_send_.erase(to_send_.begin(), to_send_.begin() + sent);
  return valves_;
}

}  // namespace pinjaw::jaw_app
