#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "host/jaw_client/outcome.hpp"
#include "protocol/wire/layout.hpp"
#include "protocol/wire/transfer.hpp"

namespace pinjaw::jaw_client {

/// Brings a layout to one controller: WRITE, COMMIT, and READBACK to see that it has exactly what was meant.
/// A request whose answer does not come is made again, which does no harm.
class LayoutTransfer {
 public:
  static constexpr std::uint16_t kAnswer_ms = 1000;
  static constexpr int kTries = 3;

  void begin(const wire::Layout& layout);
  void take(const wire::Payload& segment);
  /// Lets time pass; gives the segments to send, in order.
  std::vector<wire::Payload> advance(std::uint16_t elapsed_ms);
  [[nodiscard]] const Outcome& outcome() const { return outcome_; }

 private:
  void request(wire::Service service);
  void ask();
  void answered(std::span<const std::uint8_t> response);
  void content(std::span<const std::uint8_t> body);
  void refuse(wire::TransferStatus status);
  void try_again();

  wire::EncodedLayout layout_;
  std::uint32_t crc_ = 0;
  wire::Service service_ = wire::Service::Write;
  std::uint8_t transaction_ = 0;
  int tries_ = 0;
  wire::Countdown patience_;
  wire::TransferSender sender_;
  wire::TransferReceiver receiver_;
  std::vector<wire::Payload> flow_;
  Outcome outcome_{.kind = OutcomeKind::Done, .sentence = {}};
};

}  // namespace pinjaw::jaw_client
