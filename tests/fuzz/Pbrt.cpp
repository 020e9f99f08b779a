// Scenes of pbrt: an input is f.pbrt, which may include itself and a.ply, or, behind a byte that is 0, a.ply. Scenes
// are written and read again, not compiled: scenes have their own target.
#include "Common/Scene/Json/SceneJson.h"
#include "Common/Scene/Pbrt/PbrtLoader.h"
#include "tests/fuzz/Fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace rt;
    const std::string_view text = test::textOf(data, size);
    const bool isMesh = text.starts_with('\0');
    test::fuzzFolder().write("a.ply", isMesh ? text.substr(1) : "ply\nformat ascii 1.0\nend_header\n");
    const auto file = test::fuzzFolder().write(
        "f.pbrt", isMesh ? "WorldBegin\nShape \"plymesh\" \"string filename\" \"a.ply\"" : text);
    scene::SceneDesc scene;
    try {
        scene = scene::loadPbrtScene(file);
    } catch (const InputError&) {
        return 0;
    }
    // An error is a find, but for images in other files, which are not there.
    if (scene.textures.empty()) scene::parseScene(scene::toJson(scene), "again.json", test::fuzzFolder().path());
    return 0;
}
