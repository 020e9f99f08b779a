// A shader compiled for one set of specialization constants, ready to run over any number of invocations.
#pragma once
#include <cstdint>
#include <string>

#include "Common/Vulkan/Barrier.h"
#include "RayTracingGPU/EmbeddedShaders.h"

namespace rt::gpu {

class Kernel {
  public:
    virtual ~Kernel() = default;

    // Runs it with these push constants. There may be more invocations than asked for, all numbered from 0.
    template <class Launch>
    void launch(VkCommandBuffer commands, const Launch& launch, std::uint32_t invocations) const {
        static_assert(sizeof(Launch) <= 128, "Vulkan guarantees 128 bytes");
        record(commands, &launch, sizeof launch, invocations);
    }
    // What its invocations do with buffers, and in which stage.
    virtual vulkan::Access access() const = 0;
    // What is part of it, for the statistics.
    virtual const std::string& name() const = 0;
    virtual VkPipeline pipeline() const = 0;

  private:
    virtual void record(VkCommandBuffer commands, const void* launch, std::uint32_t bytes,
                        std::uint32_t invocations) const = 0;
};

} // namespace rt::gpu
