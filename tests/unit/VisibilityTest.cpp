// Hidden objects: the scene is compiled as if they were not there, and files keep them.
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "Common/Scene/Edit/ObjectMotion.h"
#include "Common/Scene/Edit/SceneDocument.h"
#include "Common/Scene/Edit/Visibility.h"
#include "Common/Scene/Json/SceneJson.h"
#include "tests/unit/CompilerScenes.h"
#include "tests/unit/JsonSchema.h"

namespace rt::scene {
namespace {

using Paths = std::vector<ObjectPath>;

ObjectPath pathAt(std::vector<std::uint32_t> indices) {
    return {"", std::move(indices)};
}

SphereDesc round(double x, const std::string& material) {
    SphereDesc sphere;
    sphere.center = {x, 0, -5};
    sphere.radius = 0.5;
    sphere.material = material;
    return sphere;
}

// Of every kind of object one, each at a place of its own.
SceneDesc sceneOfAllKinds() {
    SceneDesc scene = withMaterials();
    scene.textures["map"] = CheckerTexture{};
    scene.materials["checked"] = lambertian(1, 1, 1);
    scene.materials["checked"].albedo = "map";
    SphereSetDesc cloud; // enough for a geometry that instances share
    cloud.material = "matte";
    cloud.radius = 0.1;
    for (int i = 0; i < 100; ++i) cloud.centers.emplace_back(0.01 * i, 0, 0);
    scene.prototypes["cloud"] = {{cloud}, {round(0, "lamp")}};
    QuadDesc quad;
    quad.material = "checked";
    BoxDesc box;
    box.material = "glass";
    DiskDesc disk;
    disk.material = "matte";
    CylinderDesc cylinder;
    cylinder.material = "matte";
    MeshDesc mesh;
    mesh.source = MeshData{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {}, {}, {}, {}, {}, {{0, 1, 2}}};
    mesh.material = "matte";
    MediumDesc medium;
    medium.boundary = SphereBoundary{};
    SphereSetDesc set = cloud;
    set.centers = {{0, 9, 0}, {2, 9, 0}};
    GroupDesc pair = group({Translate{{0, 3, 0}}}, round(1, "matte"));
    pair.objects.push_back({round(2, "lamp")});
    pair.objects.push_back({group({Scale{{1, 2, 1}}}, round(3, "glass"))}); // an ellipsoid
    const InstanceDesc one{"cloud", {Translate{{0, -3, -9}}}, ""}, two{"cloud", {Translate{{0, -6, -9}}}, "glass"};
    scene.objects = {{round(0, "matte")},
                     {set},
                     {quad},
                     {box},
                     {disk},
                     {cylinder},
                     {mesh},
                     {medium},
                     {PointLightDesc{{0, 4, 0}}},
                     {SpotLightDesc{}},
                     {DirectionalLightDesc{}},
                     {pair},
                     {one},
                     {two}};
    return scene;
}

std::uint64_t hashOf(const SceneDesc& scene) {
    return compileScene(scene)->hash;
}

// As if it were not there, in each array of the compiled scene.
TEST(Visibility, WhatIsHiddenCostsNothing) {
    const SceneDesc scene = sceneOfAllKinds();
    Paths paths;
    for (std::uint32_t i = 0; i < scene.objects.size(); ++i) paths.push_back(pathAt({i}));
    paths.insert(paths.end(), {pathAt({11, 0}), pathAt({11, 1}), pathAt({11, 2}), pathAt({11, 2, 0})});
    for (const ObjectPath& path : paths) {
        SceneDocument hiding(scene), removing(scene);
        hiding.perform("Hide", hidden(scene, {path}, true));
        removing.perform("Delete", removed({path}));
        EXPECT_EQ(hashOf(hiding.scene()), hashOf(removing.scene())) << textOf(path);
        EXPECT_NE(hashOf(hiding.scene()), hashOf(scene)) << textOf(path);
        EXPECT_EQ(compileScene(hiding.scene())->features, compileScene(removing.scene())->features) << textOf(path);
        hiding.undo();
        EXPECT_EQ(hiding.scene(), scene);
    }
}

// What is in a prototype is hidden in each of its instances.
TEST(Visibility, PrototypesShowWhatIsShownOfThem) {
    SceneDesc scene = sceneOfAllKinds(), without = scene;
    scene.prototypes["cloud"][1].hidden = true;
    without.prototypes["cloud"].pop_back();
    EXPECT_EQ(hashOf(scene), hashOf(without));
}

// The numbers of objects, by which a picture's primitives are named, are those of all of them.
TEST(Visibility, ObjectsKeepTheirNumbers) {
    const SceneDesc scene = sceneOfAllKinds();
    SceneDocument document(scene);
    document.perform("Hide", hidden(scene, {pathAt({0}), pathAt({11, 1})}, true));
    const auto before = compileScene(scene), after = compileScene(document.scene());
    const Paths paths = {pathAt({0}),     pathAt({2}),  pathAt({11, 0}), pathAt({11, 1}),
                         pathAt({11, 2}), pathAt({12}), pathAt({13})};
    const auto ranges = leavesOf(scene, paths);
    const auto all = boundsOf(*before, ranges), shown = boundsOf(*after, ranges);
    for (std::size_t i = 0; i < paths.size(); ++i) {
        const bool isHidden = i == 0 || i == 3;
        EXPECT_EQ(shown[i].empty(), isHidden) << textOf(paths[i]);
        if (!isHidden) {
            EXPECT_EQ(shown[i].lower, all[i].lower) << textOf(paths[i]);
        }
    }
}

TEST(Visibility, FilesKeepWhatIsHidden) {
    std::ifstream in(std::filesystem::path(RT_SOURCE_DIR) / "Assets" / "scene.schema.json");
    const test::JsonSchema schema(nlohmann::json::parse(in));
    SceneDesc scene = sceneOfAllKinds();
    for (ObjectDesc& object : scene.objects) object.hidden = true;
    std::get<GroupDesc>(scene.objects[11].shape).objects[1].hidden = true;
    const std::string text = toJson(scene);
    const nlohmann::json json = nlohmann::json::parse(text);
    EXPECT_TRUE(schema.accepts(json));
    for (const nlohmann::json& object : json["objects"]) EXPECT_EQ(object["hidden"], true) << object["type"];
    EXPECT_EQ(parseScene(text, "", ".").objects, scene.objects);
    EXPECT_EQ(toJson(sceneOfAllKinds()).find("hidden"), std::string::npos) << "what is shown is not said to be";
    try {
        parseScene(
            R"({"objects": [{"type": "point_light", "position": [0, 0, 0], "intensity": [1, 1, 1], "hidden": 1}]})",
            "file", ".");
        ADD_FAILURE() << "it is no boolean";
    } catch (const InputError& error) {
        EXPECT_NE(std::string(error.what()).find("/objects/0/hidden: 1: must be true or false"), std::string::npos)
            << error.what();
    }
}

TEST(Visibility, SoloLeavesTheLights) {
    const SceneDesc scene = sceneOfAllKinds();
    SceneDocument document(scene);
    document.perform("Hide", hidden(scene, {pathAt({11}), pathAt({11, 0})}, true));
    document.perform("Solo", soloed(document.scene(), {pathAt({3}), pathAt({11, 0})}));
    const auto isHidden = [&](const std::vector<std::uint32_t>& path) {
        return !isShown(document.scene(), pathAt(path));
    };
    for (const std::uint32_t i : {0u, 1u, 2u, 4u, 5u, 6u, 7u, 13u}) EXPECT_TRUE(isHidden({i})) << i;
    for (const std::uint32_t i : {3u, 8u, 9u, 10u, 11u, 12u}) EXPECT_FALSE(isHidden({i})) << i;
    EXPECT_FALSE(isHidden({11, 0})) << "its group was hidden, too";
    EXPECT_FALSE(isHidden({11, 1})) << "a lamp";
    EXPECT_TRUE(isHidden({11, 2}));
    EXPECT_TRUE(soloed(document.scene(), {pathAt({3}), pathAt({11, 0})}).empty()) << "it is so by now";
    document.perform("Show all", allShown(document.scene()));
    EXPECT_EQ(document.scene(), scene);
    EXPECT_TRUE(allShown(document.scene()).empty());
    while (document.undo()) {
    }
    EXPECT_EQ(document.scene(), scene);
}

// Hidden objects stay so, whatever becomes of them.
TEST(Visibility, EditsKeepIt) {
    SceneDesc scene = sceneOfAllKinds();
    for (const std::uint32_t i : {0u, 6u, 11u}) scene.objects[i].hidden = true;
    SceneDocument document(scene);
    for (const std::uint32_t i : {0u, 6u, 11u}) // its own numbers, a group around it, its transform
        document.perform("Move", {moved(document.scene(), pathAt({i}), {Translate{{1, 0, 0}}})});
    EXPECT_FALSE(isShown(document.scene(), pathAt({0})));
    EXPECT_FALSE(isShown(document.scene(), pathAt({6, 0})));
    EXPECT_FALSE(isShown(document.scene(), pathAt({11})));
    document.perform("Hide the group", hidden(document.scene(), {pathAt({6})}, true));
    const SceneDesc last = document.scene();
    document.perform("Unwrap", {WrapObject{pathAt({6}), {}}});
    document.undo();
    EXPECT_EQ(document.scene(), last);
    while (document.undo()) {
    }
    EXPECT_EQ(document.scene(), scene);
}

} // namespace
} // namespace rt::scene
