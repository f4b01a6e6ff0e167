#pragma once

#include "protocol/bus/bus.hpp"

namespace pinjaw::socketcan {

/// What an error frame of the kernel says of the CAN controller (linux/can/error.h).
struct ErrorReport {
  bool bus_off = false;
  bool restarted = false;
  bool passive = false;
  bool recovering = false;  ///< the controller is error-active again, or only warns
  bool overrun = false;     ///< a frame found no room in the controller, coming or going
  bool unacknowledged = false;
  friend bool operator==(const ErrorReport&, const ErrorReport&) = default;
};

/// Precondition: an error frame.
ErrorReport read_error(const wire::Frame& frame);

/// The state of an interface's CAN controller, as far as its frames tell.
class ControllerWatch {
 public:
  /// `patient`: after bus-off it also waits for permit_restart().
  explicit ControllerWatch(bool patient = false) : patient_(patient) {}

  /// Takes every frame received, and counts what an error frame tells.
  void take(const bus::Received& received, bus::Statistics& statistics);

  /// Neither sends nor receives until it has been restarted: by the kernel where the interface has a
  /// `restart-ms`, else by a person.
  [[nodiscard]] bool off() const { return off_ || waits_; }
  void permit_restart() { waits_ = false; }
  /// Sends and receives, but no longer destroys frames it finds faulty.
  [[nodiscard]] bool passive() const { return passive_; }

 private:
  bool patient_;
  bool off_ = false;
  bool waits_ = false;  ///< for permit_restart()
  bool passive_ = false;
};

}  // namespace pinjaw::socketcan
