#pragma once

#include <string>
#include <string_view>

#include "host/base/expected.hpp"
#include "host/part/brep.hpp"

/// The way of a part's values from the process that asks OpenCASCADE to ours. Private to host/part.
namespace pinjaw::part {

std::string packed(const BrepValues& values);

/// What `packed` made, or a sentence where the bytes are something else, or values that contradict each
/// other: the process that made them may have been damaged itself.
base::Expected<BrepValues> unpacked(std::string_view bytes);

}  // namespace pinjaw::part
