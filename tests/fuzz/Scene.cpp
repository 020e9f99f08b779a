// Scene files: what is read can be written, is then read again, and can be compiled or is refused. The images that
// seeds name lie beside the scene.
#include "Common/App/Session/SceneSource.h"
#include "Common/Scene/Json/SceneJson.h"
#include "tests/fuzz/Fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace rt;
    static const auto image = test::fuzzFolder().write("a.pfm", std::string("PF\n1 1\n-1\n") + std::string(12, '\0'));
    static const auto mesh = test::fuzzFolder().write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    const std::filesystem::path& folder = test::fuzzFolder().path();
    scene::SceneDesc scene;
    try {
        scene = scene::parseScene(test::textOf(data, size), "f.json", folder);
    } catch (const InputError&) {
        return 0;
    }
    scene::parseScene(scene::toJson(scene), "again.json", folder); // an error is a find
    test::readOrRefuse([&] { app::compile(scene, true); });
    return 0;
}
