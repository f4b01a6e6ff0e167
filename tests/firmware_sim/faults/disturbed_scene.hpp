#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "tests/firmware_sim/faults/moments.hpp"

/// Scenes with one fault of communication on one message.
namespace pinjaw::core::test {

/// AUTOSAR FO, E2E protocol specification: faults of communication.
enum class Fault : std::uint8_t {
  Repetition,
  Loss,
  Delay,
  Insertion,
  Masquerade,
  Addressing,
  Sequence,
  Corruption,
  Asymmetric,  ///< this receiver alone gets other content
  Subset,      ///< this receiver alone gets nothing any more
  Blocked,     ///< nobody gets the message any more, whoever sends it
};
constexpr std::array kFaults = {Fault::Repetition, Fault::Loss,       Fault::Delay,    Fault::Insertion,
                                Fault::Masquerade, Fault::Addressing, Fault::Sequence, Fault::Corruption,
                                Fault::Asymmetric, Fault::Subset,     Fault::Blocked};

constexpr bool is_silence_fault(Fault fault) {
  return fault == Fault::Subset || fault == Fault::Blocked;
}

constexpr int kLate_ms = 45;  ///< of Fault::Delay

/// When something is inserted, as long as the scene's state lasts.
int strike_ms(const Scene& scene);

/// When what is in Scene::besides is said for the first, second and third time: 5 ms apart, as GLOBAL_HOLD.
std::array<int, 3> said_ms(const Scene& scene);

/// One cell of the matrix.
class DisturbedScene {
 public:
  /// With `said`, what Scene::besides has of the message is said, so that the fault has it to strike.
  DisturbedScene(const Scene& scene, wire::MessageType message, Fault fault, bool said);

  [[nodiscard]] std::string name() const;
  std::vector<Moment> run();

  /// Frames that the fault took, changed, held up or added.
  [[nodiscard]] int hits() const { return hits_; }
  /// When the last frame of a silence fault came; nothing where none came.
  [[nodiscard]] std::optional<int> last_heard_ms() const { return last_heard_ms_; }

 private:
  [[nodiscard]] wire::Frame latest() const;
  [[nodiscard]] wire::Frame oldest() const;
  [[nodiscard]] wire::Frame foreign() const;
  [[nodiscard]] wire::Frame foreign_content() const;
  [[nodiscard]] wire::Frame out_of_sequence() const;
  [[nodiscard]] wire::Frame of_another() const;
  [[nodiscard]] wire::Frame changed(wire::Frame frame, bool much) const;
  void disturb(int at, std::vector<wire::Frame>& frames);
  void insert(std::vector<wire::Frame>& frames, const wire::Frame& frame);
  void lose(std::vector<wire::Frame>& frames);
  void delay(int at, std::vector<wire::Frame>& frames);
  void change(bool now, std::vector<wire::Frame>& frames, bool much);
  void silence(int at, std::vector<wire::Frame>& frames);

  const Scene& scene_;
  wire::MessageType message_;
  Fault fault_;
  std::vector<wire::Frame> said_;  ///< besides what is heard
  std::uint32_t id_;
  wire::Frame latest_;
  int hits_ = 0;
  std::optional<wire::Frame> delayed_;
  int due_ms_ = 0;
  std::optional<int> last_heard_ms_;
};

}  // namespace pinjaw::core::test
