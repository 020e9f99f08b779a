// Files of glTF in which something moves, before black.
#pragma once
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "tests/unit/GltfBuilder.h"

namespace rt::scene {

// All times in seconds, all lengths in metres. The camera looks along -z at what is at z = 0; at that distance it sees
// from -kSeen to kSeen in x and in y.
inline constexpr double kCameraDistance = 10, kSeen = 1;

class MovingModel : public GltfBuilder {
  public:
    // A rectangle in the plane z = 0 around the origin that gives off a radiance of 1, in front, and reflects nothing.
    nlohmann::json lamp(float width, float height) {
        return rectangle(width, height, {{"pbrMetallicRoughness", black()}, {"emissiveFactor", {1, 1, 1}}});
    }
    // One that is a diffuse reflector of albedo 0.5 by default.
    nlohmann::json rectangle(float width, float height, const nlohmann::json& material) {
        const float x = width / 2, y = height / 2;
        const int positions =
            addAccessor(std::vector<float>{-x, -y, 0, x, -y, 0, x, y, 0, -x, -y, 0, x, y, 0, -x, y, 0}, "VEC3");
        return {{"attributes", {{"POSITION", positions}}}, {"material", add("materials", material)}};
    }
    int addCamera() {
        nlohmann::json perspective = {{"aspectRatio", 1}, {"znear", 0.1}};
        perspective["yfov"] = 2 * std::atan(kSeen / kCameraDistance);
        add("cameras", {{"type", "perspective"}, {"perspective", perspective}});
        return addNode({{"camera", 0}, {"translation", {0, 0, kCameraDistance}}});
    }
    int addLight(const std::vector<float>& position, float intensity) {
        json["extensionsUsed"] = {"KHR_lights_punctual"};
        json["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}, {"intensity", intensity}}};
        return addNode({{"translation", position}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
    }
    // From one value at 0 s to another at 1 s, of a node's "translation" or "rotation".
    void move(int node, const char* path, const std::vector<float>& from, const std::vector<float>& to) {
        std::vector<float> values = from;
        values.insert(values.end(), to.begin(), to.end());
        const nlohmann::json sampler = {{"input", addAccessor(std::vector<float>{0, 1}, "SCALAR")},
                                        {"output", addAccessor(values, from.size() == 3 ? "VEC3" : "VEC4")}};
        add("animations",
            {{"samplers", {sampler}}, {"channels", {{{"sampler", 0}, {"target", {{"node", node}, {"path", path}}}}}}});
    }

  private:
    static nlohmann::json black() {
        return {{"baseColorFactor", {0, 0, 0, 1}}, {"metallicFactor", 0}, {"roughnessFactor", 1}};
    }
};

// A lamp of width 0.5, as high as what is seen and more, that moves from x = -0.6 at 0 s to 0.6 at 1 s.
inline std::filesystem::path saveMovingLamp(const std::filesystem::path& file) {
    MovingModel model;
    const int lamp = model.addNode({{"mesh", model.addMesh(model.lamp(0.5f, 4))}});
    model.addCamera();
    model.move(lamp, "translation", {-0.6f, 0, 0}, {0.6f, 0, 0});
    return model.save(file);
}

} // namespace rt::scene
