// The text of pbrt files, what packs them, and meshes in files beside.
#include <bit>
#include <cstdint>
#include <string>

#include <gtest/gtest.h>

#include "Common/App/Session/SceneSource.h"
#include "Common/Core/Error.h"
#include "Common/Scene/Compiler/MaterialTable.h"
#include "Common/Scene/Json/SceneJson.h"
#include "tests/Gzip.h"
#include "tests/unit/PbrtFolder.h"

namespace rt::scene {
namespace {

using test::gzipOf;
using test::meshOf;
using test::shapeOf;

// Least significant byte first, or last.
template <class Unsigned>
std::string bytesOf(Unsigned value, bool isBigEndian) {
    std::string bytes;
    for (std::size_t i = 0; i < sizeof(value); ++i) {
        const std::size_t at = isBigEndian ? sizeof(value) - 1 - i : i;
        bytes += static_cast<char>(value >> (8 * at) & 0xff);
    }
    return bytes;
}

TEST(PbrtFiles, TheTextIsReadHoweverItIsLaidOut) {
    const test::PbrtFolder folder;
    const SceneDesc scene = folder.load(
        "\xef\xbb\xbf# first\r\nWorldBegin # second \"[\n"
        "Shape\t\"sphere\"\"float radius\"[.5e0]Shape \"sphere\" # and \"float radius\" 9\r\n\"float radius\" +2.\n"
        "MakeNamedMaterial \"a \\\"b\\\"\" \"string type\" [\"diffuse\"]NamedMaterial \"a \\\"b\\\"\"Shape\"disk\"");
    ASSERT_EQ(scene.objects.size(), 3u);
    EXPECT_EQ(shapeOf<SphereDesc>(scene, 0).radius, 0.5);
    EXPECT_EQ(shapeOf<SphereDesc>(scene, 1).radius, 2);
    EXPECT_EQ(shapeOf<DiskDesc>(scene, 2).material, "a \"b\"");
}

// Comments and lists are longer than what is in memory at a time, words are not.
TEST(PbrtFiles, AnythingButAWordMayBeLong) {
    const test::PbrtFolder folder;
    std::string text = "WorldBegin #" + std::string(1 << 19, 'x') + "\nShape \"trianglemesh\" \"point3 P\" [";
    constexpr int kVertices = 60000;
    for (int i = 0; i < kVertices; ++i) text += std::to_string(i) + " " + std::to_string(i % 7) + " 0.25\n";
    text += "] \"integer indices\" [0 1 2 " + std::to_string(kVertices - 1) + " 3 4]";
    const SceneDesc scene = folder.load(text);
    const FloatMeshData& mesh = meshOf<FloatMeshData>(scene, 0);
    ASSERT_EQ(mesh.positions.size(), std::size_t{kVertices});
    EXPECT_EQ(mesh.positions.back(), glm::vec3(kVertices - 1, (kVertices - 1) % 7, 0.25f));
    EXPECT_EQ(mesh.triangles[1], glm::uvec3(kVertices - 1, 3, 4));
    EXPECT_THROW(folder.load("WorldBegin " + std::string(1 << 16, 'x')), InputError);
    EXPECT_THROW(folder.load("WorldBegin \"" + std::string(1 << 16, 'x')), InputError);
}

TEST(PbrtFiles, WhatIsLeftOutIsTold) {
    const test::PbrtFolder folder;
    const SceneDesc scene = folder.load(
        "Sampler \"halton\" \"integer pixelsamples\" 9\nIntegrator \"volpath\"\nFilm \"rgb\" \"float iso\" 400\n"
        "WorldBegin\nShape \"sphere\" \"float radios\" 2\nShape \"sphere\" \"float radios\" 2\n");
    EXPECT_TRUE(test::hasNotice(scene, "a.pbrt:5: Shape \"sphere\": \"float radios\" is left out; 2 times in all"));
    EXPECT_TRUE(test::hasNotice(scene, "left out: Sampler \"halton\", Integrator \"volpath\""));
    EXPECT_TRUE(test::hasNotice(scene, "--exposure 2"));
}

// Long lists are in single precision, so that they take half of the memory; the rest is as for a short one.
TEST(PbrtFiles, ManyVerticesAreAsFew) {
    const test::PbrtFolder folder;
    constexpr int kVertices = 33000;
    std::string list, rows, normals;
    for (int i = 0; i < kVertices; ++i) {
        const std::string position = std::to_string(i % 100) + ".1 " + std::to_string(i / 100) + " .3 ";
        list += position;
        rows += position + "0\n";
        normals += "0 0 -.1 ";
    }
    const auto ply = [&](const std::string& last) {
        return "ply\nformat ascii 1.0\nelement vertex " + std::to_string(kVertices) +
               "\nproperty float x\nproperty float y\nproperty float z\nproperty " + last +
               "\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n" + rows + "3 0 1 100\n";
    };
    folder.write("floats.ply", ply("float nz"));
    folder.write("doubles.ply", ply("double u"));
    const SceneDesc scene = folder.load(
        "WorldBegin\nReverseOrientation\nAreaLightSource \"diffuse\" \"float power\" 1\n"
        "Shape \"trianglemesh\" \"integer indices\" [0 1 100] \"point3 P\" [" +
        list + "] \"normal N\" [" + normals +
        "]\nShape \"plymesh\" \"string filename\" \"floats.ply\"\n"
        "Shape \"plymesh\" \"string filename\" \"doubles.ply\"\n");
    const auto& mesh = meshOf<FloatMeshData>(scene, 0);
    EXPECT_EQ(mesh.positions[102], glm::vec3(2.1f, 1, 0.3f));
    EXPECT_EQ(mesh.normals[1], glm::vec3(0, 0, 0.1f));
    EXPECT_EQ(mesh.triangles.front(), glm::uvec3(0, 1, 100)); // turned to the normals, then over
    EXPECT_EQ(meshOf<FloatMeshData>(scene, 1).positions, mesh.positions);
    EXPECT_EQ(meshOf(scene, 2).positions[102], glm::dvec3(2.1, 1, 0.3));
    // Written as a scene file and read again it is the same mesh.
    const SceneDesc again = parseScene(toJson(scene), "again.json", folder.path());
    EXPECT_EQ(meshOf(again, 0), mesh.as<double>());
    const std::string material = std::get<MeshDesc>(test::placed(again.objects, 0).shape).material;
    EXPECT_TRUE(emits(again.materials.at(material)));
}

// As public scenes have them: none of it is a reason to stop.
TEST(PbrtFiles, OptionsAndPerspectiveAreLeftOut) {
    const test::PbrtFolder folder;
    const SceneDesc scene = folder.load(
        "Option \"seed\" 42\nOption \"wavefront\" [true]\nOption \"msereferenceout\" \"a.exr\"\n"
        "Option \"bool disablepixeljitter\" true\nWorldBegin\nAttributeBegin\n"
        "ConcatTransform [0 0 1 0 1 0 0 0 0 1 0 9 0 0 0 1]\nLightSource \"infinite\" \"float scale\" .5\n"
        "AttributeEnd\nMaterial \"hair\" \" float beta_n\" 0.5\nShape \"sphere\"\n");
    EXPECT_EQ(std::get<ConstantBackground>(scene.background).color, glm::dvec3(0.5));
    EXPECT_TRUE(test::hasNotice(scene, "a.pbrt:7: perspective in transforms is left out"));
    EXPECT_EQ(scene.objects.size(), 1u);
}

TEST(PbrtFiles, ParametersGoOnBehindAnIncludedFile) {
    const test::PbrtFolder folder;
    folder.write("inner.pbrt", "Shape \"disk\" \"float radius\" 3 # the last\n");
    folder.write("outer.pbrt", "Include \"inner.pbrt\"");
    const SceneDesc scene = folder.load(
        "WorldBegin\nInclude \"outer.pbrt\"\n  \"float innerradius\" 2 \"float height\" [ 1 ]\n"
        "Shape \"sphere\"\nInclude \"inner.pbrt\"\nShape \"sphere\" \"float radius\" 4");
    ASSERT_EQ(scene.objects.size(), 4u);
    EXPECT_EQ(shapeOf<DiskDesc>(scene, 0).innerRadius, 2);
    EXPECT_EQ(shapeOf<DiskDesc>(scene, 0).center.z, 1);
    EXPECT_EQ(shapeOf<DiskDesc>(scene, 2).innerRadius, 0);
    EXPECT_EQ(shapeOf<SphereDesc>(scene, 3).radius, 4);
    EXPECT_THROW(folder.load("WorldBegin\nImport \"inner.pbrt\"\n\"float innerradius\" 2"), InputError);
}

TEST(PbrtFiles, OddTexturesAreNoMistakes) {
    const test::PbrtFolder folder;
    const SceneDesc scene = folder.load(
        "WorldBegin\nTexture \"bumps\" \"float\" \"imagemap\" \"float scale\" -3.5 \"string filename\" [ \"a b.png\" "
        "]\n"
        "Texture \"up\" \"spectrum\" \"imagemap\" \"float scale\" 3 \"string filename\" \"c.png\"\n"
        "Texture \"cover\" \"float\" \"imagemap\" \"string filename\" \"c.png\" \"string mapping\" \"planar\" "
        "\"vector3 v1\" [ 0 1 0 ]\nTexture \"red\" \"spectrum\" \"scale\" \"rgb tex\" [ .5 .25 .125 ] "
        "\"texture scale\" \"cover\"\nTexture \"both\" \"spectrum\" \"directionmix\" \"texture tex1\" [ \"up\" ] "
        "\"texture tex2\" [ \"red\" ] \"vector3 dir\" [ 0 1 0 ]\n"
        "Material \"coateddiffuse\" \"texture displacement\" \"bumps\" \"texture reflectance\" \"both\"\nShape "
        "\"sphere\"\n"
        "Material \"diffuse\" \"texture reflectance\" \"red\"\nShape \"sphere\"\n");
    const auto& red = std::get<std::string>(scene.materials.at(shapeOf<SphereDesc>(scene, 1).material).albedo);
    EXPECT_EQ(std::get<ImageTexture>(scene.textures.at(red)).tint, glm::dvec3(0.5, 0.25, 0.125));
    EXPECT_TRUE(test::hasNotice(scene, "bumps by \"displacement\" are left out"));
    for (const std::string& notice : scene.notices) EXPECT_EQ(notice.find("\"vector3"), notice.npos) << notice;
}

TEST(PbrtFiles, PackedOnesAreRead) {
#ifndef RT_HAS_ZLIB
    GTEST_SKIP() << "this build has no zlib";
#endif
    const test::PbrtFolder folder;
    const std::string packed = gzipOf("WorldBegin Shape \"sphere\" \"float radius\" 2");
    for (const char* name : {"a.pbrt.gz", "b.PBRT.GZ", "c.pbrt"}) {
        const SceneDesc scene = app::loadScene(folder.write(name, packed).string());
        EXPECT_EQ(shapeOf<SphereDesc>(scene, 0).radius, 2) << name;
    }
    // Two packed files one after the other are one.
    const auto both = folder.write("d.pbrt", packed + gzipOf("\nShape \"disk\""));
    EXPECT_EQ(loadPbrtScene(both).objects.size(), 2u);
    EXPECT_THROW(loadPbrtScene(folder.write("e.pbrt", packed.substr(0, 30))), InputError);
    EXPECT_THROW(loadPbrtScene(folder.write("f.pbrt", "\x1f\x8b" + std::string(50, 'x'))), InputError);
}

std::string squareInPly(bool isBigEndian) {
    std::string ply = "ply\nformat binary_" + std::string(isBigEndian ? "big" : "little") +
                      "_endian 1.0\nelement vertex 4\nproperty float x\nproperty double y\nproperty float z\n"
                      "property uchar red\nelement face 2\nproperty list uchar uint vertex_indices\n"
                      "property short flags\nend_header\n";
    for (const double x : {0.0, 1.0})
        for (const double y : {0.0, 0.1})
            ply += bytesOf(std::bit_cast<std::uint32_t>(float(x)), isBigEndian) +
                   bytesOf(std::bit_cast<std::uint64_t>(y), isBigEndian) +
                   bytesOf(std::bit_cast<std::uint32_t>(-2.5f), isBigEndian) + "\xff";
    for (const std::uint32_t last : {2u, 1u}) {
        ply += '\3';
        for (const std::uint32_t index : {0u, 3u, last}) ply += bytesOf(index, isBigEndian);
        ply += bytesOf(std::uint16_t{0xffff}, isBigEndian);
    }
    return ply;
}

TEST(PbrtFiles, PlyInEitherOrderOfBytes) {
    const test::PbrtFolder folder;
    for (const bool isBigEndian : {false, true}) {
        folder.write("a.ply", squareInPly(isBigEndian));
        const SceneDesc scene = folder.load("WorldBegin Shape \"plymesh\" \"string filename\" \"a.ply\"");
        const MeshData& mesh = meshOf(scene, 0);
        EXPECT_EQ(mesh.positions,
                  (std::vector<glm::dvec3>{{0, 0, -2.5}, {0, 0.1, -2.5}, {1, 0, -2.5}, {1, 0.1, -2.5}}));
        EXPECT_EQ(mesh.triangles, (std::vector<glm::uvec3>{{0, 3, 2}, {0, 3, 1}}));
        folder.write("a.ply", squareInPly(isBigEndian).substr(0, 300));
        EXPECT_THROW(folder.load("WorldBegin Shape \"plymesh\" \"string filename\" \"a.ply\""), InputError);
    }
}

TEST(PbrtFiles, OrientationIsThatOfNormals) {
    const test::PbrtFolder folder;
    const std::string triangle = "Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0]";
    const auto first = [&](const std::string& text) {
        const SceneDesc scene = folder.load("WorldBegin " + text);
        return meshOf(scene, 0).triangles[0];
    };
    EXPECT_EQ(first(triangle), glm::uvec3(0, 1, 2));
    EXPECT_EQ(first("ReverseOrientation " + triangle), glm::uvec3(0, 2, 1));
    EXPECT_EQ(first(triangle + " \"normal N\" [0 0 -1 0 0 -1 0 0 -1]"), glm::uvec3(0, 2, 1));
    EXPECT_EQ(first("ReverseOrientation " + triangle + " \"normal N\" [0 0 -1 0 0 -1 0 0 -1]"), glm::uvec3(0, 1, 2));
}

TEST(PbrtFiles, NamesInOtherCaseAndFromTheFolderOfTheScene) {
    const test::PbrtFolder folder;
    folder.write("sub/inner.pbrt", "Include \"sub/other.pbrt\"\nInclude \"beside.pbrt\"");
    folder.write("sub/other.pbrt", "Shape \"sphere\"");
    folder.write("sub/beside.pbrt", "Shape \"disk\"");
    const SceneDesc scene = folder.load("WorldBegin Include \"Sub/Inner.pbrt\"");
    EXPECT_EQ(scene.objects.size(), 2u);
}

} // namespace
} // namespace rt::scene
