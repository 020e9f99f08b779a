// Scenes of pbrt that tests read.
#pragma once
#include <fstream>
#include <string>
#include <variant>

#include "Common/Scene/Affine.h"
#include "Common/Scene/Pbrt/PbrtLoader.h"
#include "tests/TempFolder.h"

namespace rt::test {

// One of tests/data/pbrt.
inline scene::SceneDesc pbrtScene(const std::string& name) {
    return scene::loadPbrtScene(RT_TEST_DATA_DIR "/pbrt/" + name + ".pbrt");
}

// Files beside each other.
class PbrtFolder {
  public:
    std::filesystem::path write(const std::string& name, const std::string& text) const {
        std::filesystem::path path = folder_ / name;
        std::filesystem::create_directories(path.parent_path());
        std::ofstream(path, std::ios::binary) << text;
        return path;
    }
    scene::SceneDesc load(const std::string& text) const { return scene::loadPbrtScene(write("a.pbrt", text)); }
    const std::filesystem::path& path() const { return folder_.path(); }

  private:
    TempFolder folder_;
};

// The i-th group of a scene: where it stands, and the only shape in it.
struct PbrtPlaced {
    scene::Affine toWorld;
    scene::ObjectDesc::Shape shape;
};
inline PbrtPlaced placed(const std::vector<scene::ObjectDesc>& objects, std::size_t i) {
    const auto& group = std::get<scene::GroupDesc>(objects.at(i).shape);
    return {toAffine(group.transform), group.objects.at(0).shape};
}
template <class Shape>
Shape shapeOf(const scene::SceneDesc& scene, std::size_t i) {
    return std::get<Shape>(placed(scene.objects, i).shape);
}
template <class Shape>
const scene::MaterialDesc& materialOf(const scene::SceneDesc& scene, std::size_t i) {
    return scene.materials.at(shapeOf<Shape>(scene, i).material);
}
template <class Mesh = scene::MeshData>
const Mesh& meshOf(const scene::SceneDesc& scene, std::size_t i) {
    const auto& group = std::get<scene::GroupDesc>(scene.objects.at(i).shape);
    const auto& mesh = std::get<scene::MeshDesc>(group.objects.at(0).shape);
    return *std::get<scene::Boxed<Mesh>>(mesh.source);
}

inline bool hasNotice(const scene::SceneDesc& scene, const std::string& part) {
    for (const std::string& notice : scene.notices)
        if (notice.find(part) != notice.npos) return true;
    return false;
}

} // namespace rt::test
