#include "RayTracingGPU/GpuScene.h"

#include <utility>

namespace rt::gpu {

template <class T>
std::uint64_t GpuScene::add(vulkan::VulkanContext& context, const std::vector<T>& data, const char* name,
                            VkBufferUsageFlags usage) {
    if (data.empty()) return 0;
    buffers_.push_back(vulkan::deviceArray<T>(context, data, name, usage));
    return buffers_.back().address();
}

GpuScene::GpuScene(vulkan::VulkanContext& context, std::shared_ptr<const scene::CompiledScene> compiled)
    : compiled_(std::move(compiled)) {
    const scene::CompiledScene& s = *compiled_;
    constexpr VkBufferUsageFlags kBuildInput = VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_BUILD_INPUT_READ_ONLY_BIT_KHR;
    arrays_.spheres = add(context, s.spheres, "spheres");
    arrays_.sphereMotions = add(context, s.sphereMotions, "motion");
    arrays_.quads = add(context, s.quads, "quads");
    arrays_.positions = add(context, s.positions, "vertices", kBuildInput);
    arrays_.normals = add(context, s.normals, "normals");
    arrays_.uvs = add(context, s.uvs, "texture coordinates");
    arrays_.triangles = add(context, s.triangles, "triangles", kBuildInput);
    arrays_.meshes = add(context, s.meshes, "meshes");
    arrays_.triangleMesh = add(context, s.triangleMesh, "triangles");
    arrays_.geometries = add(context, s.geometries, "geometries");
    arrays_.instances = add(context, s.instances, "instances");
    arrays_.materials = add(context, s.materials, "materials");
    arrays_.textures = add(context, s.textures, "textures");
    arrays_.images = add(context, s.images, "images");
    arrays_.texels = add(context, s.texels, "texels");
    arrays_.perlinGradients = add(context, s.perlinGradients, "noise");
    arrays_.perlinPermutations = add(context, s.perlinPermutations, "noise");
    arrays_.media = add(context, s.media, "media");
    arrays_.lights = add(context, s.lights, "lights");
    arrays_.lightBounds = add(context, s.lightBounds, "lights");
    arrays_.lightNodes = add(context, s.lightNodes, "the light tree");
    arrays_.lightPlaces = add(context, s.lightPlaces, "the light tree");
    arrays_.skyCdf = add(context, s.skyCdf, "sky");
    accel_ = std::make_unique<AccelStructure>(context, s, arrays_);
}

void GpuScene::provideMotion(vulkan::VulkanContext& context) {
    if (arrays_.sphereMotions != 0) return;
    const std::vector<shared::vec3> rest(compiled_->spheres.size(), shared::vec3(0.0f));
    arrays_.sphereMotions = add(context, rest, "motion");
}

}  // namespace rt::gpu
