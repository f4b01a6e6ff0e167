#include "tests/fuzz/targets.hpp"

namespace pinjaw::fuzz {

const std::vector<Target>& targets() {
  static const std::vector<Target> all = [] {
    std::vector<Target> list = yaml_targets();
    for (auto more : {json_targets(), part_targets()}) list.insert(list.end(), more.begin(), more.end());
    return list;
  }();
  return all;
}

}  // namespace pinjaw::fuzz
