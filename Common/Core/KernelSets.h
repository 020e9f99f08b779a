// Which instruction sets a library has kernels for: its sources named X.<instruction set>.cpp, of those that the build
// was asked for.
#pragma once

#include "Common/Core/CpuFeatures.h"

// RT_KERNEL_SETS(ROW): a ROW(enumerator of InstructionSet, suffix of the kernels' names) for each, the best one first.
#ifdef RT_KERNELS_x86_64_v4
#define RT_KERNEL_SET_4(ROW) ROW(X86_64_v4, x86_64_v4)
#else
#define RT_KERNEL_SET_4(ROW)
#endif
#ifdef RT_KERNELS_x86_64_v3
#define RT_KERNEL_SET_3(ROW) ROW(X86_64_v3, x86_64_v3)
#else
#define RT_KERNEL_SET_3(ROW)
#endif
#ifdef RT_KERNELS_x86_64_v2
#define RT_KERNEL_SET_2(ROW) ROW(X86_64_v2, x86_64_v2)
#else
#define RT_KERNEL_SET_2(ROW)
#endif
#ifdef RT_KERNELS_generic
#define RT_KERNEL_SET_0(ROW) ROW(Generic, generic)
#else
#define RT_KERNEL_SET_0(ROW)
#endif
#define RT_KERNEL_SETS(ROW) RT_KERNEL_SET_4(ROW) RT_KERNEL_SET_3(ROW) RT_KERNEL_SET_2(ROW) RT_KERNEL_SET_0(ROW)
