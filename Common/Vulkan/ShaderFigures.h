// What a driver tells of the shaders that it compiled: registers, memory for what does not fit into them, sizes.
#pragma once
#include <string>
#include <vector>

#include "Common/Vulkan/VulkanContext.h"

namespace rt::vulkan {

struct ShaderFigure {
    std::string shader; // as the driver calls it
    std::string name;   // of the figure, as the driver calls it
    double value = 0;
};

// For the creation of pipelines whose figures are to be known: a flag, or none where the context has no figures.
VkPipelineCreateFlags figureFlags(const VulkanContext& context);

// Of a pipeline that was made so; nothing where the context has no figures.
std::vector<ShaderFigure> shaderFigures(const VulkanContext& context, VkPipeline pipeline);

} // namespace rt::vulkan
