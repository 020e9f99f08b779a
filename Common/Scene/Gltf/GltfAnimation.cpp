#include "Common/Scene/Gltf/GltfAnimation.h"

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "Common/Core/Interruption.h"
#include "Common/Scene/Counted.h"
#include "Common/Scene/Gltf/GltfAccessor.h"
#include "Common/Scene/UniqueNames.h"

namespace rt::scene {

namespace {

// ---- between two keyframes -----------------------------------------------------------------------------------------

double between(double from, double to, double share) {
    return from * (1 - share) + to * share;
}

glm::dvec3 between(const glm::dvec3& from, const glm::dvec3& to, double share) {
    return from * (1 - share) + to * share;
}

glm::dquat unitQuaternion(const glm::dvec4& q) {
    const double length = glm::length(q);
    return length > 0 ? glm::dquat(q.w / length, q.x / length, q.y / length, q.z / length) : glm::dquat(1, 0, 0, 0);
}

// Rotations: at constant speed, the shorter way around.
glm::dvec4 between(const glm::dvec4& from, const glm::dvec4& to, double share) {
    const glm::dquat turn = glm::slerp(unitQuaternion(from), unitQuaternion(to), share);
    return {turn.x, turn.y, turn.z, turn.w};
}

// Appendix C.5 of the specification: a Hermite spline, by the tangents at its ends in units of a second.
template <typename Value>
Value splineBetween(const Value& from, const Value& leaving, const Value& arriving, const Value& to, double share,
                    double seconds) {
    const double t = share, t2 = t * t, t3 = t2 * t;
    return from * (2 * t3 - 3 * t2 + 1) + leaving * (seconds * (t3 - 2 * t2 + t)) + to * (3 * t2 - 2 * t3) +
           arriving * (seconds * (t3 - t2));
}

// ---- channels ------------------------------------------------------------------------------------------------------

// Where a time lies among keyframes.
struct Interval {
    std::size_t keyframes = 0;
    std::size_t first = 0; // the keyframe that it begins with
    double share = 0;      // how much of it has passed; 0: the keyframe itself counts
    double seconds = 0;    // its length
};

class Poser {
  public:
    Poser(const GltfFile& file, std::size_t animation, double time, GltfBudget& budget)
        : file_(file),
          animation_(file.model.animations[animation]),
          place_("/animations/" + std::to_string(animation) + "/samplers/"),
          time_(time),
          budget_(budget) {}

    AnimationPose run() {
        for (const tinygltf::AnimationChannel& channel : animation_.channels) {
            interruptionPoint();
            if (channel.target_node >= 0 && channel.sampler >= 0) apply(channel);
        }
        return std::move(pose_);
    }

  private:
    template <typename Value>
    using Read = std::vector<Value> (*)(const GltfFile&, int accessor, const std::vector<std::uint32_t>* elements);

    void apply(const tinygltf::AnimationChannel& channel) {
        const auto node = static_cast<std::size_t>(channel.target_node);
        const int mesh = file_.model.nodes[node].mesh;
        if (channel.target_path == "weights") {
            const std::size_t targets =
                mesh < 0 ? 0 : morphTargetCount(file_.model.meshes[static_cast<std::size_t>(mesh)]);
            if (targets > 0) pose_.nodes[node].weights = values<double>(channel.sampler, targets, readNumbers);
        } else if (channel.target_path == "translation") {
            pose_.nodes[node].translation = values<glm::dvec3>(channel.sampler, 1, readVectors<3>).front();
        } else if (channel.target_path == "rotation") {
            pose_.nodes[node].rotation = values<glm::dvec4>(channel.sampler, 1, readVectors<4>).front();
        } else if (channel.target_path == "scale") {
            pose_.nodes[node].scale = values<glm::dvec3>(channel.sampler, 1, readVectors<3>).front();
        }
    }

