#include "Common/Vulkan/ShaderFigures.h"

#include "Common/Core/Printable.h"
#include "Common/Vulkan/Check.h"

namespace rt::vulkan {
namespace {

constexpr const char* kReading = "Reading a pipeline's statistics";

double valueOf(const VkPipelineExecutableStatisticKHR& statistic) {
    switch (statistic.format) {
        case VK_PIPELINE_EXECUTABLE_STATISTIC_FORMAT_BOOL32_KHR:
            return statistic.value.b32 == VK_FALSE ? 0 : 1;
        case VK_PIPELINE_EXECUTABLE_STATISTIC_FORMAT_INT64_KHR:
            return static_cast<double>(statistic.value.i64);
        case VK_PIPELINE_EXECUTABLE_STATISTIC_FORMAT_UINT64_KHR:
            return static_cast<double>(statistic.value.u64);
        case VK_PIPELINE_EXECUTABLE_STATISTIC_FORMAT_FLOAT64_KHR:
            return statistic.value.f64;
        default:
            return 0;
    }
}

// Vulkan's way to ask for a list: how many, then all.
template <class Record, class Function, class Request>
std::vector<Record> list(VkDevice device, const char* function, const Request& request, VkStructureType type) {
    const auto ask = reinterpret_cast<Function>(vkGetDeviceProcAddr(device, function));
    if (ask == nullptr) return {};
    std::uint32_t count = 0;
    check(ask(device, &request, &count, nullptr), kReading);
    std::vector<Record> records(count);
    for (Record& record : records) record.sType = type;
    check(ask(device, &request, &count, records.data()), kReading);
    return records;
}

} // namespace

VkPipelineCreateFlags figureFlags(const VulkanContext& context) {
    return context.hasShaderFigures() ? VK_PIPELINE_CREATE_CAPTURE_STATISTICS_BIT_KHR : 0;
}

std::vector<ShaderFigure> shaderFigures(const VulkanContext& context, VkPipeline pipeline) {
    std::vector<ShaderFigure> figures;
    if (!context.hasShaderFigures()) return figures;
    const VkPipelineInfoKHR info{VK_STRUCTURE_TYPE_PIPELINE_INFO_KHR, nullptr, pipeline};
    const auto executables = list<VkPipelineExecutablePropertiesKHR, PFN_vkGetPipelineExecutablePropertiesKHR>(
        context.device(), "vkGetPipelineExecutablePropertiesKHR", info,
        VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_PROPERTIES_KHR);
    for (std::uint32_t i = 0; i < executables.size(); ++i) {
        const VkPipelineExecutableInfoKHR executable{VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_INFO_KHR, nullptr, pipeline,
                                                     i};
        const auto statistics = list<VkPipelineExecutableStatisticKHR, PFN_vkGetPipelineExecutableStatisticsKHR>(
            context.device(), "vkGetPipelineExecutableStatisticsKHR", executable,
            VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_STATISTIC_KHR);
        std::string shader = printable(executables[i].name);
        if (executables[i].subgroupSize != 0)
            figures.push_back({shader, "Subgroup Size", static_cast<double>(executables[i].subgroupSize)});
        for (const VkPipelineExecutableStatisticKHR& statistic : statistics)
            figures.push_back({shader, printable(statistic.name), valueOf(statistic)});
    }
    return figures;
}

} // namespace rt::vulkan
