#pragma once

#include <cstdint>
#include <fstream>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "firmware_sim/core/core.hpp"

namespace pinjaw::core::test {

/// Writes what every controller of a test bench was given and what it made of it, so that an image on another
/// processor can be given the same (firmware_sim/target/trace.hpp). Off, and free, unless the environment
/// variable PINJAW_TRACE names a folder: there trace.in and trace.expected appear when the program ends.
class Recorder {
 public:
  /// Nothing where nobody wants a trace.
  static Recorder* wanted();

  void power_on(const Config& config, const NvmImage& image, const State& made);
  /// To be called with the state before the step ...
  void before(const State& state);
  /// ... and with all that it gave. A controller whose state was changed by other than its steps is not
  /// followed further; such steps are counted.
  void after(const Inputs& inputs, const Outputs& outputs, const State& state);

  explicit Recorder(std::string folder) : folder_(std::move(folder)) {}
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;
  ~Recorder();

 private:
  using Bytes = std::vector<std::uint8_t>;
  struct Lane {
    Bytes given;
    Bytes made;
  };
  using Key = std::pair<Bytes, std::uint32_t>;  ///< configuration and digest of the state it is in

  static Key key_of(const State& state);

  std::string folder_;
  std::vector<Lane> lanes_;
  std::map<Key, std::size_t> at_;  ///< the lane of a controller in that state
  std::size_t current_ = 0;        ///< lanes_.size(): none
  std::uint64_t steps_ = 0;
  std::uint64_t skipped_ = 0;
};

}  // namespace pinjaw::core::test
