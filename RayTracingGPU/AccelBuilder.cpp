#include "RayTracingGPU/AccelBuilder.h"

#include <algorithm>
#include <numeric>
#include <string>

#include "Common/Core/Error.h"
#include "Common/Vulkan/Check.h"
#include "Common/Vulkan/Create.h"
#include "RayTracingGPU/RoundUp.h"

namespace rt::gpu {
namespace {

using vulkan::check;

constexpr VkDeviceSize kBatchBytes = VkDeviceSize{256} << 20;  // of structures that are not compacted yet
constexpr VkDeviceSize kScratchBytes = VkDeviceSize{64} << 20; // of builds that the device may work at side by side
constexpr VkDeviceSize kStructureAlignment = 256;              // that Vulkan prescribes within a buffer
constexpr const char* kCompacting = "Compacting acceleration structures";

vulkan::Handle<VkQueryPool> makeSizeQueries(VkDevice device, std::size_t count) {
    VkQueryPoolCreateInfo info{VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO};
    info.queryType = VK_QUERY_TYPE_ACCELERATION_STRUCTURE_COMPACTED_SIZE_KHR;
    info.queryCount = static_cast<std::uint32_t>(count);
    return vulkan::create(device, vkCreateQueryPool, info, vkDestroyQueryPool, kCompacting);
}

} // namespace

struct AccelBuilder::Build {
    VkAccelerationStructureBuildGeometryInfoKHR info;
    const VkAccelerationStructureBuildRangeInfoKHR* ranges;
    VkDeviceSize bytes;
    VkDeviceSize scratchBytes;  // rounded up to its alignment
    VkDeviceSize scratchOffset; // 0: the ones before must be over
};

VkDeviceSize AccelBuilder::scratchAlignment() const {
    return std::max(1u, context_.limits().scratchAlignment);
}

AccelBuilder::Build AccelBuilder::prepare(const AccelInput& input, VkAccelerationStructureTypeKHR type) const {
    Build build{{VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_BUILD_GEOMETRY_INFO_KHR}, input.ranges.data(), 0, 0, 0};
    build.info.type = type;
    build.info.flags = VK_BUILD_ACCELERATION_STRUCTURE_PREFER_FAST_TRACE_BIT_KHR;
    build.info.mode = VK_BUILD_ACCELERATION_STRUCTURE_MODE_BUILD_KHR;
    build.info.geometryCount = static_cast<std::uint32_t>(input.geometries.size());
    build.info.pGeometries = input.geometries.data();

    std::vector<std::uint32_t> counts;
    for (const VkAccelerationStructureBuildRangeInfoKHR& range : input.ranges) counts.push_back(range.primitiveCount);
    if (type == VK_ACCELERATION_STRUCTURE_TYPE_BOTTOM_LEVEL_KHR) {
        build.info.flags |= VK_BUILD_ACCELERATION_STRUCTURE_ALLOW_COMPACTION_BIT_KHR;
        const std::uint64_t primitives = std::accumulate(counts.begin(), counts.end(), std::uint64_t{0});
        if (primitives > context_.limits().maxPrimitives) {
            throw RenderError(context_.info().name + " takes at most " +
                              std::to_string(context_.limits().maxPrimitives) + " primitives; the scene has " +
                              std::to_string(primitives));
        }
    }
    VkAccelerationStructureBuildSizesInfoKHR sizes{VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_BUILD_SIZES_INFO_KHR};
    context_.rayTracing().getBuildSizes(context_.device(), VK_ACCELERATION_STRUCTURE_BUILD_TYPE_DEVICE_KHR, &build.info,
                                        counts.data(), &sizes);
    build.bytes = sizes.accelerationStructureSize;
    build.scratchBytes = roundUp(sizes.buildScratchSize, scratchAlignment());
    return build;
}

AccelStorage AccelBuilder::allocate(VkAccelerationStructureTypeKHR type, std::span<const VkDeviceSize> sizes) const {
    const vulkan::RayTracingFunctions& f = context_.rayTracing();
    VkDeviceSize total = 0;
    for (const VkDeviceSize size : sizes) total += roundUp(size, kStructureAlignment);
    AccelStorage storage;
    storage.buffer = vulkan::Buffer(context_.memory(), total, VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_STORAGE_BIT_KHR,
                                    vulkan::Memory::Device, "the acceleration structure");
    VkAccelerationStructureCreateInfoKHR info{VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_CREATE_INFO_KHR};
    info.type = type;
    info.buffer = storage.buffer.get();
    for (const VkDeviceSize size : sizes) {
        info.size = size;
        VkAccelerationStructureKHR structure = VK_NULL_HANDLE;
        check(f.createAccelerationStructure(context_.device(), &info, nullptr, &structure),
              "Creating the acceleration structure");
        VkAccelerationStructureDeviceAddressInfoKHR address{
            VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_DEVICE_ADDRESS_INFO_KHR};
        address.accelerationStructure = structure;
        storage.structures.push_back({{context_.device(), structure, f.destroyAccelerationStructure},
                                      f.getAccelerationStructureAddress(context_.device(), &address)});
        info.offset += roundUp(size, kStructureAlignment);
    }
    return storage;
}

// Gives the builds their scratch memory: as many as fit into it side by side, the next ones where those were. Returns
// its size.
VkDeviceSize AccelBuilder::placeScratch(std::span<Build> builds) {
    VkDeviceSize used = 0;
    VkDeviceSize maximum = 0;
    for (Build& build : builds) {
        if (used + build.scratchBytes > kScratchBytes) used = 0;
        build.scratchOffset = used;
        used += build.scratchBytes;
        maximum = std::max(maximum, used);
    }
    return maximum;
}

void AccelBuilder::record(VkCommandBuffer commands, std::span<const Build> builds) const {
    std::vector<VkAccelerationStructureBuildGeometryInfoKHR> infos;
    std::vector<const VkAccelerationStructureBuildRangeInfoKHR*> ranges;
    for (std::size_t i = 0; i < builds.size(); ++i) {
        infos.push_back(builds[i].info);
        ranges.push_back(builds[i].ranges);
        if (i + 1 < builds.size() && builds[i + 1].scratchOffset != 0) continue;
        const auto count = static_cast<std::uint32_t>(infos.size());
        context_.rayTracing().cmdBuild(commands, count, infos.data(), ranges.data());
        vulkan::barrier(commands, vulkan::kStructureWrite, vulkan::kStructureWrite | context_.structureUses());
        infos.clear();
        ranges.clear();
    }
}

// Asks for the sizes that they would have compacted, unless `compactedSizes` is null.
AccelStorage AccelBuilder::build(std::span<Build> builds, VkQueryPool compactedSizes) {
    std::vector<VkDeviceSize> sizes;
    for (const Build& build : builds) sizes.push_back(build.bytes);
    AccelStorage storage = allocate(builds.front().info.type, sizes);
    const vulkan::Buffer scratch(context_.memory(), placeScratch(builds), 0, vulkan::Memory::Device,
                                 "building the acceleration structure", scratchAlignment());
    std::vector<VkAccelerationStructureKHR> built;
    for (std::size_t i = 0; i < builds.size(); ++i) {
        built.push_back(storage.structures[i].structure.get());
        builds[i].info.dstAccelerationStructure = built.back();
        builds[i].info.scratchData.deviceAddress = scratch.address() + builds[i].scratchOffset;
    }
    seconds_ += context_.runTimed([&](VkCommandBuffer commands) {
        record(commands, builds);
        if (compactedSizes == VK_NULL_HANDLE) return;
        const auto count = static_cast<std::uint32_t>(built.size());
        vkCmdResetQueryPool(commands, compactedSizes, 0, count);
        context_.rayTracing().cmdWriteProperties(
            commands, count, built.data(), VK_QUERY_TYPE_ACCELERATION_STRUCTURE_COMPACTED_SIZE_KHR, compactedSizes, 0);
    });
    return storage;
}

AccelStorage AccelBuilder::buildCompacted(std::span<Build> builds) {
    const auto queries = makeSizeQueries(context_.device(), builds.size());
    AccelStorage original = build(builds, queries.get());
    std::vector<VkDeviceSize> sizes(builds.size());
    check(vkGetQueryPoolResults(context_.device(), queries.get(), 0, static_cast<std::uint32_t>(sizes.size()),
                                sizes.size() * sizeof sizes[0], sizes.data(), sizeof sizes[0],
                                VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT),
          kCompacting);
    VkDeviceSize total = 0;
    for (const VkDeviceSize size : sizes) total += roundUp(size, kStructureAlignment);
    const bool isKnown = std::find(sizes.begin(), sizes.end(), 0u) == sizes.end();
    if (!isKnown || total >= original.buffer.bytes()) return original;

    AccelStorage compacted = allocate(builds.front().info.type, sizes);
    seconds_ += context_.runTimed([&](VkCommandBuffer commands) {
        for (std::size_t i = 0; i < sizes.size(); ++i) {
            VkCopyAccelerationStructureInfoKHR copy{VK_STRUCTURE_TYPE_COPY_ACCELERATION_STRUCTURE_INFO_KHR};
            copy.src = original.structures[i].structure.get();
            copy.dst = compacted.structures[i].structure.get();
            copy.mode = VK_COPY_ACCELERATION_STRUCTURE_MODE_COMPACT_KHR;
            context_.rayTracing().cmdCopy(commands, &copy);
        }
        vulkan::barrier(commands, vulkan::kStructureWrite, context_.structureUses());
    });
    return compacted;
}

std::vector<AccelStorage> AccelBuilder::buildBottomLevels(std::span<const AccelInput> inputs) {
    std::vector<Build> builds;
    for (const AccelInput& input : inputs) {
        builds.push_back(prepare(input, VK_ACCELERATION_STRUCTURE_TYPE_BOTTOM_LEVEL_KHR));
    }
    std::vector<AccelStorage> levels;
    for (std::size_t first = 0; first < builds.size();) {
        std::size_t count = 1;
        VkDeviceSize bytes = builds[first].bytes;
        while (first + count < builds.size() && bytes + builds[first + count].bytes <= kBatchBytes) {
            bytes += builds[first + count++].bytes;
        }
        levels.push_back(buildCompacted(std::span(builds).subspan(first, count)));
        first += count;
    }
    return levels;
}

AccelStorage AccelBuilder::buildTopLevel(const AccelInput& input) {
    Build only = prepare(input, VK_ACCELERATION_STRUCTURE_TYPE_TOP_LEVEL_KHR);
    return build(std::span(&only, 1), VK_NULL_HANDLE);
}

} // namespace rt::gpu
