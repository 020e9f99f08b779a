#include "tests/cross/SharedPipelines.h"

#include <cstddef>
#include <functional>
#include <list>
#include <map>
#include <mutex>
#include <span>
#include <string>
#include <string_view>
#include <utility>

namespace rt::test {
namespace {

// What shaders of a render have at least, in bytes. Smaller ones are compiled in no time.
constexpr std::size_t kLarge = std::size_t{1} << 16;
// Pipelines that nobody uses any more, at most.
constexpr std::size_t kIdle = 6;

template <class Function>
Function ofDevice(VkDevice device, const char* name) {
    return reinterpret_cast<Function>(vkGetDeviceProcAddr(device, name));
}

// The bytes of a plain value at the end of a key.
template <class T>
void append(std::string& key, const T& value) {
    key.append(reinterpret_cast<const char*>(&value), sizeof value);
}

class SharedPipelines {
  public:
    static SharedPipelines& instance() {
        static SharedPipelines pipelines;
        return pipelines;
    }

    void addModule(VkShaderModule module, const VkShaderModuleCreateInfo& info) {
        const std::string_view code(reinterpret_cast<const char*>(info.pCode), info.codeSize);
        const std::lock_guard lock(mutex_);
        modules_[module] = {std::hash<std::string_view>()(code), info.codeSize};
    }

    // Everything that the driver compiles a stage from; whether that takes long.
    bool describe(const VkPipelineShaderStageCreateInfo& stage, std::string& key) {
        const std::lock_guard lock(mutex_);
        const Module& module = modules_[stage.module];
        append(key, module.hash);
        append(key, module.bytes);
        append(key, stage.stage);
        if (const VkSpecializationInfo* constants = stage.pSpecializationInfo) {
            key.append(static_cast<const char*>(constants->pData), constants->dataSize);
        }
        return module.bytes >= kLarge;
    }

    template <class Make>
    VkResult make(const std::string& key, VkPipeline& pipeline, const Make& compile) {
        const std::lock_guard lock(mutex_);
        for (auto one = made_.begin(); one != made_.end(); ++one) {
            if (one->key != key) continue;
            ++one->users;
            pipeline = one->pipeline;
            made_.splice(made_.end(), made_, one);
            return VK_SUCCESS;
        }
        const VkResult result = compile();
        if (result == VK_SUCCESS) made_.push_back({key, pipeline, 1});
        return result;
    }

    void destroy(VkDevice device, VkPipeline pipeline) {
        const std::lock_guard lock(mutex_);
        std::size_t idle = 0;
        bool isShared = false;
        for (Made& one : made_) {
            if (device == device_ && one.pipeline == pipeline) {
                --one.users;
                isShared = true;
            }
            idle += one.users == 0;
        }
        if (!isShared) driverDestroys(device, pipeline);
        for (auto one = made_.begin(); idle > kIdle; --idle) { // the one that was used longest ago
            while (one->users != 0) ++one;
            driverDestroys(device_, one->pipeline);
            one = made_.erase(one);
        }
    }

    void begin(VkDevice device) {
        const std::lock_guard lock(mutex_);
        device_ = device;
    }
    bool serves(VkDevice device) {
        const std::lock_guard lock(mutex_);
        return device_ == device;
    }
    void end() {
        const std::lock_guard lock(mutex_);
        for (const Made& one : made_) driverDestroys(device_, one.pipeline);
        made_.clear();
        device_ = VK_NULL_HANDLE;
    }

  private:
    struct Module {
        std::size_t hash = 0;
        std::size_t bytes = 0;
    };
    struct Made {
        std::string key;
        VkPipeline pipeline;
        std::size_t users;
    };

    static void driverDestroys(VkDevice device, VkPipeline pipeline) {
        ofDevice<PFN_vkDestroyPipeline>(device, "vkDestroyPipeline")(device, pipeline, nullptr);
    }

    std::mutex mutex_;
    std::map<VkShaderModule, Module> modules_;
    VkDevice device_ = VK_NULL_HANDLE;
    std::list<Made> made_; // used last at the end
};

PFN_vkCreateRayTracingPipelinesKHR driverCreatesRayTracing = nullptr;

VKAPI_ATTR VkResult VKAPI_CALL createRayTracing(VkDevice device, VkDeferredOperationKHR operation,
                                                VkPipelineCache cache, std::uint32_t count,
                                                const VkRayTracingPipelineCreateInfoKHR* infos,
                                                const VkAllocationCallbacks* allocator, VkPipeline* pipelines) {
    SharedPipelines& shared = SharedPipelines::instance();
    const auto compile = [&] {
        return driverCreatesRayTracing(device, operation, cache, count, infos, allocator, pipelines);
    };
    std::string key = "ray tracing";
    append(key, infos->flags);
    append(key, infos->maxPipelineRayRecursionDepth);
    bool isLarge = false;
    for (const auto& stage : std::span(infos->pStages, infos->stageCount)) {
        if (shared.describe(stage, key)) isLarge = true;
    }
    for (const auto& group : std::span(infos->pGroups, infos->groupCount)) {
        for (const std::uint32_t shader :
             {group.generalShader, group.closestHitShader, group.anyHitShader, group.intersectionShader}) {
            append(key, shader);
        }
        append(key, group.type);
    }
    return isLarge && count == 1 && shared.serves(device) ? shared.make(key, *pipelines, compile) : compile();
}

} // namespace

SharingContext::SharingContext(const vulkan::ContextOptions& options) : VulkanContext(options) {
    SharedPipelines::instance().begin(device());
    // The context itself is no constant: what it loaded may be replaced.
    auto& functions = const_cast<vulkan::RayTracingFunctions&>(rayTracing());
    if (functions.createPipelines == nullptr) return;
    driverCreatesRayTracing = std::exchange(functions.createPipelines, &createRayTracing);
}

SharingContext::~SharingContext() {
    SharedPipelines::instance().end();
}

} // namespace rt::test

// Stand in for the loader's functions of these names in all that is linked into the program.
using rt::test::ofDevice;
using rt::test::SharedPipelines;

VKAPI_ATTR VkResult VKAPI_CALL vkCreateShaderModule(VkDevice device, const VkShaderModuleCreateInfo* info,
                                                    const VkAllocationCallbacks* allocator, VkShaderModule* module) {
    const auto create = ofDevice<PFN_vkCreateShaderModule>(device, "vkCreateShaderModule");
    const VkResult result = create(device, info, allocator, module);
    if (result == VK_SUCCESS) SharedPipelines::instance().addModule(*module, *info);
    return result;
}

VKAPI_ATTR VkResult VKAPI_CALL vkCreateComputePipelines(VkDevice device, VkPipelineCache cache, std::uint32_t count,
                                                        const VkComputePipelineCreateInfo* infos,
                                                        const VkAllocationCallbacks* allocator, VkPipeline* pipelines) {
    const auto compile = [&] {
        const auto create = ofDevice<PFN_vkCreateComputePipelines>(device, "vkCreateComputePipelines");
        return create(device, cache, count, infos, allocator, pipelines);
    };
    SharedPipelines& shared = SharedPipelines::instance();
    std::string key = "compute";
    rt::test::append(key, infos->flags);
    const bool isLarge = shared.describe(infos->stage, key);
    return isLarge && count == 1 && shared.serves(device) ? shared.make(key, *pipelines, compile) : compile();
}

VKAPI_ATTR void VKAPI_CALL vkDestroyPipeline(VkDevice device, VkPipeline pipeline, const VkAllocationCallbacks*) {
    SharedPipelines::instance().destroy(device, pipeline);
}
