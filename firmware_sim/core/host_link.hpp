#pragma once

#include <array>
#include <cstdint>

#include "protocol/wire/codec.hpp"
#include "protocol/wire/reception.hpp"
#include "protocol/wire/timing.hpp"

namespace pinjaw::core {

/// What a controller knows of hosts. Two are followed at a time, so that a second one is noticed without
/// making the first seem lost. Never heard is the same as lost.
class HostLink {
 public:
  /// Takes in a heartbeat whose checksum is right.
  void hear(const wire::Received<wire::HostHeartbeat>& heartbeat, std::uint8_t node);

  /// Lets time pass.
  void advance(std::uint16_t elapsed_ms);

  /// The host that is followed has been heard, in order, within 200 ms.
  [[nodiscard]] bool alive() const { return hosts_[0].followed.running(); }
  /// It lets this node move.
  [[nodiscard]] bool permits() const { return alive() && hosts_[0].permit; }
  /// Its epoch; meaningful while alive().
  [[nodiscard]] std::uint16_t epoch() const { return hosts_[0].epoch; }
  /// Two epochs were heard within 200 ms: the other one never alone, for it is followed then.
  [[nodiscard]] bool two_hosts() const { return hosts_[1].heard.running(); }

 private:
  struct Host {
    std::uint16_t epoch = 0;
    bool permit = false;
    wire::CounterCheck counter;
    wire::Countdown
        followed;           ///< since the last usable heartbeat: a repeated one must not make the host lost
    wire::Countdown heard;  ///< since any heartbeat of this epoch
  };
  Host& slot_for(std::uint16_t epoch);

  std::array<Host, 2> hosts_{};  ///< the one that is followed, and another
};

}  // namespace pinjaw::core
