#include "RayTracingCPU/PathKernel.h"

const rt::cpu::Kernel* rt::cpu::kernels_x86_64_v4() {
    return kKernels;
}
