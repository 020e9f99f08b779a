#include "RayTracingGPU/AccelStructure.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <utility>

#include "Common/Vulkan/Check.h"

namespace rt::gpu {
namespace {

using shared::vec3;

constexpr VkBufferUsageFlags kBuildInput = VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_BUILD_INPUT_READ_ONLY_BIT_KHR;
constexpr VkBuildAccelerationStructureFlagsKHR kFastTrace = VK_BUILD_ACCELERATION_STRUCTURE_PREFER_FAST_TRACE_BIT_KHR;
constexpr std::uint32_t kMaxCustomIndex = (1u << 24) - 1; // of an instance

VkAccelerationStructureGeometryKHR triangleGeometry(VkDeviceAddress vertices, std::uint32_t vertexCount,
                                                    VkDeviceAddress indices) {
    VkAccelerationStructureGeometryKHR geometry{VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_KHR};
    geometry.geometryType = VK_GEOMETRY_TYPE_TRIANGLES_KHR;
    geometry.flags = VK_GEOMETRY_OPAQUE_BIT_KHR;
    VkAccelerationStructureGeometryTrianglesDataKHR& triangles = geometry.geometry.triangles;
    triangles.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_TRIANGLES_DATA_KHR;
    triangles.vertexFormat = VK_FORMAT_R32G32B32_SFLOAT;
    triangles.vertexData.deviceAddress = vertices;
    triangles.vertexStride = sizeof(vec3);
    triangles.maxVertex = vertexCount - 1;
    triangles.indexType = indices != 0 ? VK_INDEX_TYPE_UINT32 : VK_INDEX_TYPE_NONE_KHR;
    triangles.indexData.deviceAddress = indices;
    return geometry;
}

// The two triangles of each quad; RayTracing.Quad.rchit knows their order.
std::vector<vec3> quadVertices(const scene::CompiledScene& scene, const shared::Geometry& geometry) {
    std::vector<vec3> vertices;
    vertices.reserve(std::size_t{geometry.quadCount} * 6);
    for (std::uint32_t i = 0; i < geometry.quadCount; ++i) {
        const shared::Quad& quad = scene.quads[geometry.firstQuad + i];
        const vec3 u = quad.corner + quad.edgeU;
        const vec3 v = quad.corner + quad.edgeV;
        const vec3 opposite = quad.corner + quad.edgeU + quad.edgeV;
        vertices.insert(vertices.end(), {quad.corner, u, opposite, quad.corner, opposite, v});
    }
    return vertices;
}

// Bounds of each sphere over the whole shutter, rounded outwards.
std::vector<VkAabbPositionsKHR> sphereBoxes(const scene::CompiledScene& scene, const shared::Geometry& geometry) {
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    std::vector<VkAabbPositionsKHR> boxes(geometry.sphereCount);
    for (std::uint32_t i = 0; i < geometry.sphereCount; ++i) {
        const shared::Sphere& sphere = scene.spheres[geometry.firstSphere + i];
        vec3 low = sphere.center;
        vec3 high = sphere.center;
        if (!scene.sphereMotions.empty()) {
            const vec3 end = sphere.center + scene.sphereMotions[geometry.firstSphere + i];
            low = glm::min(low, end);
            high = glm::max(high, end);
        }
        for (int c = 0; c < 3; ++c) {
            // Room for the rounding of the intersection test, which works with the distance to the centre.
            const float margin = 4 * shared::kEpsilon * (std::max(std::abs(low[c]), std::abs(high[c])) + sphere.radius);
            low[c] = std::nextafter(low[c] - sphere.radius - margin, -kInfinity);
            high[c] = std::nextafter(high[c] + sphere.radius + margin, kInfinity);
        }
        boxes[i] = {low.x, low.y, low.z, high.x, high.y, high.z};
    }
    return boxes;
}

VkTransformMatrixKHR identity() {
    return {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}};
}

VkTransformMatrixKHR toMatrix(const shared::vec4 (&rows)[3]) {
    VkTransformMatrixKHR matrix;
    for (int r = 0; r < 3; ++r) {
        for (int c = 0; c < 4; ++c) matrix.matrix[r][c] = rows[r][c];
    }
    return matrix;
}

} // namespace

AccelStructure::AccelStructure(vulkan::VulkanContext& context, const scene::CompiledScene& scene,
                               const shared::SceneArrays& arrays)
    : context_(context) {
    for (std::uint32_t g = 0; g < scene.geometries.size(); ++g) {
        const shared::Geometry& geometry = scene.geometries[g];
        if (geometry.triangleCount + geometry.quadCount > 0) addSurfaces(scene, arrays, g);
        if (geometry.sphereCount > 0) addSpheres(scene, g);
    }
    buildTopLevel(scene);
}

