#include "protocol/describe/physical.hpp"

namespace pinjaw::describe {

std::string physical(std::uint64_t raw, wire::Ratio factor) {
  const std::uint64_t product = raw * factor.numerator;
  std::string text = std::to_string(product / factor.denominator);
  std::uint64_t rest = product % factor.denominator;
  if (rest == 0) return text;
  text += '.';
  for (int digits = 0; rest != 0 && digits < 9; ++digits) {
    rest *= 10;
    text += static_cast<char>('0' + rest / factor.denominator);
    rest %= factor.denominator;
  }
  return text;
}

const char* direction_text(wire::Direction direction) {
  switch (direction) {
    case wire::Direction::AnyToAll:
      return "anyone to all";
    case wire::Direction::NodeToAll:
      return "node to all";
    case wire::Direction::HostToAll:
      return "host to all";
    case wire::Direction::HostToNode:
      return "host to node";
    case wire::Direction::NodeToHost:
      return "node to host";
  }
  return "";
}

}  // namespace pinjaw::describe
