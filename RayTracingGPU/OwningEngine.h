// An engine and the device that it alone uses.
#pragma once
#include "Common/Render/ForwardingEngine.h"
#include "Common/Vulkan/VulkanContext.h"
#include "RayTracingGPU/GpuEngine.h"

namespace rt::gpu {

class OwningEngine final : public app::ForwardingEngine {
  public:
    // Throws what opening the device and makeGpuEngine() throw.
    OwningEngine(const vulkan::ContextOptions& context, const GpuEngineOptions& options) : context_(context) {
        engine_ = makeGpuEngine(context_, options);
    }
    ~OwningEngine() override { engine_ = nullptr; } // before its device

  private:
    vulkan::VulkanContext context_;
};

} // namespace rt::gpu
