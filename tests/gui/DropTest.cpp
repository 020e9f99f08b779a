// Files that are dropped on the window.
#include <fstream>

#include "tests/gui/WindowTest.h"

namespace rt::test {
namespace {

class DropTest : public WindowTest {};
INSTANTIATE_TEST_SUITE_P(, DropTest, kFirstProgram, nameOfProgram);
INSTANTIATE_TEST_SUITE_P(Nightly, DropTest, kSecondProgram, nameOfProgram);

TEST_P(DropTest, GoodFilesOpenAndBadOnesLeaveTheScene) {
    std::ofstream(folder_ / "bad.json") << R"({"version": 1, "objects": 12})";
    std::ofstream(folder_ / "bad.obj") << "v 0 0 x\nf 1 2 3\n";
    std::ofstream(folder_ / "notes.txt") << "no scene";
    std::ofstream(folder_ / "no texture.json")
        << R"({"version": 1, "textures": {"t": {"type": "image", "file": "gone.png"}},
        "materials": {"m": {"type": "lambertian", "albedo": "t"}},
        "objects": [{"type": "sphere", "center": [0, 0, -3], "radius": 1, "material": "m"}]})";
    const std::string triangle = (folder_ / "triangle.obj").string();
    std::ofstream(triangle) << "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    const std::string good = writeScene("h\xc3\xa4user & mehr.json", "Just dropped").string();
    start();
    ASSERT_FALSE(HasFatalFailure());
    const std::string before = title();
    for (const char* bad : {"bad.json", "bad.obj", "notes.txt", "no texture.json", "missing.json", "."}) {
        const std::string file = (folder_ / bad).string();
        ASSERT_TRUE(drop({file})) << bad;
        ASSERT_TRUE(eventually([&] { return !isRunning() || log().find(file) != std::string::npos; })) << bad << log();
        EXPECT_EQ(title(), before) << bad;
    }
    ASSERT_TRUE(drop({good}));
    EXPECT_TRUE(eventually([&] { return title().find("Just dropped") == 0; })) << title() << log();
    ASSERT_TRUE(drop({triangle, good})); // of several the first one is taken
    EXPECT_TRUE(eventually([&] { return title().find("triangle.obj") == 0; })) << title() << log();
    using Files = std::vector<std::string>;
    EXPECT_TRUE(eventually([&] { return settings()["recent"] == Files{triangle, good}; })) << settings()["recent"];
    std::ofstream(triangle) << "v 0 0 x\n"; // no longer loads
    ASSERT_TRUE(drop({triangle}));
    EXPECT_TRUE(eventually([&] { return log().find(triangle) != std::string::npos; })) << log();
    const std::string gltf = (folder_ / "model.gltf").string(); // a triangle, its nine floats in base64
    std::ofstream(gltf) << R"({"asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 3}],
        "bufferViews": [{"buffer": 0, "byteLength": 36}], "buffers": [{"byteLength": 36, "uri":
        "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]})";
    ASSERT_TRUE(drop({gltf}));
    EXPECT_TRUE(eventually([&] { return title().find("model.gltf") == 0; })) << title() << log();
    expectCleanEnd();
    EXPECT_EQ(settings()["recent"], (Files{gltf, good}));
}

} // namespace
} // namespace rt::test
