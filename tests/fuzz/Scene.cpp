// Scene files: what is read can be written and read again.
#include "Common/Scene/Json/SceneJson.h"
#include "tests/fuzz/Fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace rt;
    const std::filesystem::path& folder = test::fuzzFolder().path();
    scene::SceneDesc scene;
    try {
        scene = scene::parseScene(std::string(test::textOf(data, size)), "f.json", folder);
    } catch (const InputError&) {
        return 0;
    }
    scene::parseScene(scene::toJson(scene), "again.json", folder); // an error is a find
    return 0;
}
