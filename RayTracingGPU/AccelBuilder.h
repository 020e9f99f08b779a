// Builds acceleration structures on the device: many bottom levels in one submission, with scratch memory that they
// share.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "Common/Vulkan/Buffer.h"
#include "Common/Vulkan/VulkanContext.h"

namespace rt::gpu {

// What one structure is built from: geometries, and of each the primitives that are meant. Buffers must last until it
// is built.
struct AccelInput {
    std::vector<VkAccelerationStructureGeometryKHR> geometries;
    std::vector<VkAccelerationStructureBuildRangeInfoKHR> ranges;
};

struct Accel {
    vulkan::Handle<VkAccelerationStructureKHR> structure;
    VkDeviceAddress address = 0;
};

// Structures that lie one behind the other in a buffer.
struct AccelStorage {
    vulkan::Buffer buffer; // outlives them
    std::vector<Accel> structures;
};

class AccelBuilder {
  public:
    explicit AccelBuilder(vulkan::VulkanContext& context) : context_(context) {}

    // A bottom level for each input, in their order, compacted where that saves memory. What is not compacted yet and
    // the scratch memory are of bounded size, but for a structure that is larger by itself. Throws RenderError.
    std::vector<AccelStorage> buildBottomLevels(std::span<const AccelInput> inputs);
    AccelStorage buildTopLevel(const AccelInput& input);

    double seconds() const { return seconds_; } // that the device took so far

  private:
    struct Build; // of one structure

    VkDeviceSize scratchAlignment() const;
    Build prepare(const AccelInput& input, VkAccelerationStructureTypeKHR type) const;
    AccelStorage allocate(VkAccelerationStructureTypeKHR type, std::span<const VkDeviceSize> sizes) const;
    AccelStorage build(std::span<Build> builds, VkQueryPool compactedSizes);
    AccelStorage buildCompacted(std::span<Build> builds);
    static VkDeviceSize placeScratch(std::span<Build> builds);
    void record(VkCommandBuffer commands, std::span<const Build> builds) const;

    vulkan::VulkanContext& context_;
    double seconds_ = 0;
};

} // namespace rt::gpu
