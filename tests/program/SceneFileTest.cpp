// Scene files from the command line: built-in scenes survive their export, and every kind of mistake in a file is one
// line and exit code 3.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

#include "tests/program/Program.h"

namespace rt::test {
namespace {

class SceneFile : public ProgramTest {
  protected:
    // A lit room of one quad, with `objects` and `more` members of the scene added.
    static std::string scene(const std::string& objects, const std::string& more = "") {
        return R"({"materials": {"white": {"type": "lambertian", "albedo": [0.5, 0.5, 0.5]}, "lamp": {"type": "emitter", "emission": [4, 4, 4]}},
                   "objects": [{"type": "quad", "corner": [-1, 2, -3], "edge_u": [2, 0, 0], "edge_v": [0, 0, 2],
                                "material": "lamp"})" +
               (objects.empty() ? "" : ", " + objects) + "]" + more + "}";
    }
    Outcome renderFile(const std::string& name, const std::string& content) const {
        writeFile(name, content);
        return render({"--scene", name, "--spp", "1"});
    }
};

// That every built-in scene is read back as it was written, bit for bit, the unit test BuiltinScenes proves; these have
// lights, motion, images and noise, media and instances, and counts, and take the way through files and flags.
TEST_F(SceneFile, BuiltinScenesSurviveTheirExport) {
    for (const std::string id : {"cornell-box-lights", "next-week-final", "many-lights:50"}) {
        const Arguments common = {"--width", "12", "--height", "8", "--spp", "2"};
        const Outcome exported = cpu({"--scene", id, "--export-scene", "scene.json"});
        ASSERT_EQ(exported.exitCode, 0) << id << ": " << exported.err;
        EXPECT_EQ(exported.out + exported.err, "") << id;
        const auto picture = [&](const std::string& source) {
            Arguments all = common;
            all.insert(all.end(), {"--scene", source});
            return pixels(all);
        };
        EXPECT_TRUE(picture(id) == picture("scene.json")) << id;
    }
}

TEST_F(SceneFile, ExportGoesThroughTheSameChecks) {
    EXPECT_TRUE(failsWith(cpu({"--scene", "nothing", "--export-scene", "a.json"}), 3, "nothing"));
    EXPECT_TRUE(failsWith(cpu({"--export-scene", "missing/a.json"}), 1, "missing/a.json"));
    ASSERT_EQ(cpu({"--scene", "cornell-box-lights", "--export-scene", "a.json"}).exitCode, 0);
    ASSERT_EQ(cpu({"--scene", "a.json", "--export-scene", "b.json"}).exitCode, 0);
    EXPECT_EQ(bytesOf("a.json"), bytesOf("b.json"));
}

// Means of blocks of 8 x 8 pixels of a picture as a PFM file of 32 x 32.
std::vector<double> blockMeans(const std::string& pfm) {
    constexpr std::size_t kSide = 32, kBlock = 8, kBlocks = kSide / kBlock;
    std::vector<float> values(3 * kSide * kSide);
    EXPECT_GT(pfm.size(), 4 * values.size());
    std::memcpy(values.data(), pfm.data() + pfm.size() - 4 * values.size(), 4 * values.size());
    std::vector<double> means(3 * kBlocks * kBlocks);
    for (std::size_t i = 0; i < values.size(); ++i) {
        const std::size_t c = i % 3, x = i / 3 % kSide, y = i / 3 / kSide;
        means[3 * (y / kBlock * kBlocks + x / kBlock) + c] += double(values[i]) / (kBlock * kBlock);
    }
    return means;
}

// The light of this box emits from its front alone, and stands just below the ceiling. Seeds give the spread: of 48
// differences none is beyond six standard errors and a hundredth, by which rough surfaces here and there may differ.
TEST_F(SceneFile, GltfShowsTheSameRoom) {
    constexpr int kSeeds = 8;
    ASSERT_EQ(cpu({"--scene", "rest-of-life-cornell-box", "--export-scene", "box.glb"}).exitCode, 0);
    std::vector<double> sums[2], squares[2];
    for (int seed = 0; seed < kSeeds; ++seed)
        for (const int i : {0, 1}) {
            const std::string source = i == 0 ? "rest-of-life-cornell-box" : "box.glb";
            const std::vector<double> means =
                blockMeans(pixels({"--scene", source, "--spp", "32", "--seed", std::to_string(seed + kSeeds * i)}));
            sums[i].resize(means.size());
            squares[i].resize(means.size());
            for (std::size_t k = 0; k < means.size(); ++k) {
                sums[i][k] += means[k] / kSeeds;
                squares[i][k] += means[k] * means[k] / kSeeds;
            }
        }
    for (std::size_t k = 0; k < sums[0].size(); ++k) {
        double variance = 0;
        for (const int i : {0, 1}) variance += (squares[i][k] - sums[i][k] * sums[i][k]) / (kSeeds - 1);
        EXPECT_NEAR(sums[1][k], sums[0][k], 6 * std::sqrt(std::max(variance, 0.0)) + 0.01 * sums[0][k]) << k;
    }
}

TEST_F(SceneFile, GltfIsWrittenByTheEnding) {
    writeFile("room.json", scene(R"({"type": "sphere", "center": [0, 0, -2], "radius": 0.5, "material": "white"})"));
    for (const char* file : {"a b.glb", "a b.gltf"}) {
        const Outcome exported = cpu({"--scene", "room.json", "--export-scene", file});
        EXPECT_EQ(exported.exitCode, 0) << exported.err;
        EXPECT_EQ(render({"--scene", file, "--spp", "1"}).exitCode, 0);
    }
    EXPECT_TRUE(std::filesystem::exists(path("a b.bin")));
    EXPECT_TRUE(failsWith(cpu({"--export-scene", "missing/a.glb"}), 1, "missing/a.glb"));
    EXPECT_TRUE(failsWith(cpu({"--export-scene", "a.obj"}), 2, ".json, .glb or .gltf"));
    EXPECT_FALSE(std::filesystem::exists(path("a.obj")));
}

TEST_F(SceneFile, TheFileDecidesTheAspect) {
    writeFile("wide.json", scene("", R"(, "render": {"aspect": 2})"));
    ASSERT_EQ(cpu({"-q", "--scene", "wide.json", "--width", "32", "--spp", "1", "--stats", "s.json"}).exitCode, 0);
    EXPECT_EQ(jsonOf("s.json")["height"], 16);
}

TEST_F(SceneFile, Mistakes) {
    EXPECT_EQ(renderFile("good.json", scene("")).exitCode, 0);
    const std::pair<const char*, std::string> cases[] = {
        {"empty", ""},
        {"truncated", scene("").substr(0, 200)},
        {"not-json", "P6 32 32 255"},
        {"array", "[1, 2, 3]"},
        {"no-objects", "{}"},
        {"number", scene(R"({"type": "sphere", "center": [0, 0, 0], "radius": 1e999, "material": "white"})")},
        {"negative-radius", scene(R"({"type": "sphere", "center": [0, 0, 0], "radius": -1, "material": "white"})")},
        {"wrong-type", scene(R"({"type": "sphere", "center": "origin", "radius": 1, "material": "white"})")},
        {"two-numbers", scene(R"({"type": "sphere", "center": [0, 0], "radius": 1, "material": "white"})")},
        {"unknown-key", scene(R"({"type": "sphere", "centre": [0, 0, 0], "radius": 1, "material": "white"})")},
        {"unknown-shape", scene(R"({"type": "teapot", "material": "white"})")},
        {"unknown-material", scene(R"({"type": "sphere", "center": [0, 0, 0], "radius": 1, "material": "gold"})")},
        {"zero-area", scene(R"({"type": "quad", "corner": [0, 0, 0], "edge_u": [1, 0, 0], "edge_v": [2, 0, 0],
                                "material": "white"})")},
        {"empty-mesh", scene(R"({"type": "mesh", "positions": [], "triangles": [], "material": "white"})")},
        {"index", scene(R"({"type": "mesh", "positions": [0, 0, 0, 1, 0, 0, 0, 1, 0], "triangles": [0, 1, 3],
                            "material": "white"})")},
        {"no-such-mesh", scene(R"({"type": "mesh", "file": "missing.obj", "material": "white"})")},
        {"no-such-image", scene("", R"(, "textures": {"map": {"type": "image", "file": "missing.png"}})")},
        {"cycle", scene(R"({"type": "instance", "prototype": "a"})",
                        R"(, "prototypes": {"a": [{"type": "instance", "prototype": "b"}],
                                            "b": [{"type": "instance", "prototype": "a"}]})")},
        {"camera", scene("", R"(, "camera": {"look_from": [0, 0, 0], "look_at": [0, 0, 0]})")},
        {"fov", scene("", R"(, "camera": {"vertical_fov": 180})")},
    };
    for (const auto& [name, content] : cases) {
        const std::string file = name + std::string(".json");
        EXPECT_TRUE(failsWith(renderFile(file, content), 3, file)) << name;
    }
    // Deep nesting must not exhaust the stack.
    EXPECT_TRUE(failsWith(renderFile("deep.json", std::string(200'000, '[')), 3, "deep.json"));
}

TEST_F(SceneFile, NestedCheckers) {
    const auto nested = [](int depth) {
        std::string textures = R"("t0": {"type": "noise", "kind": "smooth"})";
        for (int i = 1; i <= depth; ++i)
            textures += ", \"t" + std::to_string(i) +
                        R"(": {"type": "checker", "scale": 0.3, "odd": [1, 1, 1], "even": "t)" + std::to_string(i - 1) +
                        "\"}";
        return R"({"textures": {)" + textures + R"(}, "materials": {"squares": {"type": "lambertian", "albedo": "t)" +
               std::to_string(depth) + R"("}},
            "objects": [{"type": "sphere", "center": [0, 0, 0], "radius": 1, "material": "squares"}]})";
    };
    EXPECT_EQ(renderFile("eight.json", nested(8)).exitCode, 0);
    EXPECT_TRUE(failsWith(renderFile("nine.json", nested(9)), 3, "nine.json: /textures/t"));
    EXPECT_TRUE(failsWith(renderFile("many.json", nested(39)), 3, "many.json: /textures/t"));
}

TEST_F(SceneFile, ObjFiles) {
    EXPECT_EQ(renderFile("good.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").exitCode, 0);
    EXPECT_TRUE(failsWith(renderFile("empty.obj", ""), 3, "empty.obj"));
    EXPECT_TRUE(failsWith(renderFile("no-faces.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n"), 3, "no-faces.obj"));
    EXPECT_TRUE(failsWith(renderFile("index.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n"), 3, "index.obj"));
    EXPECT_TRUE(failsWith(renderFile("nan.obj", "v nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"), 3, "nan.obj:1"));
    EXPECT_TRUE(failsWith(renderFile("short.obj", "v 0 0 0\nv 1 0\nv 0 1 0\nf 1 2 3\n"), 3, "short.obj:2"));
    EXPECT_TRUE(failsWith(renderFile("word.obj", "v 0 0 0\r\nv 1 0 0\r\nv 0 one 0\r\nf 1 2 3\r\n"), 3, "word.obj:3"));
}

} // namespace
} // namespace rt::test
