// MTL files: what becomes of materials, and what is found in the wild.
#include <algorithm>
#include <cmath>
#include <fstream>
#include <random>
#include <set>

#include <gtest/gtest.h>

#include "Common/Core/Error.h"
#include "Common/Core/Printable.h"
#include "Common/Scene/Compiler/SceneCompiler.h"
#include "Common/Scene/Json/SceneJson.h"
#include "Common/Scene/Obj/ObjLoader.h"
#include "tests/unit/MtlFolder.h"

namespace rt::scene {
namespace {

using test::kTriangle;

class ObjMaterials : public test::MtlFolder {};

// ---- what is missing -----------------------------------------------------------------------------------------------

TEST_F(ObjMaterials, WhatIsInNoFileIsGreyWithANotice) {
    model = load("usemtl Default\n" + kTriangle +
                 "usemtl b\nf 1/1 2/2 3/3\nusemtl c\nf 3/1 2/2 1/3\nusemtl d\nf 2/1 3/2 1/3\n");
    ASSERT_EQ(model.parts.size(), 1u);
    EXPECT_EQ(model.parts[0].material, "");
    EXPECT_EQ(model.parts[0].mesh.triangles.size(), 4u);
    ASSERT_EQ(model.notices.size(), 1u);
    EXPECT_TRUE(notices(R"("Default", "b", "c" and 1 other)"));
    const SceneDesc scene = loadObjScene(folder / "a.obj");
    EXPECT_EQ(scene.materials.size(), 1u);
    EXPECT_EQ(scene.materials.begin()->second, plainMaterial());

    model = load("mtllib gone.mtl other.mtl\n" + kTriangle);
    EXPECT_TRUE(notices(R"(material files that do not exist: "gone.mtl" and "other.mtl")"));
    const MaterialDesc m = material("Kd 1 0 0\nmap_Kd C:\\from\\elsewhere.png\nmap_d\n");
    EXPECT_EQ(std::get<glm::dvec3>(m.albedo), glm::dvec3(1, 0, 0));
    EXPECT_EQ(m.kind, MaterialKind::Lambertian) << "map_d without a name is none";
    EXPECT_TRUE(notices("images that do not exist"));
    EXPECT_TRUE(model.textures.empty());
    write("elsewhere.png", "");
    EXPECT_EQ(image(std::get<std::string>(material("map_Kd C:\\from\\elsewhere.png\n").albedo)).tint, glm::dvec3(1));
    EXPECT_EQ(image("m/map_Kd").file, (folder / "elsewhere.png").generic_string());
}

TEST_F(ObjMaterials, FilesOfMaterialsAreFoundByTheirWholeNameOrEachByItsOwn) {
    write("two words.mtl", "newmtl x\nKd 1 0 0\n");
    write("y.mtl", "newmtl y\nKd 0 1 0\n");
    write("z.mtl", "newmtl z\nKd 0 0 1\n");
    model = load("usemtl z\n" + kTriangle + "mtllib two words.mtl \nmtllib y.mtl .\\z.mtl\r\nmtllib y.mtl\n");
    EXPECT_EQ(model.materials.size(), 3u);
    EXPECT_EQ(model.parts.at(0).material, "z") << "a file may be named behind what uses it";
    EXPECT_TRUE(model.notices.empty());
}

TEST_F(ObjMaterials, NamesAreTrimmedAndPrintable) {
    write("a.mtl",
          "newmtl  Hard Shiny \t\nKd 1 0 0\nnewmtl Terraind\xe4k\nKd 0 1 0\nnewmtl Terraind\\xe4k\nKd 0 0 1\n"
          "newmtl\nKd 1 1 1\nnewmtl \nKd 1 1 1\n");
    model = load("mtllib a.mtl\nusemtl Hard Shiny\n" + kTriangle + "usemtl \t Terraind\xe4k \nf 1/1 2/2 3/3\n" +
                 "usemtl Terraind\\xe4k\nf 1/1 2/2 3/3\nusemtl \nf 3/3 2/2 1/1\n");
    EXPECT_EQ(model.materials.size(), 3u);
    EXPECT_TRUE(model.notices.empty()) << model.notices[0];
    ASSERT_EQ(model.parts.size(), 4u);
    const auto colorOf = [&](std::size_t part) {
        return std::get<glm::dvec3>(model.materials.at(model.parts[part].material).albedo);
    };
    EXPECT_EQ(model.parts[0].material, "");
    EXPECT_EQ(model.parts[1].material, "Hard Shiny");
    EXPECT_EQ(colorOf(2) + colorOf(3), glm::dvec3(0, 1, 1)) << "two names that print alike are two materials";
    for (const ObjPart& part : model.parts) EXPECT_EQ(printable(part.material), part.material);
    SceneDesc scene = loadObjScene(folder / "a.obj");
    SceneDesc again = parseScene(toJson(scene), "again.json", {});
    again.id = scene.id;
    EXPECT_EQ(again, scene);
}

TEST_F(ObjMaterials, PathsThatNoSceneFileCanHoldAreSaid) {
    SceneDesc scene;
    scene.textures["t"] = ImageTexture{"/tmp/\xe4.png", {}};
    try {
        toJson(scene);
        FAIL();
    } catch (const InputError& error) {
        EXPECT_STREQ(error.what(), "a scene file cannot hold \"/tmp/\\xe4.png\": it must be valid UTF-8");
    }
}

// ---- what materials say --------------------------------------------------------------------------------------------

TEST_F(ObjMaterials, WhatALambertianCanSayIsALambertian) {
    MaterialDesc usual;
    usual.albedo = glm::dvec3(0.25, 0.5, 0.75);
    for (const char* more : {"", "Ka 1 1 1\nNs 96\nNi 1.45\nd 1\nillum 2\n", "Ks 0 0 0\n", "illum 1\nKs 0.5 0.5 0.5\n",
                             "Tr 0\n", "Ps 0\nPc 0\nPcr 0.5\n", "d 1\nTr 1\n", "map_Bump\n"})
        EXPECT_EQ(material("Kd 0.25 0.5 0.75\n" + std::string(more)), usual) << more;
    EXPECT_EQ(std::get<glm::dvec3>(material("kd 0.5 # grey\n").albedo), glm::dvec3(0.5)) << "one number is three";
    EXPECT_EQ(std::get<glm::dvec3>(material("Ns 10\n").albedo), std::get<glm::dvec3>(plainMaterial().albedo));
    EXPECT_EQ(std::get<glm::dvec3>(material("Ke 1 1 1\n").albedo), glm::dvec3(0));
}

TEST_F(ObjMaterials, SpecularReflectionIsBlenders) {
    const MaterialDesc m =
        material("Kd 0.8 0.8 0.8\nKs 0.5 0.5 0.5\nNs 250\nNi 1.45\nillum 2\n"); // Blender's usual one
    EXPECT_EQ(m.kind, MaterialKind::Principled);
    EXPECT_EQ(m.principled.specular.factor, 1);
    EXPECT_EQ(m.principled.ior, 1.45);
    EXPECT_NEAR(m.principled.roughness.factor, 0.5, 1e-12);
    EXPECT_EQ(m.principled.metallic.factor, 0);
    EXPECT_EQ(std::get<glm::dvec3>(m.albedo), glm::dvec3(0.8));

    // 0.08 Ks, whatever parameters say it.
    for (const glm::dvec3& ks : {glm::dvec3(0.05), glm::dvec3(0.5, 0.25, 0), glm::dvec3(0.9, 0.3, 1)}) {
        const std::string text = std::to_string(ks.x) + " " + std::to_string(ks.y) + " " + std::to_string(ks.z);
        const PrincipledDesc p = material("Kd 1 1 1\nKs " + text + "\n").principled;
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(test::reflectance(p)[c], 0.08 * ks[c], 1e-12);
        EXPECT_EQ(p.specular.factor, std::min(1.0, 2 * std::max({ks.x, ks.y, ks.z}))) << "at grazing angles";
        EXPECT_EQ(p.roughness.factor, 1);
    }
    EXPECT_EQ(material("Ks 1 1 1\nNs 1000\n").principled.roughness.factor, 0);
    EXPECT_LE(material("Ks 1 1 1\nNi 1000\n").principled.ior, 10);
}

TEST_F(ObjMaterials, ThePhysicallyBasedExtensionIsPrincipled) {
    MaterialDesc m = material("Kd 0.9 0.6 0.3\nPr 0.4\nPm 0.75\nPs 0.2\nPc 0.5\nPcr 0.1\nillum 3\nKs 0.5 0.5 0.5\n");
    EXPECT_EQ(m.kind, MaterialKind::Principled) << "Pm outweighs illum";
    EXPECT_EQ(std::get<glm::dvec3>(m.albedo), glm::dvec3(0.9, 0.6, 0.3));
    EXPECT_EQ(m.principled.roughness.factor, 0.4);
    EXPECT_EQ(m.principled.metallic.factor, 0.75);
    EXPECT_EQ(std::get<glm::dvec3>(m.principled.sheenColor), glm::dvec3(0.2));
    EXPECT_EQ(m.principled.clearcoat.factor, 0.5);
    EXPECT_EQ(m.principled.clearcoatRoughness.factor, 0.1);
    m = material("Kd 1 1 1\nPr 0\n");
    EXPECT_EQ(m.kind, MaterialKind::Principled);
    EXPECT_EQ(m.principled.roughness.factor, 0);
    EXPECT_NEAR(test::reflectance(m.principled).x, 0.04, 1e-12) << "a dielectric as glTF's where Ks says nothing";
    EXPECT_EQ(material("Kd 1 1 1\nPr 0.5\nKs 0 0 0\n").principled.specular.factor, 0);
    EXPECT_EQ(material("illum 3\nKs 1 1 1\nPr 0.25\n").kind, MaterialKind::Metal);
    m = material("illum 3\nKs 1 0.5 0.25\nd 0.5\n");
    EXPECT_EQ(m.kind, MaterialKind::Principled) << "metal has no opacity";
    EXPECT_EQ(m.principled.metallic.factor, 1);
    EXPECT_EQ(std::get<glm::dvec3>(m.albedo), glm::dvec3(1, 0.5, 0.25));
    EXPECT_EQ(material("illum 7\nNi 1.33\nd 0.2\n").kind, MaterialKind::Dielectric);
    m = material("illum 7\nNi 1.33\nPr 0.3\nTf 1 0.5 1\n");
    EXPECT_EQ(m.kind, MaterialKind::Principled) << "dielectric has no roughness";
    EXPECT_EQ(m.principled.transmission.factor, 1);
    EXPECT_EQ(m.principled.ior, 1.33);
    EXPECT_EQ(m.principled.roughness.factor, 0.3);
    EXPECT_EQ(std::get<glm::dvec3>(m.albedo), glm::dvec3(1, 0.5, 1));
}

TEST_F(ObjMaterials, OpacityAndItsMap) {
    for (const char* text :
         {"Kd 1 1 1\nd 0.25\n", "Kd 1 1 1\nTr 0.75\n", "Kd 1 1 1\nTr 0.1\nd 0.25\n", "Kd 1 1 1\nd 0.25\nTr 0.1\n"}) {
        const MaterialDesc m = material(text);
        EXPECT_EQ(m.kind, MaterialKind::Principled);
        EXPECT_EQ(m.principled.opacity.factor, 0.25) << text;
        EXPECT_EQ(m.principled.specular.factor, 0) << "else a lambertian";
    }
    write("leaf.png", "");
    write("mask.png", "");
    EXPECT_EQ(material("map_Kd leaf.png\nmap_d leaf.png\n").principled.opacity.channel, Channel::Alpha);
    EXPECT_EQ(material("map_Kd leaf.png\nmap_d mask.png\n").principled.opacity.channel, Channel::Red);
    EXPECT_EQ(material("map_Kd leaf.png\nmap_d -imfchan m mask.png\n").principled.opacity.channel, Channel::Alpha);
    EXPECT_EQ(material("map_Kd leaf.png\nmap_d -imfchan g mask.png\n").principled.opacity.channel, Channel::Green);
    EXPECT_EQ(image(material("d 0.5\nmap_d mask.png\n").principled.opacity.texture).colorSpace, ColorSpace::Linear);
}

TEST_F(ObjMaterials, MapsAndTheirOptions) {
    for (const char* name : {"a b.png", "s.png", "r.png", "n.png"}) write(name, "");
    MaterialDesc m = material(
        "Kd 0 0 0\nmap_Kd -blendu on -s 2 3 -o 0.5 0.25 -mm 0 1 -clamp on a b.png \r\n"
        "Ks 0.5 0.5 0.5\nmap_Ks s.png\nmap_Pr -s 4 4 4 r.png\nPm 0\nmap_Pm r.png\nmap_Ns s.png\n"
        "norm n.png\nmap_Bump -bm 0.5 s.png\nmap_Ps s.png\nmap_Ke r.png\ndisp s.png\n");
    const ImageTexture& colors = image(std::get<std::string>(m.albedo));
    EXPECT_EQ(colors.file, (folder / "a b.png").generic_string());
    EXPECT_EQ(colors.tint, glm::dvec3(1)) << "a factor of 0 beside a map is none";
    EXPECT_EQ(colors.uvTransform, (std::array<double, 6>{2, 0, 0.5, 0, 3, 0.25}));
    EXPECT_EQ(colors.wrapU, Wrap::Clamp);
    const ImageTexture& roughness = image(m.principled.roughness.texture);
    EXPECT_EQ(roughness.uvTransform, (std::array<double, 6>{4, 0, 0, 0, 4, 0}));
    EXPECT_EQ(roughness.wrapV, Wrap::Repeat);
    EXPECT_EQ(roughness.colorSpace, ColorSpace::Linear);
    EXPECT_EQ(m.principled.roughness.factor, 1);
    EXPECT_EQ(m.principled.metallic.factor, 1);
    EXPECT_EQ(image(std::get<std::string>(m.principled.specularColor)).colorSpace, ColorSpace::Srgb);
    EXPECT_EQ(image(std::get<std::string>(m.principled.sheenColor)).colorSpace, ColorSpace::Linear);
    EXPECT_EQ(m.principled.normalTexture, "m/norm") << "it outweighs bumps";
    EXPECT_EQ(m.emission, glm::dvec3(1));
    EXPECT_TRUE(notices("map_Ns")) << "by name";
    EXPECT_TRUE(notices("displacement"));
    ASSERT_EQ(model.parts.size(), 1u);
    ASSERT_EQ(model.parts[0].mesh.tangents.size(), 3u);
    EXPECT_EQ(model.parts[0].mesh.tangents[0], glm::dvec4(1, 0, 0, 1)) << "along growing u";
    m = material("bump -bm 0.5 n.png\n");
    EXPECT_EQ(m.principled.normalTexture, "m/map_Bump");
    EXPECT_EQ(m.principled.normalScale, 0.5);
}

TEST_F(ObjMaterials, MapsOfHeightsAreLeftOut) {
    write("n.png", "");
    material("bump n.png\n");
    CompileOptions options;
    std::uint32_t texel = 0;
    options.loadTexels = [&](const std::filesystem::path&, std::optional<std::uint32_t>) {
        return TexelData{2, 1, shared::kTexelSrgb8, {texel, texel}};
    };
    const auto normals = [&] {
        const auto scene = compileScene(loadObjScene(folder / "a.obj"), options);
        const bool isSaid = std::ranges::any_of(
            scene->notices, [](const std::string& n) { return n.find("map of heights") != n.npos; });
        EXPECT_EQ(isSaid, scene->principled.at(0).normalTexture == shared::kNone);
        return scene->principled.at(0).normalTexture != shared::kNone;
    };
    texel = 0xff808080u;
    EXPECT_FALSE(normals());
    texel = 0xff828081u; // as JPEG leaves it
    EXPECT_FALSE(normals());
    texel = 0xffff8080u; // straight up
    EXPECT_TRUE(normals());
}

// ---- what is wrong -------------------------------------------------------------------------------------------------

TEST_F(ObjMaterials, WhatIsBrokenIsLeftOutWithFileAndLine) {
    const auto expect = [&](const std::string& statements, const std::string& notice) {
        EXPECT_EQ(errorOf(statements), "no error");
        EXPECT_TRUE(notices("a.mtl:" + notice)) << (model.notices.empty() ? "no notice" : model.notices[0]);
    };
    expect("Kd 1 x 1\n", "2: Kd: \"x\" is not a finite number; 1 statement is left out");
    EXPECT_EQ(model.materials.at("m"), plainMaterial());
    expect("Kd 1 1 1\r\n\r\n# c\r\nKs nan 0 0\r\n", "5: Ks: \"nan\" is not a finite number");
    EXPECT_EQ(std::get<glm::dvec3>(model.materials.at("m").albedo), glm::dvec3(1));
    expect("Kd 1 1\nNs\n", "2: Kd: a number is missing; 2 statements are left out");
    expect("d 0,5\n", "2: d: \"0,5\" is not a finite number");
    expect("illum 11\n", "2: illum: the models of illumination are 0 to 10");
    EXPECT_EQ(errorOf("Kd 1e999 -3 1e-999\n"), "no error");
    EXPECT_EQ(std::get<glm::dvec3>(model.materials.at("m").albedo), glm::dvec3(1, 0, 0));
    EXPECT_EQ(errorOf("Kd spectral file.rfl\naniso 0.5\nd -halo 0.5\n"), "no error");
    EXPECT_TRUE(notices("a colour by its spectrum or in CIE XYZ of 1 material is left out"));
    EXPECT_TRUE(notices("anisotropy") && notices("-halo"));
}

TEST_F(ObjMaterials, DamagedFilesDoNoHarm) {
    write("n.png", "");
    const std::string text =
        "Kd 1 0 0\nKs 0.5 0.5 0.5\nNs 100\nd 0.5\nillum 2\nPr 0.5\nPm 1\nmap_Kd -s 2 2 2 -o 1 n.png\n"
        "bump -bm 2 n.png\nmap_d -imfchan m n.png\nnewmtl n\nKe 1 1 1\nillum 7\nPr 1\nTf 1 0 1\n";
    std::mt19937 random(1);
    for (int i = 0; i < 1000; ++i) {
        std::string damaged = text.substr(0, i % 2 == 0 ? text.size() : random() % text.size());
        for (int k = 0; k < 3 && !damaged.empty(); ++k)
            damaged[random() % damaged.size()] = static_cast<char>(random());
        if (errorOf(damaged) != "no error") continue;
        for (const auto& [name, m] : model.materials) {
            const PrincipledDesc& p = m.principled;
            EXPECT_TRUE(p.ior >= 1 && p.ior <= 10 && std::isfinite(p.normalScale)) << damaged;
            for (const double number : {p.roughness.factor, p.metallic.factor, p.specular.factor, p.opacity.factor})
                EXPECT_TRUE(number >= 0 && number <= 1) << damaged;
        }
        SceneDesc scene = loadObjScene(folder / "a.obj");
        EXPECT_NO_THROW(parseScene(toJson(scene), "again.json", {})) << damaged;
    }
}

// Files nobody here wrote, from Debian's package assimp-testmodels. Each release has others: whatever there is, is read
// or refused in one line, and those that releases have in common are known.
TEST_F(ObjMaterials, FilesOfOthers) {
    const std::filesystem::path models = "/usr/share/assimp/models";
    if (!std::filesystem::exists(models)) GTEST_SKIP() << "assimp-testmodels is not installed";
    const std::set<std::string> faceless = {"point_cloud.obj", "testline.obj", "testpoints.obj", "empty.obj"};
    const std::set<std::string> known = {"WusonOBJ.obj",
                                         "box.obj",
                                         "box_UTF16BE.obj",
                                         "box_longline.obj",
                                         "box_mat_with_spaces.obj",
                                         "box_without_lineending.obj",
                                         "concave_polygon.obj",
                                         "cube_mtllib_after_g.obj",
                                         "cube_usemtl.obj",
                                         "cube_with_vertexcolors.obj",
                                         "multiple_spaces.obj",
                                         "number_formats.obj",
                                         "regr01.obj",
                                         "spider.obj"};
    std::size_t files = 0, read = 0;
    for (const auto& file : std::filesystem::recursive_directory_iterator(models)) {
        if (file.path().extension() != ".obj") continue;
        ++files;
        const std::string name = file.path().filename().string();
        try {
            const SceneDesc scene = loadObjScene(file.path());
            EXPECT_EQ(faceless.count(name), 0u) << name;
            ++read;
            EXPECT_FALSE(scene.objects.empty()) << name;
            SceneDesc again = parseScene(toJson(scene), "again.json", {});
            again.id = scene.id;
            again.notices = scene.notices;
            EXPECT_EQ(again, scene) << name;
        } catch (const InputError& error) {
            const std::string message = error.what();
            EXPECT_EQ(message.find(file.path().string()), 0u) << message;
            EXPECT_EQ(message.find('\n'), message.npos) << message;
            EXPECT_EQ(known.count(name), 0u) << message;
            EXPECT_TRUE(faceless.count(name) == 0 || message.find("there is no face in it") != message.npos) << message;
        }
    }
    EXPECT_GE(read, 10u) << "of " << files << ": the package has moved its models, and this test sees nothing";
}

} // namespace
} // namespace rt::scene
