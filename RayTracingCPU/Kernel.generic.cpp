#include "RayTracingCPU/PathKernel.h"

const rt::cpu::Kernel* rt::cpu::kernels_generic() {
    return kKernels;
}
