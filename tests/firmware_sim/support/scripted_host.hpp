#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "protocol/bus/bus.hpp"
#include "protocol/wire/commands.hpp"
#include "protocol/wire/dispatch.hpp"
#include "protocol/wire/layout.hpp"
#include "protocol/wire/session.hpp"
#include "protocol/wire/transfer.hpp"

namespace pinjaw::test {

/// What a host heard of one node last.
struct Heard {
  std::optional<wire::NodeState> state;
  std::optional<wire::Custody> custody;
  std::optional<wire::Force> force;
  std::optional<wire::Acknowledge> answer;
  std::optional<std::uint16_t> challenge;
  std::vector<std::uint8_t> response;  ///< of the last layout service
};

/// A host that speaks frames and knows nothing else: heartbeat, one command and one transfer at a time.
class ScriptedHost {
 public:
  ScriptedHost(bus::Bus& bus, std::uint16_t epoch) : bus_(&bus), epoch_(epoch) {}

  /// One millisecond: hears, says its heartbeat, repeats an unanswered command.
  void step(int elapsed_ms = 1);

  void send(int node, wire::Command command);
  void request(int node, std::vector<std::uint8_t> message);
  void set_permit(std::uint16_t mask) { permit_ = mask; }

  [[nodiscard]] const Heard& heard(int node) const { return heard_.at(static_cast<std::size_t>(node)); }
  /// The last command was answered.
  [[nodiscard]] bool answered() const { return !waiting_; }
  [[nodiscard]] bool transferred() const { return !transfer_node_; }

 private:
  struct Waiting {
    int node = 0;
    wire::Command command;
    wire::Countdown repeat;
  };
  struct Session {
    std::uint16_t session = 0;
    wire::SequenceIssuer sequence;
  };

  void hear(const wire::Frame& frame);
  void hear(const wire::Received<wire::Acknowledge>& received);
  void hear(const wire::Segment& segment);
  template <class Message>
  void hear(const wire::Received<Message>& received);
  void say_heartbeat(std::uint16_t elapsed_ms);
  void say_command(std::uint16_t elapsed_ms);
  void say_segment(std::uint16_t elapsed_ms);

  bus::Bus* bus_;
  std::uint16_t epoch_;
  std::uint16_t permit_ = 0x3FFF;
  std::uint8_t heartbeat_counter_ = 0;
  wire::Countdown heartbeat_;
  std::array<Heard, 16> heard_;
  std::array<Session, 16> sessions_;
  std::optional<Waiting> waiting_;
  std::optional<int> transfer_node_;
  wire::TransferSender sender_;
  wire::TransferReceiver receiver_;
};

}  // namespace pinjaw::test
