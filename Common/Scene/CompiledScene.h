// The compiled scene: arrays of records, nothing else. What a kernel, CPU or GPU, sees of a scene.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include <glm/mat4x4.hpp>

#include "Common/Scene/SceneDesc.h"
#include "Common/Shared/Base/Features.h"
#include "Common/Shared/Base/Types.h"

namespace rt::scene {

// Produced by compileScene(), immutable afterwards, shared by everything that renders it. Every index in a record is valid;
// every number is finite; geometry 0 (the world) always exists. Arrays of what the scene does not use are empty.
struct CompiledScene {
    std::string id; // "cornell-box-lights", "white-spheres:500", or the file's name
    std::string title;
    std::uint64_t hash = 0; // of everything that affects the image except camera and settings

    std::uint32_t features = 0;

    std::vector<shared::Sphere> spheres;
    std::vector<shared::vec3> sphereMotions; // displacement over the shutter; empty, or one for each sphere
    std::vector<shared::Quad> quads;
    std::vector<shared::vec3> positions; // vertices
    std::vector<shared::vec3> normals;   // unit; see Mesh
    std::vector<shared::vec2> uvs;
    std::vector<shared::uvec3> triangles; // indices into positions, in the order of a space-filling curve per mesh
    std::vector<shared::Mesh> meshes;
    std::vector<std::uint32_t> triangleMesh; // mesh of each triangle
    std::vector<shared::Geometry> geometries;
    std::vector<shared::Instance> instances;

    std::vector<shared::Material> materials;
    std::vector<shared::Texture> textures;
    std::vector<shared::Image> images;
    std::vector<std::uint32_t> texels;
    std::vector<shared::vec3> perlinGradients;     // kPerlinSize a table
    std::vector<std::uint32_t> perlinPermutations; // 3 * kPerlinSize a table: x, y, z

    std::vector<shared::Medium> media;

    std::vector<shared::Light> lights;           // lights, then importance targets
    std::vector<shared::LightBound> lightBounds; // one for each light
    std::vector<shared::LightNode> lightNodes;   // the tree over more than kContributionLights lights
    std::vector<std::uint32_t> lightPlaces; // node * kLightNodeChildren + child, or kNone: of each of those lights,
                                            // then of each node, in its parent
    std::vector<float> skyCdf; // sky image: cdf of rows (height + 1), then of columns in each row (width + 1 each)

    shared::SceneGlobals globals{};

    CameraDesc camera;      // authored, in world units as authored (not relative to globals.origin)
    glm::dvec3 origin{0.0}; // globals.origin before rounding
    RenderDefaults defaults;
    std::vector<std::string> notices; // one line each: dropped primitives, stand-ins for missing assets
};

} // namespace rt::scene
