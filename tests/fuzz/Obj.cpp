// A mesh and its materials: an input is f.obj and, after the first byte 0, f.mtl.
#include <algorithm>

#include "Common/App/Session/SceneSource.h"
#include "Common/Scene/Obj/ObjLoader.h"
#include "tests/fuzz/Fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace rt;
    const std::string_view text = test::textOf(data, size);
    const std::size_t end = std::min(text.find('\0'), size);
    const auto mesh = test::fuzzFolder().write("f.obj", text.substr(0, end));
    test::fuzzFolder().write("f.mtl", text.substr(std::min(end + 1, size)));
    test::readOrRefuse([&] { scene::loadObj(mesh, false); });
    test::readOrRefuse([&] { app::compile(scene::loadObjScene(mesh), true); });
    return 0;
}
