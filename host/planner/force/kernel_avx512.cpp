#define PINJAW_KERNEL kAvx512Kernel
#define PINJAW_KERNEL_NAME "avx512"
#include "host/planner/force/kernel_body.hpp"
