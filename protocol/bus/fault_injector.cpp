#include "protocol/bus/fault_injector.hpp"

#include <algorithm>

namespace pinjaw::bus {

/// splitmix64 (Steele, Lea and Flood 2014).
std::uint64_t FaultInjector::bits() {
  std::uint64_t z = state_ += 0x9E3779B97F4A7C15U;
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9U;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBU;
  return z ^ (z >> 31);
}

void FaultInjector::flip_bits(wire::Frame& frame) {
  const std::uint64_t length = std::min<std::uint64_t>(frame.length, 8) * 8;
  if (length == 0) return;
  const std::uint64_t flips = 1 + bits() % 2;
  for (std::uint64_t i = 0; i < flips; ++i) {
    const std::uint64_t bit = bits() % length;
    frame.data[bit / 8] = static_cast<std::uint8_t>(frame.data[bit / 8] ^ (1U << bit % 8));
  }
}

Fate FaultInjector::meet(const wire::Frame& frame, std::int64_t time_us) {
  Fate fate{.frame = frame};
  for (const Fault& fault : faults_) {
    if (time_us < fault.from_us || time_us >= fault.to_us) continue;
    if ((frame.id & fault.mask) != (fault.id & fault.mask)) continue;
    if (uniform() >= fault.share) continue;
    switch (fault.kind) {
      case FaultKind::Drop:
        fate.dropped = true;
        break;
      case FaultKind::Duplicate:
        fate.repeated = true;
        break;
      case FaultKind::Corrupt:
        flip_bits(fate.frame);
        break;
      case FaultKind::Delay:
        fate.delay_us += static_cast<std::int64_t>(uniform() * static_cast<double>(fault.delay_us));
        break;
      case FaultKind::Destroy:
        fate.destroyed = true;
        break;
    }
  }
  return fate;
}

}  // namespace pinjaw::bus