void AccelStructure::addSurfaces(const scene::CompiledScene& scene, const shared::SceneArrays& arrays,
                                 std::uint32_t geometry) {
    const shared::Geometry& g = scene.geometries[geometry];
    BuildInput input;
    if (g.triangleCount > 0) {
        input.geometries.push_back(
            triangleGeometry(arrays.positions, static_cast<std::uint32_t>(scene.positions.size()), arrays.triangles));
        input.ranges.push_back(
            {g.triangleCount, g.firstTriangle * static_cast<std::uint32_t>(sizeof(shared::uvec3)), 0, 0});
    }
    const std::vector<vec3> vertices = quadVertices(scene, g);
    const vulkan::Buffer buffer = vulkan::deviceArray<vec3>(context_, vertices, "quads", kBuildInput);
    if (g.quadCount > 0) {
        input.geometries.push_back(triangleGeometry(buffer.address(), static_cast<std::uint32_t>(vertices.size()), 0));
        input.ranges.push_back({2 * g.quadCount, 0, 0, 0});
    }
    const std::uint32_t record = g.triangleCount > 0 ? shared::kHitRecordTriangle : shared::kHitRecordQuad;
    bottomLevels_.push_back({compact(build(input)), geometry, record});
}

void AccelStructure::addSpheres(const scene::CompiledScene& scene, std::uint32_t geometry) {
    const std::vector<VkAabbPositionsKHR> boxes = sphereBoxes(scene, scene.geometries[geometry]);
    const vulkan::Buffer buffer = vulkan::deviceArray<VkAabbPositionsKHR>(context_, boxes, "spheres", kBuildInput);
    VkAccelerationStructureGeometryKHR aabbs{VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_KHR};
    aabbs.geometryType = VK_GEOMETRY_TYPE_AABBS_KHR;
    aabbs.flags = VK_GEOMETRY_OPAQUE_BIT_KHR;
    aabbs.geometry.aabbs.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_AABBS_DATA_KHR;
    aabbs.geometry.aabbs.data.deviceAddress = buffer.address();
    aabbs.geometry.aabbs.stride = sizeof(VkAabbPositionsKHR);
    BuildInput input;
    input.geometries.push_back(aabbs);
    input.ranges.push_back({static_cast<std::uint32_t>(boxes.size()), 0, 0, 0});
    bottomLevels_.push_back({compact(build(input)), geometry, shared::kHitRecordSphere});
}

void AccelStructure::buildTopLevel(const scene::CompiledScene& scene) {
    if (scene.instances.size() >= kMaxCustomIndex) {
        throw RenderError(std::to_string(scene.instances.size()) + " instances are more than the " +
                          std::to_string(kMaxCustomIndex - 1) + " that a Vulkan scene can have");
    }
    std::vector<VkAccelerationStructureInstanceKHR> instances;
    const auto place = [&](std::uint32_t geometry, std::uint32_t index, const VkTransformMatrixKHR& matrix) {
        for (const BottomLevel& level : bottomLevels_) {
            if (level.geometry != geometry) continue;
            VkAccelerationStructureInstanceKHR instance{};
            instance.transform = matrix;
            instance.instanceCustomIndex = index & kMaxCustomIndex;
            instance.mask = 0xff;
            instance.instanceShaderBindingTableRecordOffset = level.hitRecord & 0xffffffu;
            instance.accelerationStructureReference = level.structure.address;
            instances.push_back(instance);
        }
    };
    place(0, 0, identity());
    for (std::uint32_t i = 0; i < scene.instances.size(); ++i) {
        place(scene.instances[i].geometry, i + 1, toMatrix(scene.instances[i].toWorld));
    }
    if (instances.size() > context_.limits().maxInstances) {
        throw RenderError(context_.info().name + " takes at most " + std::to_string(context_.limits().maxInstances) +
                          " instances; the scene has " + std::to_string(instances.size()));
    }
    const vulkan::Buffer buffer =
        vulkan::deviceArray<VkAccelerationStructureInstanceKHR>(context_, instances, "instances", kBuildInput);
    VkAccelerationStructureGeometryKHR geometry{VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_KHR};
    geometry.geometryType = VK_GEOMETRY_TYPE_INSTANCES_KHR;
    geometry.geometry.instances.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_INSTANCES_DATA_KHR;
    geometry.geometry.instances.data.deviceAddress = buffer.address();
    BuildInput input;
    input.type = VK_ACCELERATION_STRUCTURE_TYPE_TOP_LEVEL_KHR;
    input.geometries.push_back(geometry);
    input.ranges.push_back({static_cast<std::uint32_t>(instances.size()), 0, 0, 0});
    topLevel_ = build(input);
}

AccelStructure::Structure AccelStructure::allocate(VkAccelerationStructureTypeKHR type, VkDeviceSize bytes) {
    const vulkan::RayTracingFunctions& f = context_.rayTracing();
    Structure result;
    result.storage = vulkan::Buffer(context_, bytes, VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_STORAGE_BIT_KHR,
                                    vulkan::Memory::Device, "the acceleration structure");
    VkAccelerationStructureCreateInfoKHR info{VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_CREATE_INFO_KHR};
    info.type = type;
    info.size = bytes;
    info.buffer = result.storage.get();
    VkAccelerationStructureKHR structure = VK_NULL_HANDLE;
    vulkan::check(f.createAccelerationStructure(context_.device(), &info, nullptr, &structure),
                  "Creating the acceleration structure");
    result.structure = {context_.device(), structure, f.destroyAccelerationStructure};
    VkAccelerationStructureDeviceAddressInfoKHR address{
        VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_DEVICE_ADDRESS_INFO_KHR};
    address.accelerationStructure = structure;
    result.address = f.getAccelerationStructureAddress(context_.device(), &address);
    return result;
}

