#include "Python/Engines.h"

#include <algorithm>
#include <exception>
#include <vector>

#include "Common/Core/Error.h"
#include "RayTracingCPU/CpuEngine.h"
#ifdef RT_HAS_GPU
#include "RayTracingGPU/EngineChoice.h"
#include "RayTracingGPU/OwningEngine.h"
#endif

namespace rt::python {
namespace {

cpu::Policy policyOf(app::Policy policy) {
    switch (policy) {
        case app::Policy::Seq:
            return cpu::Policy::Seq;
        case app::Policy::ParUnseq:
            return cpu::Policy::ParUnseq;
        case app::Policy::Par:
            break;
    }
    return cpu::Policy::Par;
}

std::unique_ptr<app::Engine> makeCpu(const app::Options& options) {
    cpu::CpuEngineOptions engine;
    engine.policy = policyOf(options.policy);
    engine.threads = options.threads;
    return cpu::makeCpuEngine(engine);
}

} // namespace

#ifdef RT_HAS_GPU

std::unique_ptr<app::Engine> makeEngine(const app::Options& options) {
    if (options.program != app::kGpuProgram) return makeCpu(options);
    const vulkan::ContextOptions context{options.device, options.validation, gpu::neededBy(options.gpuEngine)};
    return std::make_unique<gpu::OwningEngine>(
        context, gpu::GpuEngineOptions{.engine = options.gpuEngine, .passSeconds = gpu::kUnwatchedPassSeconds});
}

bool hasGpuEngine() {
    return true;
}

bool hasHardwareDevice() {
    try {
        const vulkan::Instance instance(false);
        const std::vector<vulkan::DeviceInfo> devices = vulkan::findDevices(instance);
        return std::any_of(devices.begin(), devices.end(),
                           [](const vulkan::DeviceInfo& device) { return device.suitable() && !device.isSoftware(); });
    } catch (const std::exception&) { // no loader, or no driver
        return false;
    }
}

std::string describeDevices() {
    const vulkan::Instance instance(false);
    return vulkan::describeDevices(vulkan::findDevices(instance));
}

#else

namespace {

constexpr const char* kNoGpu = "engine gpu: this module was built without the GPU engine";

} // namespace

std::unique_ptr<app::Engine> makeEngine(const app::Options& options) {
    if (options.program == app::kGpuProgram) throw UsageError(kNoGpu);
    return makeCpu(options);
}

bool hasGpuEngine() {
    return false;
}

bool hasHardwareDevice() {
    return false;
}

std::string describeDevices() {
    throw UsageError(kNoGpu);
}

#endif

} // namespace rt::python
