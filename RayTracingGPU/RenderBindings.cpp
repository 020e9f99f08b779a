#include "RayTracingGPU/RenderBindings.h"

#include <array>

#include "RayTracingGPU/EngineChoice.h"

namespace rt::gpu {
namespace {

// As in the shaders.
constexpr std::uint32_t kTopLevel = 0;
constexpr std::uint32_t kConstants = 1;
constexpr std::uint32_t kLinearLists = 2;

constexpr VkShaderStageFlags kComputeStage = VK_SHADER_STAGE_COMPUTE_BIT;
constexpr VkShaderStageFlags kRayGenerationStage = VK_SHADER_STAGE_RAYGEN_BIT_KHR;
constexpr VkShaderStageFlags kPipelineStages = VK_SHADER_STAGE_RAYGEN_BIT_KHR | VK_SHADER_STAGE_CLOSEST_HIT_BIT_KHR |
                                               VK_SHADER_STAGE_MISS_BIT_KHR | VK_SHADER_STAGE_INTERSECTION_BIT_KHR;

} // namespace

RenderBindings::RenderBindings(vulkan::VulkanContext& context, app::GpuEngineKind engine, std::uint32_t pushBytes) {
    const bool isPipeline = engine == app::GpuEngineKind::Pipeline;
    const bool hasLists = !usesAccelStructure(engine);
    bindPoint_ = isPipeline ? VK_PIPELINE_BIND_POINT_RAY_TRACING_KHR : VK_PIPELINE_BIND_POINT_COMPUTE;
    pushStages_ = isPipeline ? kRayGenerationStage : kComputeStage;
    const VkShaderStageFlags stages = isPipeline ? kPipelineStages : kComputeStage;
    const VkDescriptorType traced =
        hasLists ? VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER : VK_DESCRIPTOR_TYPE_ACCELERATION_STRUCTURE_KHR;
    const std::array<VkDescriptorSetLayoutBinding, 2> bindings{{
        {kConstants, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, 1, stages, nullptr},
        {hasLists ? kLinearLists : kTopLevel, traced, 1, pushStages_, nullptr},
    }};
    set_ = vulkan::DescriptorSet(context.device(), bindings, "Creating bindings");
    layout_ =
        vulkan::makePipelineLayout(context.device(), {pushStages_, 0, pushBytes}, set_.layout(), "Creating bindings");
}

void RenderBindings::update(const vulkan::Buffer& constants, VkAccelerationStructureKHR topLevel) const {
    set_.write(kConstants, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, constants.get());
    set_.write(kTopLevel, topLevel);
}

void RenderBindings::update(const vulkan::Buffer& constants, const vulkan::Buffer& linearLists) const {
    set_.write(kConstants, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, constants.get());
    set_.write(kLinearLists, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, linearLists.get());
}

void RenderBindings::bind(VkCommandBuffer commands, const void* push, std::uint32_t pushBytes) const {
    vkCmdBindDescriptorSets(commands, bindPoint_, layout(), 0, 1, &set_.get(), 0, nullptr);
    vkCmdPushConstants(commands, layout(), pushStages_, 0, pushBytes, push);
}

} // namespace rt::gpu
