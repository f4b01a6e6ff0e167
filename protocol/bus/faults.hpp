#pragma once

#include <cstdint>
#include <limits>

namespace pinjaw::bus {

enum class FaultKind : std::uint8_t {
  Drop,       ///< nobody gets the frame
  Duplicate,  ///< everybody gets it twice
  Corrupt,    ///< one or two of its payload bits flip
  Delay,      ///< it comes later, so that others overtake it
  Destroy,    ///< an error on the bus: everyone notices, its sender tries again, error counters rise
};

/// A disturbance of frames between two times: each matching frame is hit with a probability.
struct Fault {
  FaultKind kind = FaultKind::Drop;
  std::int64_t from_us = 0;
  std::int64_t to_us = std::numeric_limits<std::int64_t>::max();
  double share = 1.0;    ///< probability, 0 to 1
  std::uint32_t id = 0;  ///< frames with (frame id & mask) == (id & mask); mask 0: all
  std::uint32_t mask = 0;
  std::int64_t delay_us = 0;  ///< with Delay: at most so much later
};

}  // namespace pinjaw::bus
