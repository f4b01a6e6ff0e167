#pragma once

#include <string_view>

#include "host/base/diagnostics.hpp"

namespace pinjaw::base {

/// The mistakes of a JSON document with line and column, which a parsed document no longer has: of the value
/// at each mistake's key path, or of what should hold it where it is missing. Precondition: `text` is JSON.
Diagnostics placed_in_json(const Diagnostics& mistakes, std::string_view text);

}  // namespace pinjaw::base
