// Scenes for tests of the compiler, and what they compare.
#pragma once
#include <cmath>
#include <string>
#include <utility>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "Common/Core/Error.h"
#include "Common/Scene/Builtin/SceneBuilder.h"
#include "Common/Scene/Compiler/SceneCompiler.h"
#include "tests/unit/Oracles.h"

namespace rt::scene {

inline SceneDesc withMaterials() {
    SceneDesc scene;
    scene.id = "test";
    scene.materials = {{"matte", lambertian(0.5, 0.5, 0.5)}, {"glass", glass(1.5)}, {"lamp", emitter({1, 2, 4})}};
    return scene;
}

inline GroupDesc group(Transform transform, ObjectDesc::Shape object) {
    GroupDesc group;
    group.transform = std::move(transform);
    group.objects.push_back({std::move(object)});
    return group;
}

inline glm::dvec3 rotatedY(const glm::dvec3& p, double degrees) {
    const double c = std::cos(degrees * test::kPi / 180), s = std::sin(degrees * test::kPi / 180);
    return {c * p.x + s * p.z, p.y, -s * p.x + c * p.z};
}

inline void expectNear(const glm::dvec3& a, const glm::dvec3& b, double tolerance) {
    EXPECT_LE(glm::length(a - b), tolerance)
        << a.x << ' ' << a.y << ' ' << a.z << " and " << b.x << ' ' << b.y << ' ' << b.z;
}

inline std::string errorOf(const SceneDesc& scene, const CompileOptions& options = {}) {
    try {
        compileScene(scene, options);
    } catch (const InputError& error) {
        return error.what();
    }
    return "no error";
}

} // namespace rt::scene
