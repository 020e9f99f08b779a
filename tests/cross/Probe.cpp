#include "tests/cross/Probe.h"

#include <string>

#include "Common/Vulkan/Pipelines.h"
#include "Common/Vulkan/StagingRing.h"
#include "tests/cross/Device.h"

namespace rt::test {

std::vector<Words> answersOf(const Probe& probe) {
    struct Launch {
        VkDeviceAddress results;
        std::uint32_t count;
    };
    constexpr std::uint32_t kGroup = 64; // of the probes' shaders
    vulkan::VulkanContext& context = device();
    const VkPushConstantRange push{VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof(Launch)};
    const auto layout = vulkan::makePipelineLayout(context.device(), push, VK_NULL_HANDLE, "Loading the probe");

    std::vector<Words> results(std::size_t{probe.parts} * probe.count);
    const vulkan::Buffer buffer(context.memory(), results.size() * sizeof(Words), 0, vulkan::Memory::Device, "results");
    const Launch launch{buffer.address(), probe.count};
    for (const std::uint32_t family : probe.families) {
        const VkSpecializationMapEntry entry{0, 0, sizeof family};
        const VkSpecializationInfo constants{1, &entry, sizeof family, &family};
        const auto module = probe.isPruned ? vulkan::makeShaderModule(context.device(), probe.shader, constants)
                                           : vulkan::makeShaderModule(context.device(), probe.shader);
        const std::string what = "Compiling family " + std::to_string(family) + " of a probe";
        const auto pipeline = vulkan::makeComputePipeline(context.device(), VK_NULL_HANDLE, layout.get(), module.get(),
                                                          &constants, what.c_str());
        context.run([&](VkCommandBuffer commands) {
            vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline.get());
            vkCmdPushConstants(commands, layout.get(), VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof launch, &launch);
            vkCmdDispatch(commands, (probe.count + kGroup - 1) / kGroup, probe.parts, 1);
            vulkan::barrier(commands, vulkan::kComputeWrite, vulkan::kTransferRead);
        });
    }
    vulkan::download(context, buffer, std::as_writable_bytes(std::span(results)));
    return results;
}

} // namespace rt::test
