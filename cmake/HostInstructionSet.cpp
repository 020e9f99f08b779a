// Prints the best instruction set of this processor, for RT_KERNELS=host (BuildOptions.cmake).
#include <cstdio>

#include "Common/Core/CpuFeatures.h"

int main() {
    std::fputs(rt::name(rt::bestInstructionSet()), stdout);
}
