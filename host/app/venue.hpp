#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "host/base/expected.hpp"
#include "host/model/authentication.hpp"
#include "host/model/cell.hpp"
#include "protocol/bench/bench.hpp"
#include "protocol/bus/bus.hpp"

namespace pinjaw::app {

/// Where controllers are spoken to, and how time passes there.
class Venue {
 public:
  Venue() = default;
  Venue(const Venue&) = delete;
  Venue& operator=(const Venue&) = delete;
  virtual ~Venue() = default;

  virtual bus::Bus& bus() = 0;
  /// Nothing where nobody simulates a world.
  virtual bench::WorldPort* world() = 0;
  /// Lets a millisecond pass; gives the time since the venue opened.
  virtual std::int64_t tick_us() = 0;
  /// Loses a share (0..1) of all frames for so many seconds from now on; only where loses_frames().
  virtual void lose_frames(double share, double seconds) = 0;
  [[nodiscard]] virtual bool loses_frames() const = 0;
  /// Share of time that the bus was busy; nothing where the bus cannot tell.
  [[nodiscard]] virtual std::optional<double> load_percent() const = 0;
  /// Every frame seen so far, in candump's format.
  [[nodiscard]] virtual const std::string& log() const = 0;
};

/// An in-process bus in virtual time with a simulated controller for each station of `cell`. They ask for the
/// cell's key, else for `key`.
std::unique_ptr<Venue> open_sim_venue(const model::Cell& cell, std::uint64_t seed,
                                      const std::optional<model::Authentication>& key);

/// A CAN interface of this machine, and the world served at `world_path` (none where it is empty). Fails with
/// a sentence that tells the way out.
base::Expected<std::unique_ptr<Venue>> open_can_venue(std::string_view interface,
                                                      const std::string& world_path);

/// What follows "can:" in `bus`; nothing where it names another kind.
std::optional<std::string> can_interface(std::string_view bus);

}  // namespace pinjaw::app
