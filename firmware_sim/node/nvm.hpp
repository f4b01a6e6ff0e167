#pragma once

#include <optional>

#include "firmware_sim/core/io.hpp"

namespace pinjaw::node {

/// A controller's permanent memory: two slots written by turns, so that a record is stored whole or not at
/// all. It survives power cuts; a write under way when power goes is lost.
class Nvm {
 public:
  [[nodiscard]] const core::NvmImage& image() const { return image_; }
  [[nodiscard]] core::NvmStatus status() const { return {.done = done_, .failed = broken_}; }

  /// Takes a request; it is stored kWrite_ms later. A request that comes while one is under way waits for it.
  void store(const core::NvmWrite& request);
  void advance_ms(unsigned elapsed_ms);
  /// What was not stored yet is lost, and the memory's report of what is done starts again.
  void cut_power();

  /// From now on nothing is stored (a fault).
  void fail() { broken_ = true; }

  static constexpr unsigned kWrite_ms = 2;  // chosen: FRAM or a page of data flash, 64 B with check

 private:
  void commit(const core::NvmWrite& request);

  core::NvmImage image_;
  std::optional<core::NvmWrite> under_way_;
  std::optional<core::NvmWrite> next_;
  unsigned left_ms_ = 0;
  std::uint16_t done_ = 0;
  bool broken_ = false;
};

}  // namespace pinjaw::node
