#define PINJAW_KERNEL kAvx2Kernel
#define PINJAW_KERNEL_NAME "avx2"
#include "host/planner/force/kernel_body.hpp"
