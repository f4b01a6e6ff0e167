#pragma once

#include <cstdint>
#include <string>

#include "protocol/wire/codes.hpp"
#include "protocol/wire/services.hpp"

namespace pinjaw::jaw_client {

enum class OutcomeKind : std::uint8_t {
  Pending,
  Done,
  Refused,       ///< the controller said no
  ForceRefused,  ///< it said no because a force would exceed a limit
  Fault,         ///< it began and fell into a fault state
  Silent,        ///< it did not answer, or did not come to the expected state in time
  BusFailed,
};

/// How an operation on one controller ended.
struct Outcome {
  OutcomeKind kind = OutcomeKind::Pending;
  std::string sentence;  ///< for a person; empty while pending and when done
  wire::CommandResult result = wire::CommandResult::Ok;
  wire::Reason reason = wire::Reason::None;
  wire::TransferStatus status = wire::TransferStatus::Ok;
  wire::FaultCode fault = wire::FaultCode::None;

  [[nodiscard]] bool pending() const { return kind == OutcomeKind::Pending; }
  [[nodiscard]] bool done() const { return kind == OutcomeKind::Done; }
};

}  // namespace pinjaw::jaw_client
