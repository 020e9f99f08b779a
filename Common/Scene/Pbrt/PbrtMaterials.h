// Materials of pbrt files as those of a scene: docs/pbrt.md says what becomes of each.
#pragma once
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <glm/vec3.hpp>

#include "Common/Scene/Pbrt/PbrtFiles.h"
#include "Common/Scene/Pbrt/PbrtNotices.h"
#include "Common/Scene/Pbrt/PbrtParameters.h"
#include "Common/Scene/Pbrt/PbrtTextures.h"
#include "Common/Scene/SceneDesc.h"
#include "Common/Scene/UniqueNames.h"

namespace rt::scene {

// What a shape adds to its material.
struct PbrtSurface {
    glm::dvec3 emission{0, 0, 0};
    std::string emissionTexture;
    Sides sides = Sides::Front;
    NumberOrTexture opacity;
    bool operator==(const PbrtSurface&) const = default;
};

class PbrtMaterials {
  public:
    // All must outlive this.
    PbrtMaterials(SceneDesc& scene, PbrtFiles& files, PbrtTextures& textures, PbrtNotices& notices)
        : scene_(scene), files_(files), textures_(textures), notices_(notices) {}

    // One that has no name in the file, or one that has: what shapes refer to. Nothing is made before it is used.
    int add(const std::string& kind, PbrtParameters parameters);
    void addNamed(const std::string& name, PbrtParameters parameters);
    int named(const std::string& name, const PbrtPlace& place); // may be defined later

    // Nothing is seen of it but what is inside.
    bool isInterface(int material);
    bool needsTangents(int material); // of meshes
    // The scene's name of a material with what a shape adds to it.
    std::string use(int material, const PbrtSurface& surface);
    static constexpr int kUsual = 0; // of shapes before any Material

  private:
    struct Entry {
        std::string kind, name; // name: empty, or that of the file
        PbrtParameters parameters;
        bool isMade = false, isInterface = false;
        MaterialDesc material;
        std::vector<std::pair<PbrtSurface, std::string>> uses; // with what shapes add, and the scene's name
    };

    Entry& made(int material);
    void make(Entry& entry, int depth);
    MaterialDesc diffuse(const PbrtParameters& parameters, double usual);
    MaterialDesc coatedDiffuse(const PbrtParameters& parameters);
    MaterialDesc conductor(const PbrtParameters& parameters, const std::string& prefix);
    MaterialDesc coatedConductor(const PbrtParameters& parameters);
    MaterialDesc dielectric(const PbrtParameters& parameters, bool isThin);
    MaterialDesc standIn(const std::string& kind, const PbrtParameters& parameters);
    void mix(Entry& entry, int depth);
    glm::dvec3 metalColor(const PbrtParameters& parameters, const std::string& prefix);
    double indexOf(const PbrtParameters& parameters, const std::string& name, double usual);
    double roughness(const PbrtParameters& parameters, const std::string& prefix);
    void addNormals(const PbrtParameters& parameters, MaterialDesc& material);

    SceneDesc& scene_;
    PbrtFiles& files_;
    PbrtTextures& textures_;
    PbrtNotices& notices_;
    std::vector<std::unique_ptr<Entry>> entries_;
    std::map<std::string, int> named_;
    UniqueNames names_;
};

} // namespace rt::scene
