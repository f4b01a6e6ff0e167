#include "protocol/socketcan/controller_watch.hpp"

#include <linux/can/error.h>

namespace pinjaw::socketcan {

ErrorReport read_error(const wire::Frame& frame) {
  // Details are valid only where the class is set; a frame may carry several classes.
  const std::uint8_t controller =
      (frame.id & CAN_ERR_CRTL) != 0 && frame.length > 1 ? frame.data[1] : std::uint8_t{0};
  const auto says = [controller](unsigned bits) { return (controller & bits) != 0; };
  return {.bus_off = (frame.id & CAN_ERR_BUSOFF) != 0,
          .restarted = (frame.id & CAN_ERR_RESTARTED) != 0,
          .passive = says(CAN_ERR_CRTL_RX_PASSIVE | CAN_ERR_CRTL_TX_PASSIVE),
          .recovering = says(CAN_ERR_CRTL_ACTIVE | CAN_ERR_CRTL_RX_WARNING | CAN_ERR_CRTL_TX_WARNING) &&
                        !says(CAN_ERR_CRTL_RX_PASSIVE | CAN_ERR_CRTL_TX_PASSIVE),
          .overrun = says(CAN_ERR_CRTL_RX_OVERFLOW | CAN_ERR_CRTL_TX_OVERFLOW),
          .unacknowledged = (frame.id & CAN_ERR_ACK) != 0};
}

void ControllerWatch::take(const bus::Received& received, bus::Statistics& statistics) {
  if (received.frame.kind != wire::FrameKind::Error) {
    // only a controller that is on receives; frames of this machine never passed it
    if (received.origin == bus::Origin::Elsewhere) off_ = false;
    return;
  }
  const ErrorReport error = read_error(received.frame);
  ++statistics.error_frames;
  statistics.overruns += error.overrun ? 1 : 0;
  statistics.unacknowledged += error.unacknowledged ? 1 : 0;
  statistics.restarts += error.restarted ? 1 : 0;
  statistics.passive += error.passive && !passive_ ? 1 : 0;
  statistics.bus_off += error.bus_off && !off_ ? 1 : 0;
  if (error.passive) passive_ = true;
  if (error.recovering || error.restarted) passive_ = off_ = false;
  if (error.bus_off) {
    waits_ = waits_ || (patient_ && !off_);
    off_ = true;
  }
}

}  // namespace pinjaw::socketcan
