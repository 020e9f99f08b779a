// Models of illumination and factors of MTL files.
#include <string>
#include <variant>

#include <gtest/gtest.h>

#include "Common/Scene/Compiler/SceneCompiler.h"
#include "Common/Scene/Json/SceneJson.h"
#include "Common/Scene/Obj/ObjLoader.h"
#include "tests/unit/MtlFolder.h"

namespace rt::scene {
namespace {

class MtlModels : public test::MtlFolder {};

TEST_F(MtlModels, ColoursOfVerticesMultiplyWhatIsUnlit) {
    write("b.mtl", "newmtl m\nKd 0.5 0.5 0.5\nillum 0\n");
    model = load("mtllib b.mtl\nusemtl m\nv 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 0 1 0 0 0 1\nf 1 2 3\n");
    EXPECT_EQ(model.parts.at(0).mesh.colors.size(), 3u);
    EXPECT_TRUE(model.materials.at("m").principled.emitsColors);
    EXPECT_TRUE(model.notices.empty());
}

// The eleven models of the specification, as docs/obj.md lists them.
TEST_F(MtlModels, ModelsOfIllumination) {
    const std::string full = "Kd 0.25 0.5 0.75\nKs 0.5 0.5 0.5\nNs 250\nNi 1.25\n";
    const auto of = [&](int model, const std::string& statements) {
        return material(statements + "illum " + std::to_string(model) + "\n");
    };
    MaterialDesc m = of(0, full);
    EXPECT_EQ(m.emission, glm::dvec3(0.25, 0.5, 0.75));
    EXPECT_EQ(std::get<glm::dvec3>(m.albedo), glm::dvec3(0));
    EXPECT_EQ(m.principled.specular.factor, 0);
    EXPECT_EQ(m.sides, Sides::Both);
    EXPECT_TRUE(model.parts.at(0).isUnlit);
    auto compiled = compileScene(loadObjScene(folder / "a.obj"));
    EXPECT_TRUE(compiled->lights.empty()) << "it is no light";
    EXPECT_EQ(compiled->materials.at(0).emission, shared::vec3(0.25f, 0.5f, 0.75f));
    write("a.json", R"({"objects": [{"type": "mesh", "file": "a.obj"}]})");
    EXPECT_TRUE(compileScene(loadSceneFile(folder / "a.json"))->lights.empty());
    EXPECT_EQ(of(0, full + "d 0.5\n").principled.opacity.factor, 0.5);
    m = of(0, "Kd 0.5 0.5 0.5\nKe 2 2 2\n");
    EXPECT_EQ(m.emission, glm::dvec3(2)) << "light outweighs";
    EXPECT_FALSE(model.parts.at(0).isUnlit);
    EXPECT_EQ(of(1, full).kind, MaterialKind::Lambertian);
    EXPECT_EQ(of(1, "Kd 1 1 1\nPr 0.5\n").principled.specular.factor, 0) << "no highlight, whoever says";
    for (const int model : {2, 10}) EXPECT_EQ(of(model, full), material(full));
    of(10, full);
    EXPECT_TRUE(notices("that only shadows are seen (illum 10) of 1 material is left out"));
    for (const int model : {3, 5, 8}) {
        EXPECT_EQ(of(model, "Ks 0.5 0.5 0.5\n").kind, MaterialKind::Metal);
        EXPECT_EQ(of(model, "Kd 0.25 0.5 0.75\n").kind, MaterialKind::Lambertian) << "it mirrors nothing";
        m = of(model, full);
        EXPECT_EQ(m.kind, MaterialKind::Principled) << "a mirror above Kd";
        EXPECT_EQ(std::get<glm::dvec3>(m.albedo), glm::dvec3(0.25, 0.5, 0.75));
        EXPECT_NEAR(test::reflectance(m.principled).x, 0.5, 1e-12);
        EXPECT_EQ(m.principled.roughness.factor, 0);
        EXPECT_EQ(of(model, "Kd 1 1 1\nKs 0.9 0.8 0.7\n").kind, MaterialKind::Metal) << "hardly anything gets below";
    }
    for (const int model : {6, 7}) {
        m = of(model, full + "Tf 1 0.5 1\n");
        EXPECT_EQ(m.kind, MaterialKind::Dielectric);
        EXPECT_EQ(std::get<glm::dvec3>(m.albedo), glm::dvec3(1, 0.5, 1));
        EXPECT_EQ(m.parameters[shared::kDielectricIor], 1.25);
    }
    for (const int model : {4, 9}) {
        EXPECT_EQ(of(model, "Ni 1.25\nTf 1 1 1\n").kind, MaterialKind::Dielectric);
        EXPECT_EQ(of(model, "Kd 0.25 0.5 0.75\nKa 0 0 0\nTf 1 1 1\nNi 1\n").kind, MaterialKind::Lambertian);
        EXPECT_EQ(of(model, full + "d 0.5\n"), material(full + "d 0.5\n")) << "it fades by d";
    }
}

TEST_F(MtlModels, FactorsAndFiltersThatAreEasilyLost) {
    write("s.png", "");
    MaterialDesc m = material("Kd 0 0 0\nmap_Ks s.png\n");
    EXPECT_EQ(m.principled.specular.factor, 1) << "a map without Ks is one of white";
    EXPECT_EQ(std::get<std::string>(m.principled.specularColor), "m/map_Ks");
    material("Kd 1 1 1\nd 0.5\nTf 1 0 0\n");
    EXPECT_TRUE(notices("the colour of what passes through (Tf) of 1 material is left out"));
    material("Kd 1 1 1\nd 0.5\nTf 1 0 0\nnewmtl other\nKd 1 1 1\nd 0.5\nTf 1 0 0\n");
    EXPECT_TRUE(notices("(Tf) of 1 material is left out")) << "of those that faces have";
    material("Kd 1 1 1\nd 0.5\nTf 1 1 1\n");
    EXPECT_TRUE(model.notices.empty());
    EXPECT_EQ(material("Kd 1 1 1\nTr 1\n").principled.opacity.factor, 0);
    EXPECT_TRUE(notices(R"(materials that nothing is seen of, as d is 0 or Tr 1: "m")"));
    EXPECT_EQ(material("Kd 1 1 1\nTr 1\nd 1\n").kind, MaterialKind::Lambertian) << "d counts";
}

} // namespace
} // namespace rt::scene
