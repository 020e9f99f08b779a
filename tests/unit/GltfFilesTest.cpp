// Where the bytes of glTF are: chunks, files beside, data URIs; which of them may be missing.
#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "Common/App/Session/SceneSource.h"
#include "Common/Core/Error.h"
#include "Common/Core/ReadFile.h"
#include "Common/Scene/CompiledScene.h"
#include "Common/Scene/Gltf/GltfFile.h"
#include "Common/Scene/Gltf/GltfLoader.h"
#include "Common/Scene/Gltf/GltfUri.h"
#include "tests/TempFolder.h"
#include "tests/unit/GltfBuilder.h"

namespace rt::scene {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

// The corners (0,0,0), (1,0,0), (0,1,0) as floats.
const std::string kCorners = "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA";

std::string contentOf(const fs::path& path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

std::string word(std::size_t value) {
    std::string bytes;
    for (int i = 0; i < 4; ++i) bytes += static_cast<char>(value >> 8 * i & 0xff);
    return bytes;
}

class GltfFiles : public testing::Test {
  protected:
    GltfFiles() { gltf.addNode({{"mesh", gltf.addMesh(gltf.triangle())}}); }

    // A file of the triangle whose buffer is this URI.
    fs::path withBuffer(const std::string& uri, std::size_t byteLength = 36) const {
        json document = {{"asset", {{"version", "2.0"}}},
                         {"buffers", {{{"byteLength", byteLength}, {"uri", uri}}}},
                         {"bufferViews", {{{"buffer", 0}, {"byteLength", 36}}}},
                         {"accessors", {{{"bufferView", 0}, {"componentType", 5126}, {"type", "VEC3"}, {"count", 3}}}},
                         {"meshes", {{{"primitives", {{{"attributes", {{"POSITION", 0}}}}}}}}},
                         {"nodes", {{{"mesh", 0}}}},
                         {"scenes", {{{"nodes", {0}}}}}};
        GltfBuilder::write(folder / "u.gltf", document.dump());
        return folder / "u.gltf";
    }
    static std::vector<glm::dvec3> positions(const fs::path& path) {
        const SceneDesc scene = loadGltfScene(path);
        return std::get<Boxed<MeshData>>(std::get<MeshDesc>(scene.objects.at(0).shape).source)->positions;
    }
    static std::string errorOf(const fs::path& path) {
        try {
            loadGltfScene(path);
            return "was read";
        } catch (const InputError& error) {
            EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
            return error.what();
        }
    }
    void expectError(const fs::path& path, const std::string& part) const {
        const std::string error = errorOf(path);
        EXPECT_NE(error.find(part), std::string::npos) << error;
        EXPECT_NE(error.find(path.filename().string()), std::string::npos) << error;
    }

    test::TempFolder folder;
    GltfBuilder gltf;
    const std::vector<glm::dvec3> corners{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
};

TEST_F(GltfFiles, BuffersMayBeLongerThanTheyAreUsed) {
    const fs::path file = gltf.saveWithBuffer(folder / "a.gltf", "a.bin", folder / "a.bin");
    GltfBuilder::write(folder / "a.bin", contentOf(folder / "a.bin") + "surplus");
    EXPECT_EQ(positions(file), corners);
    EXPECT_EQ(positions(withBuffer("data:;base64," + kCorners + "AAAA")), corners);
    GltfBuilder::write(folder / "a.bin", "short");
    expectError(file, "/buffers/0/byteLength: 60: must be at most what \"a.bin\" has, 5 bytes");
    expectError(withBuffer("data:;base64," + kCorners, 40), "byteLength: 40: must be at most what the data URI has");
    expectError(withBuffer("data:;base64,"),
                "/buffers/0/byteLength: 36: must be at most what the data URI has, 0 bytes");
}

TEST_F(GltfFiles, ChunksOfBinaryFiles) {
    const std::string whole = gltf.binary();
    const auto chunked = [&](const std::string& chunks) { // behind the JSON
        const std::size_t text = static_cast<unsigned char>(whole[12]) + 256u * static_cast<unsigned char>(whole[13]);
        const std::string content = whole.substr(0, 20 + text) + chunks;
        GltfBuilder::write(folder / "a.glb", content.substr(0, 8) + word(content.size()) + content.substr(12));
        return folder / "a.glb";
    };
    const std::size_t text = static_cast<unsigned char>(whole[12]) + 256u * static_cast<unsigned char>(whole[13]);
    const std::string binary = whole.substr(20 + text), other = word(4) + "OTHR" + "abcd";
    EXPECT_EQ(positions(chunked(binary)), corners);
    EXPECT_EQ(positions(chunked(other + binary + other)), corners);
    EXPECT_EQ(positions(chunked(binary + "tail")), corners);
    expectError(chunked(word(0) + std::string("BIN\0", 4)),
                "/buffers/0/byteLength: 60: must be at most what the binary");
    expectError(chunked(other), "/bufferViews/0: its buffer has no uri");
    expectError(chunked(word(1u << 30) + std::string("BIN\0", 4)), "ends beyond the file");
    expectError(chunked(word(0xfffffff8u) + "OTHR"), "ends beyond the file");
}

TEST_F(GltfFiles, EmptyBinaryChunksOfFilesThatNeedNone) {
    json document = json::parse(contentOf(withBuffer("data:application/gltf-buffer;base64," + kCorners)));
    for (const bool hasEmptyBuffer : {false, true}) {
        if (hasEmptyBuffer) document["buffers"].push_back({{"byteLength", 0}});
        std::string text = document.dump();
        while (text.size() % 4 != 0) text += ' ';
        const std::string chunks = word(text.size()) + "JSON" + text + word(0) + std::string("BIN\0", 4);
        GltfBuilder::write(folder / "a.glb", "glTF" + word(2) + word(12 + chunks.size()) + chunks);
        EXPECT_EQ(positions(folder / "a.glb"), corners);
    }
}

// RFC 3986: what is no escape stands for itself.
TEST_F(GltfFiles, NamesInUris) {
    const char* const names[][2] = {
        {"a+b.bin", "a+b.bin"},          {"a%2Bb.bin", "a+b.bin"},   {"a%20b.bin", "a b.bin"},
        {"a b.bin", "a b.bin"},          {"50%.bin", "50%.bin"},     {"50%25.bin", "50%.bin"},
        {"%2520.bin", "%20.bin"},        {"%zz.bin", "%zz.bin"},     {"in/../c.bin", "c.bin"},
        {"./in/d.bin", "in/d.bin"},      {"in%2Fe.bin", "in/e.bin"}, {"%C3%A4.bin", "\xc3\xa4.bin"},
        {"\xc3\xa4.bin", "\xc3\xa4.bin"}};
    fs::create_directories(folder / "in");
    for (const auto& [uri, name] : names) {
        SCOPED_TRACE(uri);
        EXPECT_EQ(besideGltf(folder / "a.gltf", uri), (folder / name).lexically_normal());
        const fs::path file = gltf.saveWithBuffer(folder / "a.gltf", uri, folder / name);
        EXPECT_EQ(positions(file), corners);
        fs::remove(folder / name);
        EXPECT_NE(errorOf(file), "was read");
    }
}

TEST_F(GltfFiles, QueriesAndFragmentsAreNoPartOfAName) {
    for (const char* uri : {"a.bin?v=1", "a.bin#part", "a.bin?x#y", "a%2Ebin?%20"}) {
        SCOPED_TRACE(uri);
        EXPECT_EQ(positions(gltf.saveWithBuffer(folder / "a.gltf", uri, folder / "a.bin")), corners);
    }
    fs::remove(folder / "a.bin");
    const fs::path file = gltf.saveWithBuffer(folder / "a.gltf", "a#1.bin", folder / "a#1.bin");
    EXPECT_EQ(positions(file), corners) << "unless it is one, as programs write without escapes";
}

TEST_F(GltfFiles, NamesInOtherCaseAreFound) {
    const fs::path file = gltf.saveWithBuffer(folder / "a.gltf", "SCENE.bin", folder / "Scene.BIN");
    if (!fs::exists(folder / "SCENE.bin")) { // else the system takes no notice of case
        const GltfFile read = readGltf(file);
        ASSERT_EQ(read.notices.size(), 1u);
        EXPECT_NE(read.notices[0].find("SCENE.bin: there is no such file; read: Scene.BIN"), std::string::npos);
    }
    EXPECT_EQ(positions(file), corners);
}

// Against the specification, but nothing depends on them.
TEST_F(GltfFiles, WhatHasNoElementsMayLieUnused) {
    const fs::path file = withBuffer("data:;base64," + kCorners);
    json document = json::parse(contentOf(file));
    document["bufferViews"].push_back({{"buffer", 0}, {"byteLength", 0}});
    document["accessors"].push_back({{"componentType", 5126}, {"count", 0}, {"type", "VEC3"}});
    const std::size_t none = document["accessors"].size() - 1;
    GltfBuilder::write(file, document.dump());
    EXPECT_EQ(positions(file), corners);
    json primitive = {{"attributes", {{"POSITION", none}, {"NORMAL", none}}}};
    document["meshes"][0]["primitives"].push_back(primitive);
    GltfBuilder::write(file, document.dump());
    const SceneDesc scene = loadGltfScene(file);
    EXPECT_EQ(std::count_if(scene.notices.begin(), scene.notices.end(),
                            [](const std::string& n) { return n.find("1 primitive") == 0; }),
              1);
}

TEST_F(GltfFiles, WhatIsNoRelativePathIsRefused) {
    for (const char* uri :
         {"", "/etc/a.bin", "%2Fetc/a.bin", "file:a.bin", "http://a.b/c.bin", "a%00.bin", "C:/a.bin"}) {
        SCOPED_TRACE(uri);
        EXPECT_THROW(besideGltf(folder / "a.gltf", uri), InputError);
        expectError(withBuffer(uri), "must be the relative path of a file");
    }
}

TEST_F(GltfFiles, BuffersElsewhereAreRefusedWhereFilesAreConfined) {
    fs::create_directories(folder / "in/deep");
    for (const char* uri :
         {"../a.bin", "%2e%2e/a.bin", "..%2Fa.bin", "%2E%2E%2fa.bin", "deep/../../a.bin", "deep%2F..%2f..%2Fa.bin"}) {
        SCOPED_TRACE(uri);
        const fs::path file = gltf.saveWithBuffer(folder / "in/a.gltf", uri, folder / "a.bin");
        EXPECT_EQ(positions(file), corners);
        const ReadsBelow confined(folder / "in", file);
        EXPECT_THROW(loadGltfScene(file), InputError);
    }
}

TEST_F(GltfFiles, DataUris) {
    std::string escaped; // of the same bytes, without base64
    for (const char c : std::string("\0\0\0\0\0\0\0\0\0\0\0\0\0\0\x80?\0\0\0\0\0\0\0\0\0\0\0\0\0\0\x80?\0\0\0\0", 36))
        escaped += c == '?' ? "?" : c == '\0' ? "%00" : "%80";
    std::string lines = kCorners;
    lines.insert(20, "\r\n ");
    for (const std::string& uri :
         {"data:application/octet-stream;base64," + kCorners, "data:;base64," + kCorners, "DATA:;BASE64," + kCorners,
          "data:model/x;charset=a;base64," + kCorners, "data:;base64," + lines, "data:," + escaped,
          "data:;base64,%41" + kCorners.substr(1) + "%3D"}) {
        SCOPED_TRACE(uri);
        EXPECT_EQ(positions(withBuffer(uri)), corners);
    }
    expectError(withBuffer("data:;base64,AA*A"), "/buffers/0/uri: the data are no base64: there is a \"*\"");
    expectError(withBuffer("data:;base64"), "/buffers/0/uri: there is no comma");
}

TEST_F(GltfFiles, ManyBuffersOfOneFileAreReadOnce) {
    const std::size_t count = 1000;
    GltfBuilder::write(folder / "a.bin", std::string(1 << 20, '\0'));
    json document = json::parse(contentOf(withBuffer("data:;base64," + kCorners)));
    for (std::size_t i = 0; i < count; ++i)
        document["buffers"].push_back({{"byteLength", 1}, {"uri", i % 2 == 0 ? "a.bin" : "./%61.bin"}});
    GltfBuilder::write(folder / "a.gltf", document.dump());
    EXPECT_LT(readGltf(folder / "a.gltf").bytes, (1u << 20) + document.dump().size() + 1);
}

// ---- images --------------------------------------------------------------------------------------------------------

class GltfMissingImages : public GltfFiles {
  protected:
    // The material of a triangle with this image for base colour and emission.
    MaterialDesc material(const json& image, const json& info = {{"index", 0}}) {
        gltf.json["images"] = {image};
        gltf.json["textures"] = {{{"source", 0}}};
        gltf.json["materials"] = {
            {{"pbrMetallicRoughness", {{"baseColorFactor", {0.25, 0.5, 0.75, 0.5}}, {"baseColorTexture", info}}},
             {"alphaMode", "BLEND"},
             {"normalTexture", info},
             {"emissiveFactor", {1, 1, 0}},
             {"emissiveTexture", info}}};
        gltf.json["meshes"][0]["primitives"][0]["material"] = 0;
        scene = loadGltfScene(gltf.save(folder / "a.glb"));
        return scene.materials.begin()->second;
    }
    void expectFactorsAlone(const MaterialDesc& m, const std::string& notice) const {
        EXPECT_EQ(std::get<glm::dvec3>(m.albedo), glm::dvec3(0.25, 0.5, 0.75));
        EXPECT_EQ(m.principled.opacity, (NumberOrTexture{0.5, {}, Channel::Red}));
        EXPECT_EQ(m.principled.normalTexture, "");
        EXPECT_EQ(m.emission, glm::dvec3(1, 1, 0));
        EXPECT_EQ(m.emissionTexture, "");
        EXPECT_TRUE(scene.textures.empty());
        std::string all;
        for (const std::string& line : scene.notices) all += line + "\n";
        EXPECT_NE(all.find(notice), std::string::npos) << all;
        EXPECT_NO_THROW(app::compile(scene, true));
    }

    SceneDesc scene;
};

TEST_F(GltfMissingImages, LeaveTheFactorAlone) {
    expectFactorsAlone(material({{"uri", "no+such%20file.png"}}),
                       "images that do not exist are left out of materials: \"no+such%20file.png\"");
    expectFactorsAlone(material({{"name", "nowhere"}}), "left out of materials: /images/0");
    expectFactorsAlone(material({{"uri", "data:;base64,"}}), "left out of materials: /images/0");
}

TEST_F(GltfMissingImages, AreNoneOfOtherCase) {
    GltfBuilder::write(folder / "Wood.PNG", std::string(kPng.begin(), kPng.end()));
    EXPECT_FALSE(material({{"uri", "wood.png"}}).emissionTexture.empty());
    EXPECT_GT(app::compile(scene, true)->images.at(0).width, 0u);
}

TEST_F(GltfMissingImages, AreNoneOfThoseThatExist) {
    GltfBuilder::write(folder / "a+b.png", std::string(kPng.begin(), kPng.end()));
    const MaterialDesc m = material({{"uri", "a+b.png"}});
    EXPECT_FALSE(m.emissionTexture.empty());
    EXPECT_FALSE(app::compile(scene, true)->images.empty());
}

// One cannot be told from another until it is decoded, but for the notice what comes is the same.
TEST_F(GltfMissingImages, AreAlsoThoseThatCannotBeRead) {
    const std::string whole(kPng.begin(), kPng.end());
    std::string noise = whole;
    for (std::size_t i = 40; i < noise.size(); i += 3) noise[i] ^= 0x55;
    for (const std::string& bytes : {whole.substr(0, whole.size() / 2), whole.substr(0, 20), std::string(1, 'x'),
                                     std::string(), std::string("DDS and more than that"), noise}) {
        GltfBuilder::write(folder / "a.png", bytes);
        material({{"uri", "a.png"}});
        const auto compiled = app::compile(scene, true);
        ASSERT_FALSE(compiled->images.empty());
        for (const shared::Image& image : compiled->images) {
            EXPECT_EQ(image.width * image.height, 1u);
            EXPECT_EQ(compiled->texels[image.firstTexel], 0xffffffffu);
        }
        const auto isSaid = [](const std::string& notice) {
            return notice.find("a.png") != std::string::npos && notice.find("left out") != std::string::npos;
        };
        EXPECT_TRUE(std::any_of(compiled->notices.begin(), compiled->notices.end(), isSaid)) << bytes.size();
    }
}

// Else a file of others would find out what exists.
TEST_F(GltfMissingImages, OutsideOfWhatMayBeReadAreRefusedAsThoseThatExist) {
    fs::create_directories(folder / "in");
    GltfBuilder::write(folder / "a.png", std::string(kPng.begin(), kPng.end()));
    for (const char* uri : {"../a.png", "../missing.png", "%2e%2e%2Fmissing.png"}) {
        material({{"uri", uri}});
        const fs::path file = gltf.save(folder / "in/a.glb");
        const ReadsBelow confined(folder / "in", file);
        scene = loadGltfScene(file);
        EXPECT_TRUE(std::get<std::string>(scene.materials.begin()->second.albedo) != "") << uri;
        EXPECT_THROW(app::compile(scene, true), InputError) << uri;
    }
}

TEST_F(GltfMissingImages, NeitherAreThereMoreThanTwoSetsOfCoordinates) {
    GltfBuilder::write(folder / "a.png", std::string(kPng.begin(), kPng.end()));
    const char* const notice = "a texture of coordinates beyond the second set of 1 material is left out";
    expectFactorsAlone(material({{"uri", "a.png"}}, {{"index", 0}, {"texCoord", 2}}), notice);
    expectFactorsAlone(material({{"uri", "a.png"}}, {{"index", 0}, {"texCoord", 7}}), notice);
}

} // namespace
} // namespace rt::scene
