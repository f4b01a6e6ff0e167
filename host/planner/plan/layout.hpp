#pragma once

#include <string>

#include "host/base/expected.hpp"
#include "host/model/design.hpp"
#include "host/model/kit.hpp"
#include "protocol/wire/layout.hpp"

namespace pinjaw::planner {

/// What a layout is made of.
struct LayoutSource {
  const model::Kit& kit;
  const model::Design& design;
  std::string part_sha256;
  bool passive = false;  ///< a pallet: locates, squeezes nothing
};

/// The record a controller is sent of a design; required force rounded up, limit down.
/// Peers are added by whoever knows the cell. Fails where the record cannot say it: squeeze over 250 N,
/// separation over 204 mm, more than 16 pins.
base::Expected<wire::Layout> layout_of(const LayoutSource& source);

}  // namespace pinjaw::planner
