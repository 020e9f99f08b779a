// MaterialX documents: read, each material written and read again.
#include <string>
#include <vector>

#include "Common/Scene/MaterialX/MaterialXLoader.h"
#include "Common/Scene/MaterialX/MaterialXWriter.h"
#include "tests/fuzz/Fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace rt;
    const std::filesystem::path& folder = test::fuzzFolder().path();
    scene::SceneDesc scene;
    try {
        scene = scene::parseMaterialX(test::textOf(data, size), "f.mtlx", folder);
    } catch (const InputError&) {
        return 0;
    }
    for (const auto& [name, material] : scene.materials) { // an error is a find
        std::vector<std::string> notices;
        scene::parseMaterialX(scene::toMaterialX(scene, name, folder, notices), "again.mtlx", folder);
    }
    return 0;
}
