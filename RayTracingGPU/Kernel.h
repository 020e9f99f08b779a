// A shader compiled for one set of decisions, ready to run over any number of invocations.
#pragma once
#include <cstdint>
#include <string>

#include "Common/Shared/Base/Types.h"
#include "Common/Vulkan/VulkanResources.h"
#include "RayTracingGPU/EmbeddedShaders.h"

namespace rt::gpu {

// Specialisation constants, in the order of their ids in Bindings.glsl.
struct PipelineDecisions {
    std::uint32_t features = 0;
    std::uint32_t lightSampling = 0;
    std::uint32_t lightSelection = 0;
    std::uint32_t sphereLight = 0;
    std::uint32_t quadLight = 0;
    std::uint32_t triangleLight = 0;
    std::uint32_t samplerKind = 0;
    std::uint32_t russianRoulette = 0;
    bool operator==(const PipelineDecisions&) const = default;
};

inline PipelineDecisions makeDecisions(std::uint32_t features, const shared::RenderParams& params) {
    return {features,         params.lightSampling, params.lightSelection, params.sphereLight,
            params.quadLight, params.triangleLight, params.samplerKind,    params.russianRoulette};
}

class Kernel {
  public:
    virtual ~Kernel() = default;

    // Runs it with these push constants. There may be more invocations than asked for, all numbered from 0.
    template <class Launch>
    void launch(VkCommandBuffer commands, const Launch& launch, std::uint32_t invocations) const {
        static_assert(sizeof(Launch) <= 128, "Vulkan guarantees 128 bytes");
        record(commands, &launch, sizeof launch, invocations);
    }
    // What is part of it, for the statistics.
    virtual const std::string& name() const = 0;

  private:
    virtual void record(VkCommandBuffer commands, const void* launch, std::uint32_t bytes,
                        std::uint32_t invocations) const = 0;
};

} // namespace rt::gpu
