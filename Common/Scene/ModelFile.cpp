#include "Common/Scene/ModelFile.h"

#include <map>

#include "Common/Core/TextSearch.h"
#include "Common/Scene/Obj/ObjLoader.h"
#include "Common/Scene/Pbrt/PbrtLoader.h"
#include "Common/Scene/Studio.h"

namespace rt::scene {

namespace {

using LoadModel = SceneDesc (*)(const std::filesystem::path&, const Moment&);

SceneDesc loadObjAlone(const std::filesystem::path& path, const Moment& moment) {
    SceneDesc scene = loadObjScene(path);
    noticeStandstill(moment, scene.notices);
    return scene;
}

SceneDesc loadPbrt(const std::filesystem::path& path, const Moment& moment) {
    SceneDesc scene = loadPbrtScene(path);
    noticeStandstill(moment, scene.notices);
    return scene;
}

const std::map<std::string, LoadModel>& modelLoaders() {
    static const std::map<std::string, LoadModel> loaders = {{".gltf", loadGltfScene},
                                                             {".glb", loadGltfScene},
                                                             {".obj", loadObjAlone},
                                                             {".pbrt", loadPbrt},
                                                             {".pbrt.gz", loadPbrt}};
    return loaders;
}

} // namespace

std::string kindOfFile(const std::filesystem::path& path) {
    const std::string kind = lowerCase(path.extension().string());
    return kind == ".gz" ? kindOfFile(path.stem()) + kind : kind;
}

bool isModelFile(const std::filesystem::path& path) {
    return modelLoaders().contains(kindOfFile(path));
}

bool isGltfFile(const std::filesystem::path& path) {
    const std::string kind = kindOfFile(path);
    return kind == ".gltf" || kind == ".glb";
}

SceneDesc loadModelFile(const std::filesystem::path& path, const Moment& moment) {
    if (isGltfFile(path)) return AnimatedModel(path).at(moment);
    SceneDesc scene = loadModelAlone(path, moment);
    const bool saysItsLight = kindOfFile(path) != ".obj"; // pbrt does, and be it none
    if (!saysItsLight) addStudioIfUnlit(scene, boundsOfMeshes(scene));
    return scene;
}

SceneDesc loadModelAlone(const std::filesystem::path& path, const Moment& moment) {
    return modelLoaders().at(kindOfFile(path))(path, moment);
}

AnimatedModel::Start AnimatedModel::startOf(const SceneDesc& scene, const std::string& animation) {
    return {animation, scene.camera, boundsOfMeshes(scene), bringsLight(scene)};
}

SceneDesc AnimatedModel::at(const Moment& moment) {
    const bool isKnown = start_ && start_->animation == moment.animation;
    if (!isKnown && moment.time != 0) start_ = startOf(file_.at({moment.animation}), moment.animation);
    SceneDesc scene = file_.at(moment);
    if (!isKnown && moment.time == 0) start_ = startOf(scene, moment.animation);
    if (scene.cameras.empty()) scene.camera = start_->camera;
    if (!start_->bringsLight) addStudio(scene, start_->bounds);
    return scene;
}

} // namespace rt::scene
