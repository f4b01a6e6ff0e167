#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "firmware_sim/node/node.hpp"
#include "firmware_sim/target/sensor_link.hpp"

namespace pinjaw::jaw_app {

/// A board's serial line behind a Unix stream socket, as an emulator offers it. Nothing here waits. The board
/// answers readings with what its valves are told, and new ones go out only once the last were answered: a
/// slow board gets fewer of them, and does not work through a queue of old ones.
class BoardLine final : public node::ExternalBoard {
 public:
  /// A sentence on what is wrong where nobody listens at `path`.
  static tl::expected<std::unique_ptr<BoardLine>, std::string> connect(const std::string& path);
  ~BoardLine() override;
  BoardLine(const BoardLine&) = delete;
  BoardLine& operator=(const BoardLine&) = delete;

  /// De-energised valves until the board has told others, and again once it says nothing for 100 ms: its
  /// watchdog.
  core::Valves exchange(const core::Sensors& sensors) override;

 private:
  explicit BoardLine(int socket) : socket_(socket) {}
  void listen();

  int socket_;
  std::vector<std::uint8_t> to_send_;  ///< the rest of a packet that went out in part
  link::PacketReader<link::kValvesBytes> packets_{link::kValvesMark};
  core::Valves valves_;
  int silent_ms_ = 0;
  int asked_ms_ = 0;         ///< since readings went out
  std::uint8_t number_ = 0;  ///< of the readings that went out last
  bool answered_ = true;     ///< those
};

}  // namespace pinjaw::jaw_app
