#define PINJAW_KERNEL kBaselineKernel
#define PINJAW_KERNEL_NAME "baseline"
#include "host/planner/force/kernel_body.hpp"
