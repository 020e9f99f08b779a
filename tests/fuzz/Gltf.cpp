// Files of glTF, as text or binary: read, written as a scene that is read again, and the images inside decoded. They
// are not compiled, as the tables of principled materials take a hundred times as long as the rest: scenes have their
// own target.
#include <variant>

#include "Common/Image/ImageIo.h"
#include "Common/Scene/Gltf/GltfFile.h"
#include "Common/Scene/Gltf/GltfLoader.h"
#include "Common/Scene/Json/SceneJson.h"
#include "tests/fuzz/Fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace rt;
    const auto file = test::fuzzFolder().write("f.gltf", test::textOf(data, size));
    scene::SceneDesc scene;
    try {
        scene = scene::loadGltfScene(file, {"", 0.25}); // between keyframes
    } catch (const InputError&) {
        return 0;
    }
    const scene::GltfImages images(file);
    bool namesFiles = false;
    for (const auto& [name, texture] : scene.textures) {
        const auto* image = std::get_if<scene::ImageTexture>(&texture);
        namesFiles = namesFiles || (image && !image->image);
        if (image && image->image)
            test::readOrRefuse([&] { image::decodeTexels(images.encoded(*image->image), std::string("f.gltf")); });
    }
    // An error is a find, but for images in other files, which are not there.
    if (!namesFiles) scene::parseScene(scene::toJson(scene), "again.json", test::fuzzFolder().path());
    return 0;
}
