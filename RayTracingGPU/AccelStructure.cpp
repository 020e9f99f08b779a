#include "RayTracingGPU/AccelStructure.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "Common/Accel/Build/PrimitiveBoxes.h"
#include "Common/Accel/SameGeometry.h"
#include "Common/Core/Error.h"
#include "Common/Vulkan/StagingRing.h"

namespace rt::gpu {
namespace {

using shared::vec3;

constexpr VkBufferUsageFlags kBuildInput = VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_BUILD_INPUT_READ_ONLY_BIT_KHR;
constexpr VkDeviceSize kInstanceAlignment = 16; // of their address, which Vulkan prescribes
constexpr std::uint32_t kQuadVertices = 6;
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
std::vector<vec3> quadVertices(const scene::CompiledScene& scene) {
    std::vector<vec3> vertices;
    vertices.reserve(scene.quads.size() * kQuadVertices);
    for (const shared::Quad& quad : scene.quads) {
        const vec3 u = quad.corner + quad.edgeU;
        const vec3 v = quad.corner + quad.edgeV;
        const vec3 opposite = quad.corner + quad.edgeU + quad.edgeV;
        vertices.insert(vertices.end(), {quad.corner, u, opposite, quad.corner, opposite, v});
    }
    return vertices;
}

// Bounds of each sphere over the whole shutter, rounded outwards.
std::vector<VkAabbPositionsKHR> sphereBoxes(const scene::CompiledScene& scene) {
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    std::vector<VkAabbPositionsKHR> boxes(scene.spheres.size());
    for (std::size_t i = 0; i < boxes.size(); ++i) {
        const shared::Sphere& sphere = scene.spheres[i];
        vec3 low = sphere.center;
        vec3 high = sphere.center;
        if (!scene.sphereMotions.empty()) {
            const vec3 end = sphere.center + scene.sphereMotions[i];
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

std::vector<VkAabbPositionsKHR> roundBoxes(const scene::CompiledScene& scene) {
    std::vector<VkAabbPositionsKHR> boxes;
    boxes.reserve(scene.rounds.size());
    for (const shared::Round& round : scene.rounds) {
        const accel::Box box = accel::boxOf(round);
        boxes.push_back({box.lower.x, box.lower.y, box.lower.z, box.upper.x, box.upper.y, box.upper.z});
    }
    return boxes;
}

VkAccelerationStructureGeometryKHR boxGeometry(VkDeviceAddress boxes) {
    VkAccelerationStructureGeometryKHR geometry{VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_KHR};
    geometry.geometryType = VK_GEOMETRY_TYPE_AABBS_KHR;
    geometry.flags = VK_GEOMETRY_OPAQUE_BIT_KHR;
    geometry.geometry.aabbs.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_AABBS_DATA_KHR;
    geometry.geometry.aabbs.data.deviceAddress = boxes;
    geometry.geometry.aabbs.stride = sizeof(VkAabbPositionsKHR);
    return geometry;
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
                               const shared::SceneArrays& arrays, const std::optional<Before>& before)
    : context_(context) {
    if (scene.instances.size() >= kMaxCustomIndex) {
        throw RenderError(std::to_string(scene.instances.size()) + " instances are more than the " +
                          std::to_string(kMaxCustomIndex - 1) + " that a Vulkan scene can have");
    }
    AccelBuilder builder(context);
    listBottomLevels(scene, before);
    buildBottomLevels(builder, scene, arrays);
    if (before && hasLevelsOf(before->structure) &&
        accel::sameInstances(accel::inputOf(before->scene), accel::inputOf(scene)))
        topLevel_ = before->structure.topLevel_;
    else
        buildTopLevel(builder, scene);
    buildSeconds_ = builder.seconds();
}

void AccelStructure::listBottomLevels(const scene::CompiledScene& scene, const std::optional<Before>& before) {
    using Same = bool (*)(const accel::AccelInput&, const accel::AccelInput&, std::uint32_t);
    const auto list = [&](std::uint32_t geometry, std::uint32_t hitRecord, Same same) {
        BottomLevel level{geometry, hitRecord, 0, nullptr};
        if (before && geometry < before->scene.geometries.size() &&
            same(accel::inputOf(before->scene), accel::inputOf(scene), geometry)) {
            const std::vector<BottomLevel>& levels = before->structure.bottomLevels_;
            const auto isIt = [&](const BottomLevel& other) {
                return other.geometry == geometry && other.hitRecord == hitRecord;
            };
            const auto found = std::find_if(levels.begin(), levels.end(), isIt);
            if (found != levels.end()) level = *found;
        }
        bottomLevels_.push_back(std::move(level));
    };
    for (std::uint32_t i = 0; i < scene.geometries.size(); ++i) {
        const shared::Geometry& g = scene.geometries[i];
        if (g.triangleCount + g.quadCount > 0)
            list(i, g.triangleCount > 0 ? shared::kHitRecordTriangle : shared::kHitRecordQuad, accel::sameSurfaces);
        if (g.sphereCount > 0) list(i, shared::kHitRecordSphere, accel::sameSpheres);
        if (g.roundCount > 0) list(i, shared::kHitRecordRound, accel::sameRounds);
    }
}

void AccelStructure::buildBottomLevels(AccelBuilder& builder, const scene::CompiledScene& scene,
                                       const shared::SceneArrays& arrays) {
    std::vector<BottomLevel*> missing;
    for (BottomLevel& level : bottomLevels_)
        if (!level.storage) missing.push_back(&level);
    if (missing.empty()) return;
    const auto quads = vulkan::deviceArray<vec3>(context_, quadVertices(scene), "quads", kBuildInput);
    const auto boxes = vulkan::deviceArray<VkAabbPositionsKHR>(context_, sphereBoxes(scene), "spheres", kBuildInput);
    const auto rounds =
        vulkan::deviceArray<VkAabbPositionsKHR>(context_, roundBoxes(scene), "disks and cylinders", kBuildInput);
    const auto boxed = [](const vulkan::Buffer& from, std::uint32_t first, std::uint32_t count) -> AccelInput {
        return {{boxGeometry(from.address() + VkDeviceSize{first} * sizeof(VkAabbPositionsKHR))}, {{count, 0, 0, 0}}};
    };
    const auto surfaces = [&](const shared::Geometry& g) {
        AccelInput input;
        if (g.triangleCount > 0) {
            input.geometries.push_back(triangleGeometry(
                arrays.positions, static_cast<std::uint32_t>(scene.positions.size()), arrays.triangles));
            const std::uint32_t offset = g.firstTriangle * static_cast<std::uint32_t>(sizeof(shared::uvec3));
            input.ranges.push_back({g.triangleCount, offset, 0, 0});
        }
        if (g.quadCount > 0) {
            const VkDeviceSize offset = VkDeviceSize{g.firstQuad} * kQuadVertices * sizeof(vec3);
            input.geometries.push_back(triangleGeometry(quads.address() + offset, g.quadCount * kQuadVertices, 0));
            input.ranges.push_back({2 * g.quadCount, 0, 0, 0});
        }
        return input;
    };
    std::vector<AccelInput> inputs;
    for (const BottomLevel* level : missing) {
        const shared::Geometry& g = scene.geometries[level->geometry];
        if (level->hitRecord == shared::kHitRecordSphere)
            inputs.push_back(boxed(boxes, g.firstSphere, g.sphereCount));
        else if (level->hitRecord == shared::kHitRecordRound)
            inputs.push_back(boxed(rounds, g.firstRound, g.roundCount));
        else
            inputs.push_back(surfaces(g));
    }
    auto level = missing.begin();
    for (AccelStorage& built : builder.buildBottomLevels(inputs)) {
        const auto storage = std::make_shared<const AccelStorage>(std::move(built));
        for (const Accel& structure : storage->structures) {
            (*level)->address = structure.address;
            (*level++)->storage = storage;
        }
    }
}

bool AccelStructure::hasLevelsOf(const AccelStructure& other) const {
    const auto isSame = [](const BottomLevel& a, const BottomLevel& b) {
        return a.geometry == b.geometry && a.hitRecord == b.hitRecord && a.address == b.address;
    };
    return std::equal(bottomLevels_.begin(), bottomLevels_.end(), other.bottomLevels_.begin(),
                      other.bottomLevels_.end(), isSame);
}

// Of each instance one for each bottom level of its geometry; the scene's own primitives, of geometry 0, are instance
// 0.
std::vector<VkAccelerationStructureInstanceKHR> AccelStructure::listInstances(const scene::CompiledScene& scene) const {
    std::vector<VkAccelerationStructureInstanceKHR> instances;
    const auto place = [&](std::uint32_t geometry, std::uint32_t index, const VkTransformMatrixKHR& matrix) {
        auto level = std::lower_bound(bottomLevels_.begin(), bottomLevels_.end(), geometry,
                                      [](const BottomLevel& a, std::uint32_t b) { return a.geometry < b; });
        for (; level != bottomLevels_.end() && level->geometry == geometry; ++level) {
            VkAccelerationStructureInstanceKHR instance{};
            instance.transform = matrix;
            instance.instanceCustomIndex = index & kMaxCustomIndex;
            instance.mask = 0xff;
            instance.instanceShaderBindingTableRecordOffset = level->hitRecord & 0xffffffu;
            instance.accelerationStructureReference = level->address;
            instances.push_back(instance);
        }
    };
    place(0, 0, identity());
    for (std::uint32_t i = 0; i < scene.instances.size(); ++i) {
        place(scene.instances[i].geometry, i + 1, toMatrix(scene.instances[i].toWorld));
    }
    return instances;
}

void AccelStructure::buildTopLevel(AccelBuilder& builder, const scene::CompiledScene& scene) {
    std::vector<VkAccelerationStructureInstanceKHR> instances = listInstances(scene);
    const auto count = static_cast<std::uint32_t>(instances.size());
    if (count > context_.limits().maxInstances) {
        throw RenderError(context_.info().name + " takes at most " + std::to_string(context_.limits().maxInstances) +
                          " instances; the scene has " + std::to_string(count));
    }
    if (count == 0) instances.emplace_back(); // not part of the level, but Vulkan wants an address even of none
    const auto buffer = vulkan::deviceArray<VkAccelerationStructureInstanceKHR>(context_, instances, "instances",
                                                                                kBuildInput, kInstanceAlignment);
    VkAccelerationStructureGeometryKHR geometry{VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_KHR};
    geometry.geometryType = VK_GEOMETRY_TYPE_INSTANCES_KHR;
    geometry.geometry.instances.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_INSTANCES_DATA_KHR;
    geometry.geometry.instances.data.deviceAddress = buffer.address();
    topLevel_ = std::make_shared<const AccelStorage>(builder.buildTopLevel({{geometry}, {{count, 0, 0, 0}}}));
}

} // namespace rt::gpu
