#pragma once

#include <cstdint>
#include <vector>

#include "protocol/bus/faults.hpp"
#include "protocol/wire/frame.hpp"

namespace pinjaw::bus {

/// What the faults made of one frame.
struct Fate {
  wire::Frame frame;  ///< with its flipped bits
  bool dropped = false;
  bool destroyed = false;     ///< by an error on the bus
  bool repeated = false;      ///< the bus carries it once more
  std::int64_t delay_us = 0;  ///< it is received so much later
};

/// Applies faults by a seeded generator: the same frames at the same times meet the same fate.
class FaultInjector {
 public:
  explicit FaultInjector(std::uint64_t seed) : state_(seed) {}
  void add(const Fault& fault) { faults_.push_back(fault); }
  Fate meet(const wire::Frame& frame, std::int64_t time_us);

 private:
  std::uint64_t bits();
  double uniform() { return static_cast<double>(bits() >> 11) * 0x1.0p-53; }
  void flip_bits(wire::Frame& frame);

  std::uint64_t state_;
  std::vector<Fault> faults_;
};

}  // namespace pinjaw::bus