    // The `width` values of a sampler at the time. Its output has so many for each keyframe; those of a spline lie
    // between as many tangents that arrive there and as many that leave.
    template <typename Value>
    std::vector<Value> values(int index, std::size_t width, Read<Value> read) {
        const tinygltf::AnimationSampler& sampler = animation_.samplers[static_cast<std::size_t>(index)];
        const std::string place = place_ + std::to_string(index);
        const bool isSpline = sampler.interpolation == "CUBICSPLINE", isStep = sampler.interpolation == "STEP";
        if (!isSpline && !isStep && sampler.interpolation != "LINEAR")
            file_.fail(place + "/interpolation", "must be LINEAR, STEP or CUBICSPLINE");
        const Interval& interval = intervalOf(sampler.input, place);
        const std::size_t each = isSpline ? 3 * width : width, given = accessorCount(file_, sampler.output);
        if (given / each < interval.keyframes)
            file_.fail(place + "/output", "has " + counted(given, "element", "elements") + ": must be " +
                                              std::to_string(each) + " for each of " +
                                              counted(interval.keyframes, "keyframe", "keyframes"));
        const bool isBetween = interval.share > 0 && !isStep;
        const std::size_t count = !isBetween ? width : isSpline ? 4 * width : 2 * width;
        budget_.spend(count + sparseCount(file_, sampler.output), place);
        std::vector<std::uint32_t> elements(count);
        std::iota(elements.begin(), elements.end(),
                  static_cast<std::uint32_t>(interval.first * each + (isSpline ? width : 0)));
        std::vector<Value> keys = read(file_, sampler.output, &elements);
        for (std::size_t i = 0; isBetween && i < width; ++i)
            keys[i] = isSpline ? splineBetween(keys[i], keys[width + i], keys[2 * width + i], keys[3 * width + i],
                                               interval.share, interval.seconds)
                               : between(keys[i], keys[width + i], interval.share);
        keys.resize(width);
        return keys;
    }

    // Channels often share their times.
    const Interval& intervalOf(int input, const std::string& place) {
        const auto [found, isNew] = intervals_.try_emplace(input);
        Interval& interval = found->second;
        if (!isNew) return interval;
        budget_.spend(accessorCount(file_, input) + sparseCount(file_, input), place + "/input");
        const std::vector<double> times = readNumbers(file_, input, nullptr);
        const auto unsorted = std::is_sorted_until(times.begin(), times.end());
        if (unsorted != times.end())
            file_.fail(place + "/input",
                       "element " + std::to_string(unsorted - times.begin()) + ": must be later than the one before");
        interval.keyframes = times.size();
        pose_.seconds = std::max(pose_.seconds, times.back());
        const auto next = std::upper_bound(times.begin(), times.end(), time_);
        if (next == times.begin()) return interval;
        const double first = *(next - 1);
        interval.first = static_cast<std::size_t>(next - times.begin()) - 1;
        if (next == times.end()) return interval;
        interval.seconds = *next - first;
        interval.share = (time_ - first) / interval.seconds;
        return interval;
    }

    const GltfFile& file_;
    const tinygltf::Animation& animation_;
    const std::string place_; // of its samplers
    const double time_;
    GltfBudget& budget_;
    std::map<int, Interval> intervals_; // by the accessor of their times
    AnimationPose pose_;
};

} // namespace

std::size_t morphTargetCount(const tinygltf::Mesh& mesh) {
    std::size_t count = 0;
    for (const tinygltf::Primitive& primitive : mesh.primitives) count = std::max(count, primitive.targets.size());
    return count;
}

std::vector<std::string> animationNames(const GltfFile& file) {
    UniqueNames unique;
    std::vector<std::string> names;
    for (const tinygltf::Animation& animation : file.model.animations)
        names.push_back(unique.unique(animation.name, "animation", names.size()));
    return names;
}

AnimationPose poseAt(const GltfFile& file, const Moment& moment, GltfBudget& budget) {
    const auto animation = chosenAnimation(animationNames(file), moment);
    return animation ? Poser(file, *animation, moment.time, budget).run() : AnimationPose{};
}

} // namespace rt::scene
