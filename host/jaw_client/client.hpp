#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "host/jaw_client/node_view.hpp"
#include "host/jaw_client/outcome.hpp"
#include "protocol/bus/bus.hpp"
#include "protocol/wire/aes.hpp"
#include "protocol/wire/commands.hpp"
#include "protocol/wire/layout.hpp"

namespace pinjaw::jaw_client {

/// A host on a bus: keeps its heartbeat, watches the controllers, and carries out one operation at a time on
/// each. It has no clock: call step() at least every 5 ms of the caller's time, and read outcome() after it.
///
///     client.permit(2, true);
///     client.arm(2, layout_crc);
///     do { advance(); client.step(now_us); } while (client.outcome(2).pending());
class Client {
 public:
  struct Settings {
    std::uint16_t epoch = 1;         ///< drawn anew by each start of a host
    bool speaks = true;              ///< false: watches only, and sends nothing
    std::optional<wire::Key> key{};  ///< shared with the controllers: every one of them must know it
    bool can_fd = false;             ///< with a key: CAN FD, with a MAC in every frame
    std::uint64_t nonces = 1;        ///< with a key: drawn anew by each start of a host
  };

  Client(bus::Bus& bus, Settings settings);
  ~Client();
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;
  Client(Client&&) = delete;
  Client& operator=(Client&&) = delete;

  /// Reads what came and sends what is due. `now_us` never falls.
  void step(std::int64_t now_us);

  /// Precondition everywhere: node 1..14.
  [[nodiscard]] const NodeView& node(std::uint8_t node) const;
  [[nodiscard]] bool alive(std::uint8_t node) const;

  /// HOST_HB's permission to move, off at first. Some operations need it and say so when it is missing.
  void permit(std::uint8_t node, bool allowed);
  void set_state(wire::HostState state);

  // Operations. Each begins at once and replaces the node's last; outcome() tells how it stands.

  /// WRITE, COMMIT and READBACK compared byte by byte. Ends with the layout committed and the session closed.
  void send_layout(std::uint8_t node, const wire::Layout& layout);
  /// Waits until the node hears this host, then opens a session for the layout with this CRC; where the node
  /// may move, until it has left LOADED.
  void arm(std::uint8_t node, std::uint32_t layout_crc);
  void disarm(std::uint8_t node);
  /// Closes by light force on a part that a person holds (needs the local enable); done in SEATED.
  void close_light(std::uint8_t node);
  /// Done in HOLD or TAKEN; a fall back to SEATED is a fault.
  void squeeze(std::uint8_t node, wire::SqueezeForces forces);
  /// Done in OFFERED; whether the handoff then completes is seen in the states.
  void offer(std::uint8_t giver, std::uint8_t receiver);
  /// Waits for the giver's OFFER, then closes lightly; done in SEATED (TAKEN for a passive receiver).
  void accept(std::uint8_t receiver, std::uint8_t giver);
  void abort(std::uint8_t node);
  /// Needs neither session nor permission.
  void hold(std::uint8_t node);
  /// Opens an empty gripper; done in READY or LOADED.
  void open_empty(std::uint8_t node);
  /// MANUAL_RELEASE in its two steps; done in READY or LOADED.
  void release(std::uint8_t node);
  void clear_fault(std::uint8_t node);
  /// GLOBAL_HOLD to everyone, three times; no outcome.
  void hold_everyone(wire::Reason reason);

  /// The last operation's on this node; Done where there was none.
  [[nodiscard]] const Outcome& outcome(std::uint8_t node) const;
  /// A session of ours is open there, as far as we know.
  [[nodiscard]] bool armed(std::uint8_t node) const;

  /// Another host's heartbeat was heard within the last second.
  [[nodiscard]] bool other_host() const;
  /// Why the bus no longer works.
  [[nodiscard]] const std::optional<bus::Failure>& bus_failure() const;
  /// Frames that were no messages of ours, by what was wrong with them.
  [[nodiscard]] std::uint64_t rejected(wire::FrameError error) const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace pinjaw::jaw_client
