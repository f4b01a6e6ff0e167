#include "tests/fuzz/targets.hpp"

namespace pinjaw::fuzz {

const std::vector<Target>& targets() {
  static const std::vector<Target> all = bus_targets();
  return all;
}

}  // namespace pinjaw::fuzz
