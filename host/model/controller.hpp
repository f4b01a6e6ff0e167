#pragma once

#include <string>

#include "host/model/kit.hpp"

namespace pinjaw::model {

/// A simulated jaw controller: its address, its kit and what its hardware can do.
struct Controller {
  std::string name;
  int node = 0;  ///< 1..14
  Kit kit;
  bool passive = false;  ///< a pallet or fixture: seat switches and custody, no squeeze
  double max_squeeze_n = 0;
  double force_uncertainty_n = 0;
};

}  // namespace pinjaw::model
