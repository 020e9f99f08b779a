// Meshes: an input is f.obj as scenes name it, or, where a byte is 0, f.obj as a scene of its own and, after that byte,
// f.mtl.
#include <algorithm>

#include "Common/App/Session/SceneSource.h"
#include "Common/Scene/Obj/ObjLoader.h"
#include "tests/fuzz/Fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace rt;
    const std::string_view text = test::textOf(data, size);
    const std::size_t end = std::min(text.find('\0'), size);
    const auto mesh = test::fuzzFolder().write("f.obj", text.substr(0, end));
    if (end == size) {
        test::readOrRefuse([&] { scene::loadObj(mesh, false); });
        return 0;
    }
    test::fuzzFolder().write("f.mtl", text.substr(end + 1));
    test::readOrRefuse([&] { app::compile(scene::loadObjScene(mesh), true); });
    return 0;
}
