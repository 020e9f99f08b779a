#include "Common/App/Session/SceneOutput.h"

#include "Common/App/Session/Outputs.h"
#include "Common/App/Session/SceneImages.h"
#include "Common/Image/ImageIo.h"
#include "Common/Scene/Gltf/GltfWriter.h"
#include "Common/Scene/Json/SceneJson.h"
#include "Common/Scene/ModelFile.h"

namespace rt::app {

bool isSceneOutput(const std::string& file) {
    const std::string kind = scene::kindOfFile(file);
    return kind.empty() || kind == ".json" || scene::isGltfFile(file);
}

std::vector<std::string> writeScene(const std::string& file, const scene::SceneDesc& scene) {
    if (scene::isGltfFile(file)) return scene::writeGltf(scene, file, {makeTexelLoader(), image::toPng});
    writeText(file, scene::toJson(scene));
    return {};
}

} // namespace rt::app
