#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

namespace pinjaw::bench {

/// CPU time of this process so far, all its threads, in seconds.
double cpu_s();

/// One of several that do the same work.
struct Contestant {
  std::string name;
  std::function<void()> run;
};

/// Median CPU time of each contestant in seconds. They take turns, `repeats` times, so that a drift of the
/// machine's speed meets all alike.
std::vector<double> median_cpu_s(std::span<const Contestant> contestants, int repeats = 5);

double median(std::vector<double> values);

/// Exponent b and factor a of y = a x^b, by least squares of the logarithms. At least two points, all above
/// 0.
struct PowerLaw {
  double factor = 0;
  double exponent = 0;
};
PowerLaw fitted_power_law(std::span<const double> x, std::span<const double> y);

}  // namespace pinjaw::bench
