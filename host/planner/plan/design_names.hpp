#pragma once

#include <string_view>
#include <vector>

#include "host/model/design.hpp"

namespace pinjaw::planner {

/// Gives every design its id: by what it is, not by its rank, so that a plan made again calls it the same.
/// The id is the start of a SHA-256 over `kind`, its pins, what they touch and how the part lies; equal ones
/// are told apart.
void name_designs(std::vector<model::Design>& designs, std::string_view kind);

}  // namespace pinjaw::planner
