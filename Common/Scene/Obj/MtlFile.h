// What an MTL file says, statement by statement.
#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace rt::scene {

// An image as a material refers to it.
struct MtlMap {
    std::string file;                     // as it is written, with any comment; empty: none
    glm::dvec2 offset{0, 0}, scale{1, 1}; // the place in the image is uv scale + offset
    bool isClamped = false;               // else repeated
    double strength = 1;                  // -bm, of bumps
    char channel = 0;                     // -imfchan: r g b m l z; 0: not said
    explicit operator bool() const { return !file.empty(); }
};

// What is not said is unset.
struct MtlMaterial {
    std::string name;                                               // as nameIn() has it
    std::optional<glm::dvec3> diffuse, specular, emission, filter;  // Kd, Ks, Ke, Tf
    std::optional<double> exponent, ior, opacity;                   // Ns, Ni, d or 1 - Tr
    std::optional<double> roughness, metallic, sheen;               // Pr, Pm, Ps: the PBR extension
    std::optional<double> clearcoat, clearcoatRoughness;            // Pc, Pcr
    std::optional<int> illumination;                                // illum
    MtlMap diffuseMap, specularMap, emissionMap, opacityMap;        // map_Kd, map_Ks, map_Ke, map_d
    MtlMap normalMap, bumpMap, roughnessMap, metallicMap, sheenMap; // norm, map_Bump or bump, map_Pr, map_Pm, map_Ps
    std::vector<std::string> leftOut; // what is said and not understood, as people call it
};

// Reads a file. Keywords may be in any case; those that are unknown count for nothing, as does what stands before the
// first material and materials without a name. A statement that cannot be understood is left out; the first of them is
// a notice, with file and line. Throws InputError where the file cannot be read.
std::vector<MtlMaterial> readMtl(const std::filesystem::path& path, std::vector<std::string>& notices);

} // namespace rt::scene
