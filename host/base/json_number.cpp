#include "host/base/json_number.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <stdexcept>

namespace pinjaw::base {

std::string json_number(double value) {
  if (!std::isfinite(value)) throw std::logic_error("JSON has no number that is not finite");
  if (value == 0) return "0";
  std::array<char, 32> digits{};
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
  return {digits.data(), end};
}

std::string json_number(double value, int decimals) {
  return json_number(rounded(value, decimals));
}

double rounded(double value, int decimals) {
  constexpr double kExact = 9007199254740992.0;  // 2^53: above it a double has no decimals to round
  const double scale = std::pow(10.0, decimals);
  const double scaled = value * scale;
  if (!(std::abs(scaled) < kExact)) return value;
  const double whole = std::round(scaled);
  return whole == 0 ? 0.0 : whole / scale;
}

}  // namespace pinjaw::base
