#pragma once

#include <cstddef>
#include <optional>

#include "firmware_sim/core/io.hpp"
#include "firmware_sim/core/record.hpp"

namespace pinjaw::node {

/// A controller's permanent memory, byte by byte (core/record.hpp): a record is stored whole or not at all.
/// It survives power cuts; of a write under way when power goes, the bytes written so far stay.
class Nvm {
 public:
  [[nodiscard]] const core::NvmImage& image() const { return image_; }
  [[nodiscard]] core::NvmStatus status() const { return {.done = done_, .failed = broken_}; }

  /// Takes a request; it is stored kWrite_ms later. A request that comes while one is under way waits for it.
  void store(const core::NvmWrite& request);
  void advance_ms(unsigned elapsed_ms);
  /// A request under way stays half written, and the memory's report of what is done starts again.
  void cut_power();

  /// From now on nothing is stored (a fault).
  void fail() { broken_ = true; }

  static constexpr unsigned kWrite_ms = 2;  // chosen: FRAM; at most 724 bytes

 private:
  struct Write {
    core::MemoryUpdate update;
    std::uint16_t sequence = 0;
    std::size_t written = 0;
    unsigned elapsed_ms = 0;
  };
  void begin(const core::NvmWrite& request);
  /// Writes the bytes that are due.
  void write_on();

  core::Memory memory_;
  core::NvmImage image_;
  std::optional<Write> under_way_;
  std::optional<core::NvmWrite> next_;
  std::uint16_t done_ = 0;
  bool broken_ = false;
};

}  // namespace pinjaw::node
