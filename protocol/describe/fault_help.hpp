#pragma once

#include <optional>
#include <span>
#include <string_view>

#include "protocol/wire/codes.hpp"

namespace pinjaw::describe {

/// What an operator needs to know of a fault code.
struct FaultHelp {
  wire::FaultCode code = wire::FaultCode::None;
  const char* meaning = "";
  const char* cause = "";
  const char* remedy = "";
  bool simulated = true;  ///< else for other controllers: the simulated one does not report it
};

/// One entry for each fault code but None, ascending.
std::span<const FaultHelp> fault_helps();

/// By name in any case (`OVER_FORCE`), or by number: `0x7020`, `7020` (hexadecimal).
std::optional<FaultHelp> find_fault(std::string_view name_or_number);

}  // namespace pinjaw::describe
