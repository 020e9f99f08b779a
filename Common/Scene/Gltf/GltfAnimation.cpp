#include "Common/Scene/Gltf/GltfAnimation.h"

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <string>

#include "Common/Scene/Gltf/GltfAccessor.h"

namespace rt::scene {

namespace {

// Elements of a sampler's output that are its first keyframe, `width` of them. Between the tangents of a cubic spline
// lies the value.
std::vector<std::uint32_t> firstKeyframe(const GltfFile& file, const tinygltf::AnimationSampler& sampler,
                                         std::size_t width, const std::string& place) {
    const std::size_t before = sampler.interpolation == "CUBICSPLINE" ? width : 0;
    if (accessorCount(file, sampler.output) < before + width)
        file.fail(place + "/output", "ends within the first keyframe");
    std::vector<std::uint32_t> elements(width);
    std::iota(elements.begin(), elements.end(), static_cast<std::uint32_t>(before));
    return elements;
}

} // namespace

std::size_t morphTargetCount(const tinygltf::Mesh& mesh) {
    std::size_t count = 0;
    for (const tinygltf::Primitive& primitive : mesh.primitives) count = std::max(count, primitive.targets.size());
    return count;
}

std::map<std::size_t, NodePose> startOfAnimation(const GltfFile& file, GltfBudget& budget) {
    std::map<std::size_t, NodePose> poses;
    if (file.model.animations.empty()) return poses;
    const tinygltf::Animation& animation = file.model.animations.front();
    for (const tinygltf::AnimationChannel& channel : animation.channels) {
        if (channel.target_node < 0 || channel.sampler < 0) continue;
        const auto node = static_cast<std::size_t>(channel.target_node);
        const int mesh = file.model.nodes[node].mesh;
        const bool isWeights = channel.target_path == "weights";
        const std::size_t width = !isWeights ? 1
                                  : mesh < 0 ? 0
                                             : morphTargetCount(file.model.meshes[static_cast<std::size_t>(mesh)]);
        if (width == 0) continue;
        const std::string place = "/animations/0/samplers/" + std::to_string(channel.sampler);
        const tinygltf::AnimationSampler& sampler = animation.samplers[static_cast<std::size_t>(channel.sampler)];
        budget.spend(width + sparseCount(file, sampler.output), place);
        const std::vector<std::uint32_t> first = firstKeyframe(file, sampler, width, place);
        NodePose& pose = poses[node];
        if (isWeights)
            pose.weights = readNumbers(file, sampler.output, &first);
        else if (channel.target_path == "translation")
            pose.translation = readVectors<3>(file, sampler.output, &first).front();
        else if (channel.target_path == "rotation")
            pose.rotation = readVectors<4>(file, sampler.output, &first).front();
        else if (channel.target_path == "scale")
            pose.scale = readVectors<3>(file, sampler.output, &first).front();
    }
    return poses;
}

} // namespace rt::scene
