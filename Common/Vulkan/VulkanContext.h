// One device with one queue, and all that is known about it: enough for headless rendering.
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include <vulkan/vulkan.h>

#include "Common/Vulkan/Barrier.h"
#include "Common/Vulkan/DeviceMemory.h"
#include "Common/Vulkan/DeviceSelection.h"
#include "Common/Vulkan/Handle.h"
#include "Common/Vulkan/Instance.h"
#include "Common/Vulkan/Submission.h"

namespace rt::vulkan {

class StagingRing;

struct ContextOptions {
    std::string device; // index or part of a name; empty: the best
    bool validation = false;
    RayTracing rayTracing = RayTracing::None; // that is needed; whatever the device has is there
    bool shaderFigures = false;               // what its driver tells of compiled shaders, if it does
};

// Entry points of the extensions, which the loader does not export; null where the device lacks what they are part of.
struct RayTracingFunctions {
    PFN_vkCreateAccelerationStructureKHR createAccelerationStructure = nullptr;
    PFN_vkDestroyAccelerationStructureKHR destroyAccelerationStructure = nullptr;
    PFN_vkGetAccelerationStructureBuildSizesKHR getBuildSizes = nullptr;
    PFN_vkGetAccelerationStructureDeviceAddressKHR getAccelerationStructureAddress = nullptr;
    PFN_vkCmdBuildAccelerationStructuresKHR cmdBuild = nullptr;
    PFN_vkCmdCopyAccelerationStructureKHR cmdCopy = nullptr;
    PFN_vkCmdWriteAccelerationStructuresPropertiesKHR cmdWriteProperties = nullptr;
    PFN_vkCreateRayTracingPipelinesKHR createPipelines = nullptr;
    PFN_vkGetRayTracingShaderGroupHandlesKHR getGroupHandles = nullptr;
    PFN_vkCmdTraceRaysKHR cmdTraceRays = nullptr;
};

// What a device allows and prescribes; nothing is assumed. Zero for what it cannot do at all.
struct DeviceLimits {
    std::uint32_t groupHandleSize = 0; // bytes, of a shader binding table's entries
    std::uint32_t groupHandleAlignment = 0;
    std::uint32_t groupBaseAlignment = 0;
    std::uint32_t maxInvocations = 0;   // of one launch of rays
    std::uint32_t maxGroupSize = 0;     // invocations of a work group of compute shaders, along x
    std::uint32_t scratchAlignment = 0; // bytes, of acceleration structure builds
    std::uint64_t maxPrimitives = 0;    // of one acceleration structure
    std::uint64_t maxInstances = 0;
    std::uint32_t maxDrawnSide = 0; // pixels, of an image that is drawn
    double timestampSeconds = 0;    // of one tick; 0: the queue has no timestamps
    std::uint64_t timestampMask = 0;
    std::uint32_t vendor = 0;
    std::uint32_t deviceId = 0;
    std::uint8_t pipelineCacheId[VK_UUID_SIZE] = {};
    std::array<std::uint8_t, VK_UUID_SIZE> uuid{}; // of this very device, for other interfaces to it
};

// Not thread-safe. Must outlive everything that is made with it.
class VulkanContext {
  public:
    // Throws NoDeviceError or RenderError.
    explicit VulkanContext(const ContextOptions& options);
    virtual ~VulkanContext();
    VulkanContext(const VulkanContext&) = delete;
    VulkanContext& operator=(const VulkanContext&) = delete;

    VkDevice device() const { return device_.get(); }
    DeviceMemory& memory() { return *memory_; }
    StagingRing& staging() { return *staging_; }
    const DeviceInfo& info() const { return info_; }
    const DeviceLimits& limits() const { return limits_; }
    const RayTracingFunctions& rayTracing() const { return rayTracing_; }
    // Whether pipelines are to be made so that shaderFigures() (ShaderFigures.h) knows them.
    bool hasShaderFigures() const { return info_.hasShaderFigures && shaderFigures_; }
    std::uint64_t validationMessages() const { return instance_.validationMessages(); }

    // Records commands, runs them and waits for their end. Throws DeviceLostError or RenderError.
    void run(const Record& record);
    // The same, and returns how long the device took for it in seconds.
    double runTimed(const Record& record);
    // Ends what was begun, timed as well.
    double finishTimed(Run& run);
    double longestRun() const { return longestRun_; } // of all that were timed, in seconds

    // All that shaders, copies and builds of acceleration structures do with buffers, in the stages that this device
    // has.
    Access bufferUses() const;
    // All that builds and rays do with acceleration structures, in the stages that this device has.
    Access structureUses() const;

  protected:
    friend class Run;
    // Hands recorded commands to the device. Virtual for tests, whose devices can fail.
    virtual void submit(VkCommandBuffer commands, VkFence fence);
    // Waits for at most so many nanoseconds. Likewise virtual.
    virtual VkResult wait(VkFence fence, std::uint64_t nanoseconds);

  private:
    void createDevice();
    void loadFunctions();
    void queryLimits();

    Instance instance_;
    DeviceInfo info_;
    bool shaderFigures_;
    DeviceLimits limits_;
    OwnedDevice device_;
    VkQueue queue_ = VK_NULL_HANDLE;
    RayTracingFunctions rayTracing_;
    std::optional<DeviceMemory> memory_; // from here on made with the device, and gone before it
    Handle<VkCommandPool> commandPool_;
    std::optional<Run> run_;
    std::unique_ptr<StagingRing> staging_;
    double longestRun_ = 0;
};

} // namespace rt::vulkan
