// MaterialX documents: what becomes of their inputs, what is said of others, and that what is written is read again.
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>

#include "Common/App/Interactive/MaterialPresets.h"
#include "Common/Core/Error.h"
#include "Common/Scene/MaterialX/MaterialXLoader.h"
#include "Common/Scene/MaterialX/MaterialXModels.h"
#include "Common/Scene/MaterialX/MaterialXWriter.h"
#include "tests/TempFolder.h"
#include "tests/unit/CompilerScenes.h"

namespace rt::scene {
namespace {

namespace fs = std::filesystem;
using glm::dvec3;

#ifdef RT_HAS_PUGIXML

std::string document(const std::string& nodes) {
    return "<?xml version=\"1.0\"?>\n<materialx version=\"1.39\" colorspace=\"lin_rec709\">\n" + nodes +
           "\n</materialx>\n";
}

// One surface with these inputs, as a material M; the nodes stand before it.
std::string surface(const std::string& node, const std::string& inputs, const std::string& nodes = "") {
    return document(nodes + "<" + node + " name=\"S\" type=\"surfaceshader\">" + inputs + "</" + node +
                    "><surfacematerial name=\"M\" type=\"material\"><input name=\"surfaceshader\" "
                    "type=\"surfaceshader\" nodename=\"S\"/></surfacematerial>");
}
std::string input(const std::string& name, const std::string& type, const std::string& value) {
    return "<input name=\"" + name + "\" type=\"" + type + "\" value=\"" + value + "\"/>";
}
std::string linked(const std::string& name, const std::string& type, const std::string& node) {
    return "<input name=\"" + name + "\" type=\"" + type + "\" nodename=\"" + node + "\"/>";
}

class MaterialX : public testing::Test {
  protected:
    MaterialX() { std::ofstream(folder_.path() / "wood.png") << "the reader only asks whether it is there"; }

    SceneDesc read(const std::string& text) const { return parseMaterialX(text, "f.mtlx", folder_.path()); }
    MaterialDesc material(const std::string& text) const {
        const SceneDesc scene = read(text);
        EXPECT_TRUE(scene.notices.empty()) << scene.notices.front();
        return scene.materials.at("M");
    }
    std::string noticeOf(const std::string& text) const {
        const SceneDesc scene = read(text);
        return scene.notices.size() == 1 ? scene.notices.front() : std::to_string(scene.notices.size()) + " notices";
    }
    std::string errorOf(const std::string& text) const {
        try {
            read(text);
        } catch (const InputError& error) {
            return error.what();
        }
        return "no error";
    }
    std::string wood() const { return (fs::absolute(folder_.path()) / "wood.png").lexically_normal().generic_string(); }

