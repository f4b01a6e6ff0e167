#include "firmware_sim/plant/noise.hpp"

namespace pinjaw::plant {

std::uint64_t Noise::bits() {
  state += 0x9E3779B97F4A7C15U;
  std::uint64_t mixed = state;
  mixed = (mixed ^ (mixed >> 30U)) * 0xBF58476D1CE4E5B9U;
  mixed = (mixed ^ (mixed >> 27U)) * 0x94D049BB133111EBU;
  return mixed ^ (mixed >> 31U);
}

double Noise::symmetric() {
  return static_cast<double>(bits() >> 11U) * 0x1p-52 - 1.0;
}

double Noise::normal() {
  // Six draws of two 32-bit uniforms: no library function, whose last digit differs between machines.
  std::uint64_t sum = 0;
  for (int i = 0; i < 6; ++i) {
    const std::uint64_t draw = bits();
    sum += (draw >> 32U) + (draw & 0xFFFFFFFFU);
  }
  return static_cast<double>(sum) * 0x1p-32 - 6.0;
}

}  // namespace pinjaw::plant
