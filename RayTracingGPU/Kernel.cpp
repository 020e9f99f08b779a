#include "RayTracingGPU/Kernel.h"

#include <span>

#include "Common/Vulkan/Check.h"

namespace rt::gpu {

vulkan::Handle<VkShaderModule> makeShaderModule(VkDevice device, Shader shader) {
    const std::span<const std::uint32_t> code = shaderCode(shader);
    VkShaderModuleCreateInfo info{VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO};
    info.codeSize = code.size_bytes();
    info.pCode = code.data();
    VkShaderModule module = VK_NULL_HANDLE;
    vulkan::check(vkCreateShaderModule(device, &info, nullptr, &module), "Loading a shader");
    return {device, module, vkDestroyShaderModule};
}

} // namespace rt::gpu
