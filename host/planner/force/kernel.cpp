#include "host/planner/force/kernel.hpp"

namespace pinjaw::planner::kernel {

void forget(Memory& memory) {
  memory.vertices = 0;
  memory.answers = 0;
  for (std::int16_t& place : memory.place) place = -1;
}

const Kernel* const* kernels(int& count) {
#if defined(__x86_64__)
  static const Kernel* const all[] = {&kBaselineKernel, &kAvx2Kernel, &kAvx512Kernel};
  count = 1;
  if (__builtin_cpu_supports("avx2") != 0) count = 2;
  if (count == 2 && __builtin_cpu_supports("avx512f") != 0) count = 3;
#else
  static const Kernel* const all[] = {&kBaselineKernel};
  count = 1;
#endif
  return all;
}

const Kernel& best_kernel() {
  int count = 0;
  const Kernel* const* all = kernels(count);
  return *all[count - 1];
}

}  // namespace pinjaw::planner::kernel
