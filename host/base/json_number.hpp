#pragma once

#include <string>

namespace pinjaw::base {

/// The shortest decimal that reads back as the same double, always valid JSON: no NaN or infinity (a bug to
/// ask for one: it stops), no bare dot, -0 as 0. The same bytes on every machine and locale.
std::string json_number(double value);

/// `value` rounded to `decimals` places (0..15), trailing zeros dropped.
std::string json_number(double value, int decimals);

/// `value` rounded to `decimals` places as a double, for JSON libraries; -0 becomes 0.
double rounded(double value, int decimals);

}  // namespace pinjaw::base
