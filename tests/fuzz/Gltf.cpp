// Files of glTF, as text or binary, with their images: read, compiled, and written as a scene that is read again.
#include "Common/App/Session/SceneSource.h"
#include "Common/Scene/Gltf/GltfLoader.h"
#include "Common/Scene/Json/SceneJson.h"
#include "tests/fuzz/Fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace rt;
    const auto file = test::fuzzFolder().write("f.gltf", test::textOf(data, size));
    scene::SceneDesc scene;
    try {
        scene = scene::loadGltfScene(file);
    } catch (const InputError&) {
        return 0;
    }
    scene::parseScene(scene::toJson(scene), "again.json", test::fuzzFolder().path()); // an error is a find
    test::readOrRefuse([&] { app::compile(scene, true); });
    return 0;
}
