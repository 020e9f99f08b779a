// Faces of OBJ files: what they have and lack, and what is left out of them.
#include <algorithm>
#include <cmath>
#include <string>
#include <variant>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "Common/Core/Error.h"
#include "Common/Scene/Compiler/SceneCompiler.h"
#include "Common/Scene/Obj/ObjLoader.h"
#include "tests/unit/ObjFolder.h"

namespace rt::scene {
namespace {

using test::kSquare;

class ObjFaces : public test::ObjFolder {};

TEST_F(ObjFaces, FacesKeepWhatTheyHave) {
    const std::string attributes = "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvn 0 0 1\nvn 0 1 0\n";
    const std::string whole = "f 1/1/1 2/2/1 3/3/1 4/4/1\n";
    const MeshData alone = load(kSquare + attributes + whole).parts.at(0).mesh;
    ObjModel model = load(kSquare + attributes + whole + "f 1 2 3\nf 1/1 2/2 3/3\nf 1//2 2//2 3//2\nf 1/1/1 2/2 3\n");
    ASSERT_EQ(model.parts.size(), 4u);
    EXPECT_EQ(model.parts[0].mesh, alone) << "whatever other faces of the material lack";
    EXPECT_TRUE(!model.parts[1].mesh.uvs.empty() && model.parts[1].mesh.normals.empty());
    EXPECT_TRUE(model.parts[2].mesh.uvs.empty() && !model.parts[2].mesh.normals.empty());
    EXPECT_TRUE(model.parts[3].mesh.uvs.empty() && model.parts[3].mesh.normals.empty());
    EXPECT_EQ(model.parts[3].mesh.triangles.size(), 2u);
    EXPECT_TRUE(hasNotice(model, "3 triangles of 1 material do without texture coordinates"));
    EXPECT_TRUE(hasNotice(model, "3 triangles of 1 material do without normals"));
    EXPECT_TRUE(hasNotice(model, "model.obj:15: a face with a texture coordinate at 2 of its 3 corners; 1 face does"));

    write("model.mtl", "newmtl a\nKd 0.5 0.25 1\nmap_Kd t.png\nmap_Ks t.png\n");
    write("t.png", "");
    model = load("mtllib model.mtl\nusemtl a\n" + kSquare + attributes + "f 1/1 2/2 3/3\nf 1 2 3\n");
    ASSERT_EQ(model.parts.size(), 2u);
    EXPECT_TRUE(std::holds_alternative<std::string>(model.materials.at(model.parts[0].material).albedo));
    const MaterialDesc& bare = model.materials.at(model.parts[1].material);
    EXPECT_EQ(std::get<glm::dvec3>(bare.albedo), glm::dvec3(0.5, 0.25, 1)) << "no image without a place in it";
    EXPECT_EQ(bare.kind, MaterialKind::Lambertian);
    EXPECT_TRUE(hasNotice(model, "1 triangle is without texture coordinates and so without the images"));
}

TEST_F(ObjFaces, SmoothingGroupsGiveNormals) {
    // Two squares of a roof with a right angle at the ridge, which is the y axis.
    const std::string roof = "v 0 0 0\nv 0 1 0\nv 1 0 -1\nv 1 1 -1\nv -1 0 -1\nv -1 1 -1\n";
    const std::string right = "f 1 3 4 2\n", left = "f 5 1 2 6\n";
    const auto normalsAt = [&](const std::string& faces, const glm::dvec3& position) {
        std::vector<glm::dvec3> normals;
        for (const ObjPart& part : load(roof + faces).parts)
            for (std::size_t i = 0; i < part.mesh.normals.size(); ++i)
                if (part.mesh.positions[i] == position) normals.push_back(part.mesh.normals[i]);
        return normals;
    };
    const double half = std::sqrt(0.5);
    const auto expect = [](const std::vector<glm::dvec3>& normals, const std::vector<glm::dvec3>& expected) {
        ASSERT_EQ(normals.size(), expected.size());
        for (std::size_t i = 0; i < normals.size(); ++i) EXPECT_LT(glm::length(normals[i] - expected[i]), 1e-12);
    };
    expect(normalsAt("s 1\n" + right + left, {0, 0, 0}), {{0, 0, 1}});
    expect(normalsAt("s 1\n" + right + left, {1, 0, -1}), {{half, 0, half}});
    expect(normalsAt("usemtl a\ns 4\n" + right + "usemtl b\n" + left, {0, 0, 0}), {{0, 0, 1}});
    expect(normalsAt("s 1\n" + right + "s 2\n" + left, {0, 0, 0}), {{half, 0, half}, {-half, 0, half}});
    for (const char* off : {"", "s off\n", "s 0\n", "s\n", "s 1\ns off\n"})
        expect(normalsAt(off + right + left, {0, 0, 0}), {});
    // Angles weigh: two triangles on one side count as the one corner that they make.
    expect(normalsAt("s on\nf 1 3 4\nf 1 4 2\n" + left, {0, 0, 0}), {{0, 0, 1}});
    // What a file says itself counts.
    expect(normalsAt("vn 1 0 0\ns 1\nf 1//1 3//1 4//1\n" + left, {0, 0, 0}), {{1, 0, 0}, {-half, 0, half}});
    // Opposite faces cancel out: no normal, which the surface's own takes the place of.
    const auto compiled = compileScene(loadObjScene(write("model.obj", roof + "s 1\nf 1 3 4\nf 4 3 1\n")));
    for (const shared::vec3& n : compiled->normals) EXPECT_NEAR(glm::length(glm::dvec3(n)), 1, 1e-6);
}

TEST_F(ObjFaces, WithoutAFaceTheFirstReasonIsTheError) {
    EXPECT_EQ(errorOf(kSquare + "f 1 2 9\n"), "model.obj:5: vertex index 9: there are 4");
    EXPECT_EQ(errorOf(kSquare + "\n# comment\nf 1 2 -5\n"), "model.obj:7: vertex index -5: there are 4 so far");
    EXPECT_EQ(errorOf(kSquare + "f 1 2 0"), "model.obj:5: a vertex index must be a whole number that is not 0 (\"0\")");
    EXPECT_EQ(errorOf(kSquare + "f 1 2 x\n").rfind("model.obj:5: a vertex index must be", 0), 0u);
    EXPECT_EQ(errorOf(kSquare + "f 1 2\nf 1 2 9\n"), "model.obj:5: a face of 2 corners: at least 3 are needed");
    EXPECT_EQ(errorOf(kSquare + "f 1 2 9\nf 1\n"), "model.obj:5: vertex index 9: there are 4");
    EXPECT_EQ(errorOf("v 1e999 0 0\nf 1 1 1\n"), "model.obj:1: v must have three finite numbers (\"v 1e999 0 0\")");
    for (const char* empty : {"", "\n", "# nothing\n", "v 0 0 0\nv 1 0 0\nv 0 1 0\n", "v nan\n", "garbage\n\x01\x02"})
        EXPECT_NE(errorOf(empty).find("there is no face in it"), std::string::npos) << empty;
    EXPECT_THROW(loadObj(folder_ / "gone.obj", true), InputError);
    EXPECT_THROW(loadObj(folder_.path(), true), InputError);
}

TEST_F(ObjFaces, WhatIsBrokenIsLeftOutAndCounted) {
    const std::string face = "f 1 2 3\n";
    const auto expect = [&](const std::string& text, const std::string& notice) {
        const ObjModel model = load(kSquare + text + face);
        ASSERT_EQ(model.parts.size(), 1u) << text;
        EXPECT_EQ(model.parts[0].mesh.triangles.size(), 1u) << text;
        if (notice.empty())
            EXPECT_TRUE(model.notices.empty()) << text << model.notices[0];
        else
            EXPECT_TRUE(hasNotice(model, notice)) << text << (model.notices.empty() ? "" : model.notices[0]);
    };
    expect("f 1 2\n", "model.obj:5: a face of 2 corners: at least 3 are needed; 1 face is left out");
    expect("f\nf 1\n", "model.obj:5: a face of 0 corners: at least 3 are needed; 2 faces are left out");
    expect("f 1 2 7\nf 1 2 8\n", "model.obj:5: vertex index 7: there are 4; 2 faces are left out");
    expect("f 1/2/3/ 2.5 3\n", "model.obj:5: a vertex index must be a whole number");
    expect("v 0 nan 0\nf 1 2 5\n", "model.obj:5: v must have three finite numbers (\"v 0 nan 0\"); 1 face is left out");
    expect("v 0 nan 0\nvn inf 0 0\nvt x\n", "");
    const auto expectAttribute = [&](const std::string& text, const std::string& notice) {
        const ObjModel model = load(kSquare + text);
        ASSERT_EQ(model.parts.size(), 1u) << text;
        EXPECT_TRUE(model.parts[0].mesh.uvs.empty() && model.parts[0].mesh.normals.empty()) << text;
        EXPECT_TRUE(hasNotice(model, notice)) << text << (model.notices.empty() ? "" : model.notices[0]);
    };
    expectAttribute("f 1//1 2//1 3//1\nf 1//2 3//2 4//2\n",
                    "model.obj:5: normal index 1: there are 0; 2 faces do without their normals");
    expectAttribute("vt 0 0\nf 1/2 2/1 3/1\n",
                    "model.obj:6: texture coordinate index 2: there is 1; 1 face does without texture coordinates");
    expectAttribute("vn 0 0 nan\nf 1//1 2//1 3//1\n",
                    "model.obj:5: vn must have three finite numbers (\"vn 0 0 nan\"); 1 face does without its");
    expectAttribute("f 1//-1 2//-1 3//-1\n",
                    "model.obj:5: normal index -1: there are 0 so far; 1 face does without its normals");
    expectAttribute("vt\nf 1/1 2/1 3/1\n", "model.obj:5: vt must have one or two finite numbers (\"vt\")");
    expectAttribute("vt 0\nf 1/x 2/1 3/1\n", "model.obj:6: texture coordinate indices must be whole numbers (\"1/x\")");
}

TEST_F(ObjFaces, FacesMayComeBeforeWhatTheyReferTo) {
    const std::string attributes = "vt 0 0\nvt 1 0\nvt 1 1\nvn 0 0 1\n", face = "f 1/1/1 2/2/1 3/3/1\n";
    const MeshData usual = load(kSquare + attributes + face).parts.at(0).mesh;
    for (const std::string& text : {face + kSquare + attributes, kSquare + face + attributes,
                                    attributes + face + kSquare, "s 1\n" + attributes + face + kSquare}) {
        const ObjModel model = load(text);
        ASSERT_EQ(model.parts.size(), 1u);
        EXPECT_EQ(model.parts[0].mesh, usual) << text;
        EXPECT_TRUE(model.notices.empty());
    }
}

TEST_F(ObjFaces, WhatIsNoFaceIsLeftOutByName) {
    EXPECT_NE(errorOf(kSquare + "l 1 2\np 1\nl 3 4\n")
                  .find("there is no face in it, and nothing else can be rendered: "
                        "2 lines, 1 point"),
              std::string::npos);
    const ObjModel model = load("v 0 0 0 1 0 0\nv 1 0 0 1 0 0\nv 1 1 0 0 1 0\n l 1 2\nf 1 2 3\n");
    ASSERT_EQ(model.notices.size(), 1u);
    EXPECT_NE(model.notices[0].find("left out, as only faces are rendered: 1 line"), std::string::npos);
}

} // namespace
} // namespace rt::scene
