// OBJ and MTL files: what is read, and errors that name file and line.
#include <cmath>
#include <filesystem>
#include <fstream>
#include <random>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "Common/Core/Error.h"
#include "Common/Scene/Compiler/SceneCompiler.h"
#include "Common/Scene/Json/SceneJson.h"
#include "Common/Scene/Obj/ObjLoader.h"
#include "tests/unit/ObjFolder.h"

namespace rt::scene {
namespace {

namespace fs = std::filesystem;
using test::kSquare;

class ObjLoader : public test::ObjFolder {};

TEST_F(ObjLoader, ReadsTrianglesByPositiveAndNegativeIndices) {
    const ObjModel model = load(kSquare + "f 1 2 3\nf -4 -2 -1\n");
    ASSERT_EQ(model.parts.size(), 1u);
    const MeshData& mesh = model.parts[0].mesh;
    EXPECT_EQ(mesh.positions.size(), 4u);
    EXPECT_EQ(mesh.triangles.size(), 2u);
    EXPECT_EQ(mesh.positions[mesh.triangles[1].y], glm::dvec3(1, 1, 0));
    EXPECT_EQ(mesh.positions[mesh.triangles[1].z], glm::dvec3(0, 1, 0));
    EXPECT_TRUE(mesh.normals.empty() && mesh.uvs.empty());
}

TEST_F(ObjLoader, CutsPolygons) {
    const MeshData mesh = load("v 0 0 0\nv 4 0 0\nv 4 4 0\nv 2 1 0\nv 0 4 0\nf 1 2 3 4 5\n").parts[0].mesh;
    ASSERT_EQ(mesh.triangles.size(), 3u);
    double area = 0;
    for (const glm::uvec3& t : mesh.triangles) {
        const glm::dvec3 a = mesh.positions[t.x];
        const double z = glm::cross(mesh.positions[t.y] - a, mesh.positions[t.z] - a).z;
        EXPECT_GT(z, 0);
        area += 0.5 * z;
    }
    EXPECT_NEAR(area, 10, 1e-12);
}

TEST_F(ObjLoader, UnifiesVerticesByAllTheirIndices) {
    const std::string attributes = "vt 0 0\nvt 1 0\nvt 0 1\nvn 0 0 1\nvn 0 1 0\n";
    const MeshData mesh =
        load(kSquare + attributes + "f 1/1/1 2/2/1 3/3/1\nf 1/1/1 3/3/1 4/2/2\nf 1/2/1 2/2/1 3/3/2\n").parts[0].mesh;
    EXPECT_EQ(mesh.triangles.size(), 3u);
    EXPECT_EQ(mesh.positions.size(), 6u); // corners 1 and 3 come in two kinds
    EXPECT_EQ(mesh.normals.size(), 6u);
    EXPECT_EQ(mesh.uvs.size(), 6u);
    // Many faces around one vertex, each with a corner of its own there: where that takes time in proportion to the
    // square of their number, this test takes as long as a nightly run.
    constexpr int kFaces = 200'000;
    std::string fan = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    for (int i = 1; i <= kFaces; ++i) fan += "vt 0 " + std::to_string(i) + "\n";
    for (int i = 1; i <= kFaces; ++i) {
        const std::string uv = "/" + std::to_string(i);
        fan += "f 1" + uv + " 2" + uv + " 3" + uv + "\n";
    }
    const MeshData many = load(fan).parts.at(0).mesh;
    EXPECT_EQ(many.triangles.size(), std::size_t{kFaces});
    EXPECT_EQ(many.positions.size(), std::size_t{3 * kFaces});
}

TEST_F(ObjLoader, SplitsByMaterialAndUnderstandsThem) {
    write("model.mtl",
          "newmtl red\nKd 0.8 0.1 0.1\nillum 2\n\nnewmtl lamp\nKd 0 0 0\nKe 5 6 7\n\nnewmtl mirror\nillum 3\nKs 0.9 "
          "0.8 0.7\nPr 0.25\n\n"
          "newmtl glass\nillum 7\nNi 1.33\nTf 1 0.9 0.9\n\nnewmtl mapped\nKd 0.5 0.5 0.5\nmap_Kd tex\\map.png\nmap_Ke "
          "tex/map.png\n");
    fs::create_directories(folder_ / "tex");
    write("tex/map.png", "not read here");
    const ObjModel model =
        load("mtllib model.mtl\n" + kSquare +
             "usemtl red\nf 1 2 3\nusemtl lamp\nf 1 3 4\no other\nusemtl red \nf 2 3 4\nusemtl mirror\nf 1 2 4\n"
             "g x y\nusemtl glass\nf 1 2 3\nusemtl mapped\nf 1 2 3\n");
    ASSERT_EQ(model.parts.size(), 5u);
    for (const ObjPart& part : model.parts) EXPECT_EQ(part.mesh.triangles.size(), part.material == "red" ? 2u : 1u);
    EXPECT_EQ(model.materials.at("red").kind, MaterialKind::Lambertian);
    EXPECT_NEAR(std::get<glm::dvec3>(model.materials.at("red").albedo).x, 0.8, 1e-6);
    EXPECT_EQ(model.materials.at("lamp").emission, glm::dvec3(5, 6, 7));
    EXPECT_EQ(model.materials.at("mirror").kind, MaterialKind::Metal);
    EXPECT_EQ(model.materials.at("mirror").parameters[shared::kMetalFuzz], 0.25);
    EXPECT_NEAR(std::get<glm::dvec3>(model.materials.at("mirror").albedo).z, 0.7, 1e-6);
    EXPECT_EQ(model.materials.at("glass").kind, MaterialKind::Dielectric);
    EXPECT_NEAR(model.materials.at("glass").parameters[shared::kDielectricIor].value(), 1.33, 1e-6);
    const auto& texture =
        std::get<ImageTexture>(model.textures.at(std::get<std::string>(model.materials.at("mapped").albedo)));
    EXPECT_EQ(fs::path(texture.file), folder_ / "tex" / "map.png");
    EXPECT_EQ(texture.tint, glm::dvec3(0.5));
    EXPECT_EQ(model.materials.at("mapped").emission, glm::dvec3(1));

    const ObjModel plain = load("mtllib gone.mtl\n" + kSquare + "usemtl red\nf 1 2 3\nusemtl blue\nf 1 3 4\n", false);
    EXPECT_EQ(plain.parts.size(), 1u);
    EXPECT_TRUE(plain.materials.empty());
}

TEST_F(ObjLoader, ColorsOfVerticesTintWhatScattersThem) {
    const std::string colored = "v 0 0 0 1 0 0\nv 1 0 0 0 1 0 \nv 1 1 0 0.5 2 -1 # beyond [0,1]\r\n";
    ObjModel model = load(colored + "f 1 2 3\n");
    EXPECT_TRUE(hasNotice(model, "model.obj: the 1 colour of a vertex beyond [0,1] is clamped"));
    ASSERT_EQ(model.parts.size(), 1u);
    const MeshData& mesh = model.parts[0].mesh;
    ASSERT_EQ(mesh.colors.size(), 3u);
    EXPECT_EQ(mesh.colors[0], glm::dvec4(1, 0, 0, 1));
    EXPECT_NEAR(mesh.colors[2].r, 0.214041, 1e-6) << "encoded as sRGB, IEC 61966-2-1";
    EXPECT_EQ(glm::dvec3(mesh.colors[2].g, mesh.colors[2].b, mesh.colors[2].a), glm::dvec3(1, 0, 1));
    const MaterialDesc& white = model.materials.at(model.parts[0].material);
    EXPECT_EQ(white.kind, MaterialKind::Principled);
    EXPECT_EQ(std::get<glm::dvec3>(white.albedo), glm::dvec3(1));
    EXPECT_EQ(white.principled.specular.factor, 0);
    const SceneDesc scene = loadObjScene(folder_ / "model.obj");
    SceneDesc again = parseScene(toJson(scene), "again.json", {});
    again.id = scene.id;
    again.notices = scene.notices;
    EXPECT_EQ(again, scene);
    EXPECT_EQ(compileScene(scene)->colors.size(), 3u);
    EXPECT_TRUE(load(colored + "f 1 2 3\n", false).parts[0].mesh.colors.empty()) << "they go with the materials";

    write("model.mtl",
          "newmtl red\nKd 0.5 0 0\nnewmtl shiny\nKd 1 0 0\nKs 0.5 0.5 0.5\nnewmtl glass\nillum 7\nNi 1.5\n"
          "newmtl mixed\nKd 0 0 1\n");
    model = load("mtllib model.mtl\n" + colored + "v 2 0 0\nusemtl red\nf 1 2 3\nusemtl shiny\nf 3 2 1\n" +
                 "usemtl glass\nf 1 2 3\nusemtl mixed\nf 1 2 4\n");
    ASSERT_EQ(model.parts.size(), 4u);
    for (const ObjPart& part : model.parts) {
        const MaterialDesc& material = model.materials.at(part.material);
        const bool isTinted = part.material == "red" || part.material == "shiny";
        EXPECT_EQ(part.mesh.colors.size(), isTinted ? 3u : 0u) << part.material;
        EXPECT_EQ(material.kind, isTinted                   ? MaterialKind::Principled
                                 : part.material == "glass" ? MaterialKind::Dielectric
                                                            : MaterialKind::Lambertian);
    }
    EXPECT_EQ(std::get<glm::dvec3>(model.materials.at("red").albedo), glm::dvec3(0.5, 0, 0));
    EXPECT_EQ(model.materials.at("shiny").principled.specular.factor, 1);
    EXPECT_TRUE(hasNotice(model, "the colours of vertices are left out of 1 material: mirrors"));
    EXPECT_TRUE(hasNotice(model, "1 triangle has a colour at some corners only: left out"));

    EXPECT_TRUE(load("v 0 0 0 1\nv 1 0 0 1\nv 1 1 0 1\nf 1 2 3\n").materials.empty()) << "w is no colour";
    EXPECT_EQ(load("v 0 0 0 1 0 0\nv 1 0 0\nv 1 1 0 0 0 1\nf 1 2 3\n").notices.size(), 1u);
    model = load("v 0 0 0 1 red 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n");
    EXPECT_TRUE(hasNotice(model,
                          "model.obj:1: the colour of a vertex must be three finite numbers (\"v 0 0 0 1 red 0\")"
                          "; 1 vertex has no colour"));
    EXPECT_TRUE(load("v 0 0 0 # 1 2 3\nv 1 0 0 # d e f\nv 1 1 0 #g h i\nf 1 2 3\n").notices.empty());
    // Faces with colours and without are parted.
    model = load("v 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 1 1 0 0 0 1\nv 2 0 0\nv 3 0 0\nv 3 3 0\nf 4 5 6\nf 1 2 3\n");
    ASSERT_EQ(model.parts.size(), 2u);
    EXPECT_EQ(model.parts[0].mesh.colors.size(), 3u);
    EXPECT_TRUE(model.parts[1].mesh.colors.empty() && model.parts[1].material.empty());
    EXPECT_TRUE(hasNotice(model, "1 triangle of 1 material does without colours of vertices"));
}

TEST_F(ObjLoader, ColorsOfBytesAreRecognised) {
    const ObjModel model = load("v 0 0 0 255 0 0\nv 1 0 0 0 128 0\nv 1 1 0 0 1 64\nf 1 2 3\n");
    const MeshData& mesh = model.parts.at(0).mesh;
    ASSERT_EQ(mesh.colors.size(), 3u);
    EXPECT_EQ(mesh.colors[0], glm::dvec4(1, 0, 0, 1));
    EXPECT_NEAR(mesh.colors[1].g, std::pow((128 / 255.0 + 0.055) / 1.055, 2.4), 1e-6) << "IEC 61966-2-1";
    EXPECT_NEAR(mesh.colors[2].g, 1 / 255.0 / 12.92, 1e-7);
    EXPECT_TRUE(hasNotice(model, "the colours of vertices are whole numbers up to 255, and divided by that"));
    EXPECT_TRUE(load("v 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 1 1 0 0 0 1\nf 1 2 3\n").notices.empty());
    EXPECT_TRUE(hasNotice(load("v 0 0 0 256 0 0\nv 1 0 0 0 1 0\nv 1 1 0 0 0 1\nf 1 2 3\n"), "is clamped"));
}

TEST_F(ObjLoader, Utf16AndByteOrderMarksAreRead) {
    const std::string text =
        kSquare + "usemtl \xc3\xa4\xf0\x9f\x98\x80\nf 1 2 3\n"; // an umlaut and a character of four bytes
    const std::u16string wide = [] {
        std::u16string characters;
        for (const char c : kSquare + "usemtl ") characters += static_cast<char16_t>(c);
        return characters + u"\u00e4\U0001f600\nf 1 2 3\n";
    }();
    std::string big = "\xfe\xff", little = "\xff\xfe";
    for (const char16_t c : wide) {
        big += {static_cast<char>(c >> 8), static_cast<char>(c & 255)};
        little += {static_cast<char>(c & 255), static_cast<char>(c >> 8)};
    }
    const ObjModel plain = load(text);
    ASSERT_EQ(plain.notices.size(), 1u);
    EXPECT_NE(plain.notices[0].find("\"\xc3\xa4\xf0\x9f\x98\x80\""), std::string::npos);
    for (const std::string& encoded : {"\xef\xbb\xbf" + text, big, little}) {
        const ObjModel model = load(encoded);
        EXPECT_EQ(model.parts.at(0).mesh, plain.parts[0].mesh);
        EXPECT_EQ(model.notices, plain.notices);
    }
    EXPECT_NE(errorOf("\xff\xfe").find("no face"), std::string::npos);
    EXPECT_NE(errorOf("\xfe\xff\xd8").find("no face"), std::string::npos);
}

TEST_F(ObjLoader, AMaterialFileThatIsNoneIsANotice) {
    write("words.mtl", "no material is here\n");
    write("model.obj", "mtllib words.mtl\n" + kSquare + "f 1 2 3\n");
    const auto says = [](const std::vector<std::string>& notices) {
        return notices.size() == 1 && notices[0].find("words.mtl: there is no material in it") != std::string::npos;
    };
    EXPECT_TRUE(says(compileScene(loadObjScene(folder_ / "model.obj"))->notices));
    write("scene.json", R"({"objects": [{"type": "mesh", "file": "model.obj"}]})");
    EXPECT_TRUE(says(compileScene(loadSceneFile(folder_ / "scene.json"))->notices));
}

TEST_F(ObjLoader, DamagedFilesDoNoHarm) {
    write("model.mtl", "newmtl red\nKd 1 0 0\nKe 1 1 1\nillum 3\n");
    const std::string text = "mtllib model.mtl\n" + kSquare +
                             "vt 0 0\nvn 0 0 1\nusemtl red\nf 1/1/1 2/1/1 3/1/1 4/1/1\nf -1//1 -2//1 -3//1\n";
    std::mt19937 random(1);
    for (int i = 0; i < 1000; ++i) {
        std::string damaged = text.substr(0, i % 2 == 0 ? text.size() : random() % text.size());
        for (int k = 0; k < 3 && !damaged.empty(); ++k)
            damaged[random() % damaged.size()] = static_cast<char>(random());
        errorOf(damaged);
    }
}

TEST_F(ObjLoader, AFileAloneIsAScene) {
    const fs::path file = write("model.obj", "v 10 0 0\nv 14 0 0\nv 14 2 0\nv 10 2 1\nf 1 2 3\nf 1 3 4\n");
    const SceneDesc scene = loadObjScene(file);
    EXPECT_EQ(scene.id, "model.obj");
    const auto compiled = compileScene(scene);
    EXPECT_EQ(compiled->triangles.size(), 2u);
    // All of it is in view: inside the cone around the view that fits a square picture.
    const CameraDesc& camera = scene.camera;
    const glm::dvec3 view = glm::normalize(camera.lookAt - camera.lookFrom);
    for (const shared::vec3& p : compiled->positions) {
        const double cosine = glm::dot(glm::normalize(glm::dvec3(p)), view);
        EXPECT_GT(cosine, std::cos(camera.verticalFov / 2 * 3.14159265358979 / 180));
    }
    SceneDesc again = parseScene(toJson(scene), "again.json", {});
    again.id = scene.id;
    EXPECT_EQ(again, scene);
}

TEST_F(ObjLoader, MaterialsOfAFileServeAMeshWithoutOne) {
    write("model.mtl", "newmtl red\nKd 0.8 0.1 0.1\n");
    write("model.obj", "mtllib model.mtl\n" + kSquare + "f 1 2 3\nusemtl red\nf 1 3 4\n");
    write("scene.json", R"({"materials": {"own": {"type": "dielectric", "ior": 1.5}},
        "objects": [{"type": "mesh", "file": "model.obj"}, {"type": "mesh", "file": "model.obj", "material": "own"}]})");
    const auto compiled = compileScene(loadSceneFile(folder_ / "scene.json"));
    ASSERT_EQ(compiled->meshes.size(), 3u);
    EXPECT_NEAR(compiled->materials[compiled->meshes[0].material].albedo.x, 0.7, 1e-6);
    EXPECT_NEAR(compiled->materials[compiled->meshes[1].material].albedo.x, 0.8, 1e-6);
    EXPECT_EQ(compiled->materials[compiled->meshes[2].material].kind, shared::kMaterialDielectric);
    EXPECT_EQ(compiled->meshes[2].triangleCount, 2u);
    EXPECT_EQ(compiled->materialNames, (std::vector<std::string>{"plain", "red", "own"}));
}

} // namespace
} // namespace rt::scene
