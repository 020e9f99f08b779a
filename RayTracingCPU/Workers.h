// Runs workers under a std::execution policy, or oneTBB where the standard library has no parallel policies.
#pragma once
#include <algorithm>
#include <cstdint>
#include <numeric>
#include <vector>

#if __has_include(<execution>)
#include <execution>
#endif
#if !defined(__cpp_lib_execution)
#include <tbb/parallel_for_each.h>
#endif

#include "Common/Core/Parallel.h"
#include "RayTracingCPU/CpuEngine.h"

namespace rt::cpu {

// Calls work(i) once for each i below count. The policies know no number of threads: at most `count` calls run at a
// time, so each call is a worker that pulls its share of the work itself. The first exception of a worker is thrown
// again when all are done.
template <class Work>
void runWorkers(Policy policy, std::uint32_t count, const Work& work) {
    if (policy == Policy::Seq || count == 1 || !canStartThreads()) {
        for (std::uint32_t i = 0; i < count; ++i) work(i);
        return;
    }
    FirstFailure failure;
    const auto guarded = [&](std::uint32_t i) { failure.guard([&] { work(i); }); };
#if defined(RT_THREADS_SANITIZED)
    onThreads(count, [&guarded](std::size_t i) { guarded(static_cast<std::uint32_t>(i)); });
#else
    std::vector<std::uint32_t> indices(count);
    std::iota(indices.begin(), indices.end(), 0u);
#if !defined(__cpp_lib_execution)
    tbb::parallel_for_each(indices.begin(), indices.end(), guarded);
#else
    if (policy == Policy::Par) {
        std::for_each(std::execution::par, indices.begin(), indices.end(), guarded);
    } else {
        std::for_each(std::execution::par_unseq, indices.begin(), indices.end(), guarded);
    }
#endif
#endif
    failure.rethrow();
}

} // namespace rt::cpu