AccelStructure::Structure AccelStructure::build(const BuildInput& input) {
    const vulkan::RayTracingFunctions& f = context_.rayTracing();
    const bool compactable = input.type == VK_ACCELERATION_STRUCTURE_TYPE_BOTTOM_LEVEL_KHR;
    VkAccelerationStructureBuildGeometryInfoKHR info{VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_BUILD_GEOMETRY_INFO_KHR};
    info.type = input.type;
    info.flags = kFastTrace;
    if (compactable) info.flags |= VK_BUILD_ACCELERATION_STRUCTURE_ALLOW_COMPACTION_BIT_KHR;
    info.mode = VK_BUILD_ACCELERATION_STRUCTURE_MODE_BUILD_KHR;
    info.geometryCount = static_cast<std::uint32_t>(input.geometries.size());
    info.pGeometries = input.geometries.data();

    std::vector<std::uint32_t> counts;
    std::uint64_t total = 0;
    for (const VkAccelerationStructureBuildRangeInfoKHR& range : input.ranges) {
        counts.push_back(range.primitiveCount);
        total += range.primitiveCount;
    }
    if (compactable && total > context_.limits().maxPrimitives) {
        throw RenderError(context_.info().name + " takes at most " + std::to_string(context_.limits().maxPrimitives) +
                          " primitives; the scene has " + std::to_string(total));
    }
    VkAccelerationStructureBuildSizesInfoKHR sizes{VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_BUILD_SIZES_INFO_KHR};
    f.getBuildSizes(context_.device(), VK_ACCELERATION_STRUCTURE_BUILD_TYPE_DEVICE_KHR, &info, counts.data(), &sizes);

    Structure result = allocate(input.type, sizes.accelerationStructureSize);
    const VkDeviceSize alignment = std::max(1u, context_.limits().scratchAlignment);
    const vulkan::Buffer scratch(context_, sizes.buildScratchSize + alignment, 0, vulkan::Memory::Device,
                                 "building the acceleration structure");
    info.dstAccelerationStructure = result.structure.get();
    info.scratchData.deviceAddress = (scratch.address() + alignment - 1) / alignment * alignment;
    const VkAccelerationStructureBuildRangeInfoKHR* ranges = input.ranges.data();
    buildSeconds_ += context_.runTimed([&](VkCommandBuffer commands) {
        f.cmdBuild(commands, 1, &info, &ranges);
        vulkan::barrier(commands);
    });
    return result;
}

AccelStructure::Structure AccelStructure::compact(Structure original) {
    const vulkan::RayTracingFunctions& f = context_.rayTracing();
    const VkDevice device = context_.device();
    VkQueryPoolCreateInfo info{VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO};
    info.queryType = VK_QUERY_TYPE_ACCELERATION_STRUCTURE_COMPACTED_SIZE_KHR;
    info.queryCount = 1;
    VkQueryPool pool = VK_NULL_HANDLE;
    vulkan::check(vkCreateQueryPool(device, &info, nullptr, &pool), "Compacting the acceleration structure");
    const vulkan::Handle<VkQueryPool> owner(device, pool, vkDestroyQueryPool);
    const VkAccelerationStructureKHR from = original.structure.get();
    buildSeconds_ += context_.runTimed([&](VkCommandBuffer commands) {
        vkCmdResetQueryPool(commands, pool, 0, 1);
        f.cmdWriteProperties(commands, 1, &from, info.queryType, pool, 0);
    });
    VkDeviceSize bytes = 0;
    vulkan::check(vkGetQueryPoolResults(device, pool, 0, 1, sizeof bytes, &bytes, sizeof bytes,
                                        VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT),
                  "Compacting the acceleration structure");
    if (bytes == 0 || bytes >= original.storage.bytes()) return original;

    Structure result = allocate(VK_ACCELERATION_STRUCTURE_TYPE_BOTTOM_LEVEL_KHR, bytes);
    VkCopyAccelerationStructureInfoKHR copy{VK_STRUCTURE_TYPE_COPY_ACCELERATION_STRUCTURE_INFO_KHR};
    copy.src = from;
    copy.dst = result.structure.get();
    copy.mode = VK_COPY_ACCELERATION_STRUCTURE_MODE_COMPACT_KHR;
    buildSeconds_ += context_.runTimed([&](VkCommandBuffer commands) {
        f.cmdCopy(commands, &copy);
        vulkan::barrier(commands);
    });
    return result;
}

} // namespace rt::gpu