    test::TempFolder folder_;
};

TEST_F(MaterialX, TheDefaultsAreThoseOfTheModels) {
    const MaterialDesc open = material(surface("open_pbr_surface", ""));
    EXPECT_EQ(std::get<dvec3>(open.albedo), dvec3(0.8));
    EXPECT_EQ(open.principled.roughness.factor, 0.3);
    EXPECT_EQ(open.principled.metallic.factor, 0);
    const MaterialDesc standard = material(surface("standard_surface", ""));
    EXPECT_EQ(std::get<dvec3>(standard.albedo), dvec3(0.8));
    EXPECT_EQ(standard.principled.roughness.factor, 0.2);
    EXPECT_EQ(standard.emission, dvec3(0));
    const MaterialDesc gltf = material(surface("gltf_pbr", ""));
    EXPECT_EQ(std::get<dvec3>(gltf.albedo), dvec3(1));
    EXPECT_EQ(gltf.principled.roughness.factor, 1);
    EXPECT_EQ(gltf.principled.metallic.factor, 1);
}

// What is a product there is one here, and what has another measure is brought to ours.
TEST_F(MaterialX, InputsBecomeParameters) {
    const MaterialDesc paint =
        material(surface("standard_surface",
                         input("base", "float", "0.5") + input("base_color", "color3", "1, 0.5, 0") +
                             input("metalness", "float", "0.25") + input("specular_IOR", "float", "1.7") +
                             input("coat", "float", "0.5") + input("coat_color", "color3", "1, 1, 0") +
                             input("sheen", "float", "0.5") + input("sheen_color", "color3", "1, 0, 1") +
                             input("sheen_roughness", "float", "0.25") + input("emission", "float", "3") +
                             input("emission_color", "color3", "1, 0.5, 0") + input("opacity", "color3", "1, 0, 0")));
    const PrincipledDesc& p = paint.principled;
    expectNear(std::get<dvec3>(paint.albedo), {0.5, 0.25, 0}, 1e-12);
    EXPECT_EQ(p.metallic.factor, 0.25);
    EXPECT_EQ(p.ior, 1.7);
    EXPECT_EQ(p.clearcoat.factor, 0.5);
    EXPECT_EQ(p.clearcoatRoughness.factor, 0.1);
    EXPECT_EQ(std::get<dvec3>(p.sheenColor), dvec3(0.5, 0, 0.5));
    EXPECT_EQ(p.sheenRoughness.factor, 0.5); // squared, it is theirs
    EXPECT_EQ(paint.emission, dvec3(3, 1.5, 0));
    EXPECT_NEAR(p.opacity.factor, 0.2126, 1e-12);

    const MaterialDesc glass =
        material(surface("open_pbr_surface", input("transmission_weight", "float", "1") +
                                                 input("transmission_color", "color3", "0.5, 1, 0.5") +
                                                 input("transmission_depth", "float", "2")));
    EXPECT_EQ(std::get<dvec3>(glass.albedo), dvec3(1));
    EXPECT_EQ(glass.principled.attenuationColor, dvec3(0.5, 1, 0.5));
    EXPECT_EQ(glass.principled.attenuationDistance, 2);
    EXPECT_FALSE(glass.principled.isThin);
    const MaterialDesc pane =
        material(surface("gltf_pbr", input("transmission", "float", "1") + input("metallic", "float", "0")));
    EXPECT_TRUE(pane.principled.isThin);
    const MaterialDesc leaf =
        material(surface("gltf_pbr", input("alpha", "float", "0.25") + input("alpha_mode", "integer", "1")));
    EXPECT_EQ(leaf.principled.opacity.factor, 0.25);
    EXPECT_EQ(leaf.principled.alphaCutoff, 0.5);
}

TEST_F(MaterialX, ColorsInTheEncodingOfSrgbAreDecoded) {
    const std::string base =
        "<input name=\"base_color\" type=\"color3\" value=\"0.5, 0, 1\" colorspace=\"srgb_texture\"/>";
    expectNear(std::get<dvec3>(material(surface("gltf_pbr", base)).albedo), {0.214041, 0, 1}, 1e-5);
}

// As downloads are: a graph of images whose outputs the surface names, with a normal map.
TEST_F(MaterialX, GraphsOfImagesBecomeTextures) {
    const std::string graph =
        "<nodegraph name=\"NG\">" + input("tiling", "vector2", "2, 3") +
        "<tiledimage name=\"color\" type=\"color3\"><input name=\"file\" type=\"filename\" value=\"wood.png\" "
        "colorspace=\"srgb_texture\"/><input name=\"uvtiling\" type=\"vector2\" interfacename=\"tiling\"/></tiledimage>"
        "<image name=\"rough\" type=\"float\">" +
        input("file", "filename", "wood.png") + input("uaddressmode", "string", "mirror") +
        "</image><image name=\"bumps\" type=\"vector3\">" + input("file", "filename", "wood.png") +
        "</image><normalmap name=\"normals\" type=\"vector3\">" + linked("in", "vector3", "bumps") +
        input("scale", "float", "0.5") + "</normalmap>" + "<multiply name=\"half\" type=\"float\">" +
        linked("in1", "float", "rough") + input("in2", "float", "0.5") +
        "</multiply><invert name=\"gloss\" type=\"float\">" + linked("in", "float", "half") +
        "</invert>"
        "<output name=\"c\" type=\"color3\" nodename=\"color\"/><output name=\"r\" type=\"float\" nodename=\"gloss\"/>"
        "<output name=\"n\" type=\"vector3\" nodename=\"normals\"/></nodegraph>";
    const auto from = [](const std::string& name, const std::string& type, const std::string& output) {
        return "<input name=\"" + name + "\" type=\"" + type + "\" nodegraph=\"NG\" output=\"" + output + "\"/>";
    };
    const SceneDesc scene = read(surface("standard_surface",
                                         input("base", "float", "0.5") + from("base_color", "color3", "c") +
                                             from("specular_roughness", "float", "r") + from("normal", "vector3", "n"),
                                         graph));
    EXPECT_TRUE(scene.notices.empty()) << scene.notices.front();
    const MaterialDesc& material = scene.materials.at("M");
    const auto image = [&](const std::string& name) { return std::get<ImageTexture>(scene.textures.at(name)); };
    const ImageTexture color = image(std::get<std::string>(material.albedo));
    EXPECT_EQ(color.file, wood());
    EXPECT_EQ(color.colorSpace, ColorSpace::Srgb);
    EXPECT_EQ(color.tint, dvec3(0.5));
    EXPECT_EQ(color.wrapU, Wrap::Repeat);
    EXPECT_EQ(color.uvTransform, (std::array<double, 6>{2, 0, 0, 0, 3, 0}));
    const NumberOrTexture& roughness = material.principled.roughness;
    EXPECT_EQ(roughness.factor, -0.5); // 1 - 0.5 times the image
    EXPECT_EQ(image(roughness.texture).colorSpace, ColorSpace::Linear);
    EXPECT_EQ(image(roughness.texture).wrapU, Wrap::Mirror);
    EXPECT_EQ(material.principled.normalScale, 0.5);
    EXPECT_EQ(image(material.principled.normalTexture).file, wood());
}

// As version 1.38 has them, in which numbers are packed into one image.
TEST_F(MaterialX, InputsTakeChannelsOfWhatComes) {
    const std::string image =
        "<image name=\"packed\" type=\"vector3\">" + input("file", "filename", "wood.png") + "</image>";
    const auto channel = [](const std::string& name, const std::string& channels) {
        return "<input name=\"" + name + "\" type=\"float\" nodename=\"packed\" channels=\"" + channels + "\"/>";
    };
    const MaterialDesc packed =
        material(surface("gltf_pbr", channel("metallic", "z") + channel("roughness", "g"), image));
    EXPECT_EQ(packed.principled.metallic.channel, Channel::Blue);
    EXPECT_EQ(packed.principled.roughness.channel, Channel::Green);
    EXPECT_EQ(packed.principled.metallic.texture, packed.principled.roughness.texture);
    EXPECT_NE(noticeOf(surface("gltf_pbr", channel("metallic", "zyx"), image)).find("\"zyx\""), std::string::npos);
}

// Of films the thickness in nm, of dispersion 20 over the Abbe number.
TEST_F(MaterialX, FilmsAndDispersionAreOfOneUnit) {
    const std::string open = input("thin_film_weight", "float", "0.5") + input("thin_film_thickness", "float", "0.4") +
                             input("transmission_weight", "float", "1") +
                             input("transmission_dispersion_scale", "float", "0.5") +
                             input("transmission_dispersion_abbe_number", "float", "40");
    const PrincipledDesc a = material(surface("open_pbr_surface", open)).principled;
    EXPECT_EQ(a.iridescence.factor, 0.5);
    EXPECT_EQ(a.iridescenceIor, 1.4);
    EXPECT_NEAR(a.iridescenceThicknessMaximum, 400, 1e-9);
    EXPECT_EQ(a.dispersion, 0.25);
    const std::string standard = input("thin_film_thickness", "float", "550") + input("transmission", "float", "1") +
                                 input("transmission_dispersion", "float", "40");
    const PrincipledDesc b = material(surface("standard_surface", standard)).principled;
    EXPECT_EQ(b.iridescence.factor, 1);
    EXPECT_EQ(b.iridescenceThicknessMaximum, 550);
    EXPECT_EQ(b.dispersion, 0.5);
}

TEST_F(MaterialX, WhatIsLeftOutIsTold) {
    EXPECT_EQ(noticeOf(surface("standard_surface", input("coat_IOR", "float", "1.7"))),
              "f.mtlx: <standard_surface \"S\">: input coat_IOR: left out");
    EXPECT_EQ(noticeOf(surface("standard_surface", input("coat_IOR", "float", "1.5"))), "0 notices");
    EXPECT_EQ(
        noticeOf(surface("gltf_pbr", linked("base_color", "color3", "N"), "<noise2d name=\"N\" type=\"color3\"/>")),
        "f.mtlx: <noise2d \"N\">: left out: only constants and images are read, with multiply, invert, extract "
        "and normalmap");
    EXPECT_EQ(
        noticeOf(surface("gltf_pbr", linked("base_color", "color3", "I"),
                         "<image name=\"I\" type=\"color3\">" + input("file", "filename", "gone.png") + "</image>")),
        "f.mtlx: <image \"I\">: left out: there is no image \"gone.png\"");
    EXPECT_NE(noticeOf(surface("open_pbr_surface", input("base_color", "color3", "2, 0, 0"))).find("its range"),
              std::string::npos);
    const std::string other = "<usd_preview name=\"U\" type=\"surfaceshader\"/><surfacematerial name=\"V\">" +
                              linked("surfaceshader", "surfaceshader", "U") + "</surfacematerial>";
    EXPECT_EQ(noticeOf(surface("gltf_pbr", "", other)),
              "f.mtlx: <surfacematerial \"V\">: left out: its surface is none "
              "of open_pbr_surface, standard_surface, gltf_pbr");
}

TEST_F(MaterialX, MistakesAreOneLineWithTheirPlace) {
    EXPECT_EQ(errorOf(surface("gltf_pbr", input("base_color", "color3", "red"))),
              "f.mtlx:3: <gltf_pbr \"S\">: input base_color: \"red\": must be 3 numbers between commas");
    EXPECT_EQ(errorOf(surface("gltf_pbr", input("base_color", "color3", "1, 1"))),
              "f.mtlx:3: <gltf_pbr \"S\">: input base_color: \"1, 1\": must be 3 numbers between commas");
    EXPECT_EQ(errorOf(surface("gltf_pbr", input("metallic", "float", "nan"))),
              "f.mtlx:3: <gltf_pbr \"S\">: input metallic: \"nan\": must be a number");
    EXPECT_EQ(errorOf(surface("gltf_pbr", linked("metallic", "float", "nobody"))),
              "f.mtlx:3: <gltf_pbr \"S\">: \"nobody\": must be the name of a node beside it");
    EXPECT_EQ(errorOf("<materialx version=\"1.37\"/>"),
              "f.mtlx:1: <materialx>: version \"1.37\": must be 1.38 or a later one of 1");
    EXPECT_EQ(errorOf("<scene/>"), "f.mtlx:1: <scene>: must be <materialx>");
    EXPECT_EQ(errorOf(document("")),
              "f.mtlx:2: <materialx>: has no surface: one of open_pbr_surface, "
              "standard_surface, gltf_pbr");
    EXPECT_EQ(errorOf("<materialx version=\"1.38\">\n<a>\n</b></materialx>").find("f.mtlx:3: no valid XML: "), 0u);
    EXPECT_EQ(errorOf("no document").find("f.mtlx:1: no valid XML: "), 0u);
    std::string deep;
    for (int i = 0; i < 100; ++i) deep += "<a>";
    for (int i = 0; i < 100; ++i) deep += "</a>";
    EXPECT_EQ(errorOf(document(deep)), "f.mtlx:3: elements are nested deeper than 64");
}

TEST_F(MaterialX, CirclesAndMazesOfNodesEnd) {
    const std::string circle = "<multiply name=\"A\" type=\"float\">" + linked("in1", "float", "A") +
                               input("in2", "float", "1") + "</multiply>";
    EXPECT_NE(errorOf(surface("gltf_pbr", linked("metallic", "float", "A"), circle)).find("circle"), std::string::npos);
    std::string maze = "<constant name=\"N0\" type=\"float\">" + input("value", "float", "1") + "</constant>";
    for (int i = 1; i <= 30; ++i) { // 2^30 ways
        const std::string before = "N" + std::to_string(i - 1);
        maze += "<multiply name=\"N" + std::to_string(i) + "\" type=\"float\">" + linked("in1", "float", before) +
                linked("in2", "float", before) + "</multiply>";
    }
    EXPECT_NE(errorOf(surface("gltf_pbr", linked("metallic", "float", "N30"), maze)).find("more than 1000 nodes"),
              std::string::npos);
}

// ---- writing -------------------------------------------------------------------------------------------------------

TEST_F(MaterialX, MaterialsOfTheLibraryAreWrittenAndReadAgain) {
    std::vector<std::string> failures;
    const auto presets = app::readMaterialPresets(fs::path(RT_SOURCE_DIR) / "Assets" / "materials", failures);
    ASSERT_FALSE(presets.empty());
    for (const app::MaterialPreset& preset : presets) {
        std::vector<std::string> notices;
        const SceneDesc again = read(toMaterialX(*preset.scene, preset.name, folder_.path(), notices));
        EXPECT_TRUE(again.notices.empty()) << again.notices.front();
        const MaterialDesc& was = preset.scene->materials.at(preset.name);
        ASSERT_TRUE(again.materials.contains(preset.name)) << "names keep their spaces";
        const MaterialDesc& is = again.materials.at(preset.name);
        if (preset.name == "Bottle glass") { // whose tint of reflections MaterialX does not have
            EXPECT_EQ(notices.size(), 1u);
            continue;
        }
        EXPECT_TRUE(notices.empty()) << preset.name;
        EXPECT_EQ(is.kind, was.kind) << preset.name;
        expectNear(std::get<dvec3>(is.albedo), std::get<dvec3>(was.albedo), 1e-6);
        EXPECT_NEAR(is.principled.roughness.factor, was.principled.roughness.factor, 1e-6) << preset.name;
        EXPECT_NEAR(is.principled.clearcoat.factor, was.principled.clearcoat.factor, 1e-6) << preset.name;
        EXPECT_NEAR(is.principled.ior, was.principled.ior, 1e-6) << preset.name;
    }
}

// Numbers of few digits come back as they are.
TEST_F(MaterialX, EveryParameterIsWrittenAndReadAgain) {
    SceneDesc scene;
    ImageTexture image;
    image.file = wood();
    image.standIn = kWhiteStandIn;
    image.wrapU = Wrap::Repeat;
    image.wrapV = Wrap::Mirror;
    image.uvSet = 1;
    image.tint = {0.5, 1, 0.25};
    scene.textures["color"] = image;
    image.tint = dvec3(1);
    image.colorSpace = ColorSpace::Linear;
    scene.textures["numbers"] = image;
    image.uvSet = 0;
    image.wrapV = Wrap::Repeat;
    image.uvTransform = {2, 0, 0.5, 0, 4, -0.25};
    scene.textures["normals"] = image;
    MaterialDesc& material = scene.materials["Old brick"];
    material.kind = MaterialKind::Principled;
    material.albedo = "color";
    material.emission = {4, 2, 1};
    PrincipledDesc& p = material.principled;
    p.metallic = {0.5, "numbers", Channel::Blue};
    p.roughness = {-0.75, "numbers", Channel::Green};
    p.specular.factor = 0.25;
    p.specularColor = dvec3(1, 0.5, 0.25);
    p.ior = 1.75;
    p.transmission.factor = 0.5;
    p.attenuationColor = {0.5, 0.25, 1};
    p.attenuationDistance = 8;
    p.clearcoat = {1, "numbers", Channel::Alpha};
    p.clearcoatRoughness.factor = 0.125;
    p.clearcoatNormalTexture = "normals";
    p.clearcoatNormalScale = 2;
    p.sheenColor = dvec3(0.25, 0.5, 0.75);
    p.sheenRoughness.factor = 0.375;
    p.normalTexture = "normals";
    p.normalScale = 0.5;
    p.opacity = {1, "numbers", Channel::Red};
    p.alphaCutoff = 0.25;
    p.anisotropy = {0.5, "numbers", Channel::Blue};
    p.anisotropyRotation = 0.75;
    p.iridescence.factor = 0.5;
    p.iridescenceIor = 1.5;
    p.iridescenceThicknessMaximum = 300;
    p.dispersion = 0.25;
    std::vector<std::string> notices;
    const std::string text = toMaterialX(scene, "Old brick", folder_.path(), notices);
    EXPECT_TRUE(notices.empty()) << notices.front();
    EXPECT_NE(text.find("value=\"wood.png\""), std::string::npos) << "named from where the document is";
    const SceneDesc again = read(text);
    EXPECT_TRUE(again.notices.empty()) << again.notices.front();
    MaterialDesc is = again.materials.at("Old brick");
    // Names of textures are those of nodes now, and what they name is the same.
    const auto expectSame = [&](std::string& name, const std::string& was) {
        ASSERT_TRUE(again.textures.contains(name)) << was;
        EXPECT_EQ(again.textures.at(name), scene.textures.at(was)) << was;
        name = was;
    };
    expectSame(std::get<std::string>(is.albedo), "color");
    for (const auto member : {&PrincipledDesc::metallic, &PrincipledDesc::roughness, &PrincipledDesc::clearcoat,
                              &PrincipledDesc::opacity, &PrincipledDesc::anisotropy})
        expectSame((is.principled.*member).texture, "numbers");
    expectSame(is.principled.normalTexture, "normals");
    expectSame(is.principled.clearcoatNormalTexture, "normals");
    EXPECT_EQ(is, material);
}

TEST_F(MaterialX, WhatCannotBeWrittenIsTold) {
    SceneDesc scene = withMaterials();
    scene.textures["squares"] = CheckerTexture{};
    scene.materials["floor"].albedo = "squares";
    scene.materials["blurred"].kind = MaterialKind::Metal;
    scene.materials["blurred"].parameters[0] = 0.1;
    for (const std::string name : {"floor", "blurred"}) {
        std::vector<std::string> notices;
        const SceneDesc again = read(toMaterialX(scene, name, folder_.path(), notices));
        EXPECT_EQ(notices.size(), 1u) << name;
        EXPECT_TRUE(again.materials.contains(name));
    }
    std::vector<std::string> notices;
    const SceneDesc lamp = read(toMaterialX(scene, "lamp", folder_.path(), notices));
    expectNear(lamp.materials.at("lamp").emission, {1, 2, 4}, 1e-6);
    EXPECT_EQ(std::get<dvec3>(lamp.materials.at("lamp").albedo), dvec3(0));
}

#else

TEST(MaterialX, BuildsWithoutTheLibrarySayIt) {
    EXPECT_THROW(parseMaterialX("<materialx version=\"1.38\"/>", "f.mtlx", {}), InputError);
}

#endif

} // namespace
} // namespace rt::scene
