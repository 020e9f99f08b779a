// Edits of scenes and their history: what is undone is as if it had never been, what is refused changes nothing.
#include <functional>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "Common/Core/Error.h"
#include "Common/Scene/Builtin/BuiltinScenes.h"
#include "Common/Scene/Edit/EditCheck.h"
#include "Common/Scene/Edit/ObjectMotion.h"
#include "Common/Scene/Edit/SceneDocument.h"
#include "Common/Scene/Json/SceneJson.h"
#include "tests/unit/CompilerScenes.h"

namespace rt::scene {
namespace {

ObjectPath at(std::vector<std::uint32_t> indices, const std::string& prototype = "") {
    return {prototype, std::move(indices)};
}

SphereDesc ball(const glm::dvec3& center, double radius, const std::string& material) {
    SphereDesc sphere;
    sphere.center = center;
    sphere.radius = radius;
    sphere.material = material;
    return sphere;
}

// Of every kind of object one, in a group as well.
SceneDesc variedScene() {
    SceneDesc scene = withMaterials();
    scene.materials["unused"] = lambertian(1, 0, 0);
    scene.textures["map"] = CheckerTexture{};
    scene.prototypes["pair"] = {{ball({0, 0, 0}, 1, "matte")}, {ball({3, 0, 0}, 1, "glass")}};
    BoxDesc box;
    box.material = "matte";
    MeshDesc mesh;
    mesh.source = MeshData{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {}, {}, {}, {}, {}, {{0, 1, 2}}};
    mesh.material = "matte";
    MediumDesc medium;
    medium.boundary = SphereBoundary{};
    medium.albedo = "map";
    SphereSetDesc set;
    set.centers = {{0, 0, 0}, {2, 0, 0}};
    set.material = "glass";
    QuadDesc quad;
    quad.material = "lamp";
    scene.objects = {{ball({0, 1, 0}, 1, "matte")},
                     {box},
                     {mesh},
                     {medium},
                     {set},
                     {quad},
                     {PointLightDesc{}},
                     {group({Translate{{5, 0, 0}}}, group({Scale{{2, 2, 2}}}, ball({1, 0, 0}, 1, "glass")))},
                     {InstanceDesc{"pair", {Translate{{0, 0, 9}}}, ""}}};
    return scene;
}

// A random edit of a random thing, now and then one that is refused.
class RandomEdits {
  public:
    explicit RandomEdits(std::uint64_t seed) : random_(seed) {}

    void perform(SceneDocument& document) {
        try {
            document.perform("Step", {edit(document.scene())}, pick(4) == 0 ? 7 : 0);
        } catch (const InputError&) {
            ++refused;
        }
    }
    std::size_t refused = 0;

  private:
    std::size_t pick(std::size_t count) { return random_() % count; }
    double number() { return std::uniform_real_distribution<double>(-5, 5)(random_); }

    // Now and then of nothing.
    ObjectPath path(const SceneDesc& scene) {
        if (pick(8) == 0) return at({static_cast<std::uint32_t>(pick(3))}, "pair");
        ObjectPath path = at({static_cast<std::uint32_t>(pick(scene.objects.size() + 1))});
        while (const ObjectDesc* object = findObject(scene, path)) {
            const auto* inner = std::get_if<GroupDesc>(&object->shape);
            if (inner == nullptr || pick(2) == 0) break;
            path = path.child(pick(inner->objects.size() + 1));
        }
        return path;
    }
    std::string material() { return std::vector<std::string>{"matte", "glass", "lamp", "new", "unused"}[pick(5)]; }

    SceneEdit edit(const SceneDesc& scene) {
        const ObjectPath path = this->path(scene);
        switch (pick(13)) {
            case 0:
                return SetObject{path, {ball({number(), number(), number()}, number(), material())}};
            case 1:
                return SetTransform{path, {Translate{{number(), 0, 0}}, Scale{glm::dvec3(number())}}};
            case 2:
                return SetMaterialOf{path, material()};
            case 3:
                return PlaceObject{path, ObjectDesc{ball({number(), 0, 0}, 1, material())}};
            case 4:
                return PlaceObject{path, {}};
            case 5:
                return WrapObject{path, Transform{Rotate{{0, 1, 0}, number()}}};
            case 6:
                return WrapObject{path, {}};
            case 7:
                return SetMaterial{material(), pick(2) == 0 ? std::optional(lambertian(0.1, 0.2, 0.3)) : std::nullopt};
            case 8:
                return SetCamera{{{number(), number(), number()}, {0, 0, 0}, {0, 1, 0}, 40, 0, 10}};
            case 9:
                return SetBackground{ConstantBackground{glm::dvec3(number())}};
            case 11:
                return SetHidden{path, pick(2) == 0};
            case 10:
                return SetTexture{"map", CheckerTexture{number(), glm::dvec3(0.5), glm::dvec3(1)}};
            default:
                return findObject(scene, path) != nullptr ? moved(scene, path, {Translate{{number(), 0, 0}}})
                                                          : SceneEdit{SetTitle{"Title"}};
        }
    }

    std::mt19937_64 random_;
};

std::string refusalOf(const SceneDesc& scene, const SceneEdit& edit) {
    SceneDocument document(scene);
    std::string message = "no error";
    try {
        document.perform("Step", {SetTitle{"Before"}, edit});
    } catch (const InputError& error) {
        message = error.what();
    }
    if (message != "no error") {
        EXPECT_EQ(document.scene(), scene);
        EXPECT_EQ(document.stepCount(), 0u);
        EXPECT_FALSE(document.isDirty());
        EXPECT_TRUE(document.takeJournal().empty());
        EXPECT_EQ(message.find('\n'), message.npos);
    }
    return message;
}

TEST(SceneDocument, ThousandsOfEditsAreUndoneToTheByte) {
    const SceneDesc first = variedScene();
    const std::string firstText = toJson(first);
    SceneDocument document(first);
    SceneDesc replica = first; // that gets what the journal tells
    const auto follow = [&] {
        for (SceneEdit& edit : document.takeJournal()) exchange(replica, edit);
    };
    RandomEdits edits(12);
    for (int i = 0; i < 10'000; ++i) {
        edits.perform(document);
        follow();
        if (i % 17 == 0) document.undo();
        if (i % 34 == 0) document.redo();
        follow();
    }
    EXPECT_GT(edits.refused, 1000u); // and what was not is most
    EXPECT_GT(document.stepCount(), 3000u);
    const SceneDesc last = document.scene();
    const std::string lastText = toJson(last);
    EXPECT_EQ(replica, last);
    EXPECT_EQ(parseScene(lastText, "", ".").objects, last.objects) << "whatever passes can be read back";
    while (document.undo()) {
    }
    EXPECT_EQ(document.scene(), first);
    EXPECT_EQ(toJson(document.scene()), firstText);
    while (document.redo()) {
    }
    follow();
    EXPECT_EQ(document.scene(), last);
    EXPECT_EQ(toJson(document.scene()), lastText);
    EXPECT_EQ(replica, last);
}

TEST(SceneDocument, AnEditOfOneAmongAMillionKeepsLittle) {
    SceneDesc scene = withMaterials();
    scene.objects.assign(1'000'000, ObjectDesc{ball({0, 0, 0}, 1, "matte")});
    MeshData mesh;
    mesh.positions.assign(300'000, glm::dvec3(0));
    mesh.triangles.assign(100'000, {0, 1, 2});
    MeshDesc large;
    large.source = std::move(mesh);
    large.material = "matte";
    scene.objects.push_back({large});
    SceneDocument document(std::move(scene));
    constexpr std::size_t kMegabyte = 1u << 20;
    const auto bytesOfStep = [&](const SceneEdit& edit) {
        const std::size_t before = document.historyBytes();
        document.perform("Step", {edit});
        std::size_t journal = 0;
        for (const SceneEdit& done : document.takeJournal()) journal += bytesOf(done);
        return document.historyBytes() - before + journal;
    };
    const ObjectPath one = at({500'000}), whole = at({1'000'000});
    EXPECT_LT(bytesOfStep(SetObject{one, {ball({1, 0, 0}, 2, "glass")}}), kMegabyte);
    EXPECT_LT(bytesOfStep(PlaceObject{one, ObjectDesc{ball({1, 0, 0}, 2, "glass")}}), kMegabyte);
    EXPECT_LT(bytesOfStep(PlaceObject{one, {}}), kMegabyte);
    EXPECT_LT(bytesOfStep(moved(document.scene(), one, {Translate{{1, 0, 0}}})), kMegabyte);
    EXPECT_LT(bytesOfStep(SetMaterialOf{whole, "glass"}), kMegabyte);
    EXPECT_LT(bytesOfStep(moved(document.scene(), whole, {Translate{{1, 0, 0}}})), kMegabyte) << "of a large mesh";
    EXPECT_LT(bytesOfStep(moved(document.scene(), whole, turned({0, 0, 0}, {0, 1, 0}, 30))), kMegabyte);
}

// A drag is one step, also where its first edit has put the object into a group.
TEST(SceneDocument, StepsOfOneGestureAreOne) {
    const SceneDesc first = variedScene();
    for (const std::uint32_t object : {0u, 2u}) { // a sphere, a mesh
        SceneDocument document(first);
        for (int i = 0; i < 10; ++i)
            document.perform("Move", {moved(document.scene(), at({object}), {Translate{{0.5, 0, 0}}})}, 1);
        EXPECT_EQ(document.stepCount(), 1u);
        SceneDocument atOnce(first);
        atOnce.perform("Move", {moved(first, at({object}), {Translate{{5, 0, 0}}})});
        EXPECT_EQ(document.scene(), atOnce.scene());
        document.perform("Move", {moved(document.scene(), at({object}), {Translate{{1, 0, 0}}})}, 2);
        EXPECT_EQ(document.stepCount(), 2u);
        document.giveUp(1); // is not the latest
        EXPECT_EQ(document.stepCount(), 2u);
        document.giveUp(2);
        EXPECT_EQ(document.stepCount(), 1u);
        EXPECT_EQ(document.scene(), atOnce.scene());
        document.undo();
        EXPECT_EQ(document.scene(), first);
        document.redo();
        EXPECT_EQ(document.scene(), atOnce.scene());
    }
}

// Copies, and what is then done to them.
TEST(SceneDocument, TwoStepsCanBecomeOne) {
    const SceneDesc first = variedScene();
    SceneDocument document(first);
    const std::vector<ObjectPath> paths = {at({0}), at({2}), at({7, 0})};
    std::vector<ObjectPath> copies;
    document.perform("Duplicate", duplicated(first, paths, copies));
    EXPECT_EQ(copies, (std::vector<ObjectPath>{at({1}), at({4}), at({9, 1})}));
    for (std::size_t i = 0; i < paths.size(); ++i)
        EXPECT_EQ(*findObject(document.scene(), copies[i]), *findObject(first, paths[i])) << textOf(paths[i]);
    std::vector<SceneEdit> moves;
    moves.reserve(copies.size());
    for (const ObjectPath& copy : copies) moves.push_back(moved(document.scene(), copy, {Translate{{1, 0, 0}}}));
    document.perform("Move", moves);
    const SceneDesc last = document.scene();
    document.joinSteps("Duplicate");
    EXPECT_EQ(document.stepCount(), 1u);
    EXPECT_EQ(document.stepName(0), "Duplicate");
    EXPECT_TRUE(document.isDirty());
    document.undo();
    EXPECT_EQ(document.scene(), first);
    EXPECT_FALSE(document.isDirty());
    document.redo();
    EXPECT_EQ(document.scene(), last);
    document.markSaved();
    document.perform("Delete", removed(copies));
    document.joinSteps("Both");
    EXPECT_EQ(document.stepCount(), 2u) << "a saved state stays one that undo comes by";
    EXPECT_EQ(document.scene(), first);
}

TEST(SceneDocument, IsCleanWhereItWasSaved) {
    SceneDocument document(variedScene());
    EXPECT_FALSE(document.isDirty());
    document.perform("One", {SetTitle{"One"}}, 1);
    EXPECT_TRUE(document.isDirty());
    document.markSaved();
    document.perform("Two", {SetTitle{"Two"}}, 1); // the gesture goes on, beyond what was saved
    EXPECT_TRUE(document.isDirty());
    document.undo();
    EXPECT_FALSE(document.isDirty());
    EXPECT_EQ(document.scene().title, "One");
    document.undo();
    EXPECT_TRUE(document.isDirty());
    document.perform("Three", {SetTitle{"Three"}}); // nothing leads back to what was saved
    document.undo();
    EXPECT_TRUE(document.isDirty());
    EXPECT_EQ(document.stepName(0), "Three");
    EXPECT_EQ(document.position(), 0u);
}

TEST(SceneDocument, RefusesWhatCannotBeInOneSentence) {
    constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
    const SceneDesc scene = variedScene();
    QuadDesc flat;
    flat.edgeV = flat.edgeU;
    flat.material = "matte";
    BoxDesc inverted;
    inverted.max = {0, 1, 1};
    inverted.material = "matte";
    MaterialDesc tooRough = scene.materials.at("matte");
    tooRough.kind = MaterialKind::Metal;
    tooRough.parameters[0] = 2;
    struct Case {
        SceneEdit edit;
        std::string message; // its beginning
    };
    const Case cases[] = {
        {SetObject{at({9}), {ball({0, 0, 0}, 1, "matte")}}, "/objects/9: there is no such object"},
        {SetObject{at({0, 1}), {ball({0, 0, 0}, 1, "matte")}}, "/objects/0/objects/1: there is no such object"},
        {SetObject{at({0}), {ball({0, kNan, 0}, 1, "matte")}}, "/objects/0/center"},
        {SetObject{at({7, 0, 0}), {ball({0, 0, 0}, 0, "matte")}}, "/objects/7/objects/0/objects/0/radius"},
        {SetObject{at({0}), {ball({0, 0, 0}, 1, "none")}}, "/objects/0/material: \"none\" is not the name"},
        {SetObject{at({5}), {flat}}, "/objects/5: edge_u and edge_v must span an area"},
        {SetObject{at({1}), {inverted}}, "/objects/1: each component of min must be below that of max"},
        {SetMaterialOf{at({0}), "none"}, "/objects/0/material: \"none\" is not the name of a material"},
        {SetMaterialOf{at({0}), ""}, "/objects/0: such an object needs a material"},
        {SetMaterialOf{at({6}), "matte"}, "/objects/6: such an object has no material of its own"},
        {SetTransform{at({0}), {}}, "/objects/0: such an object has no transform"},
        {SetTransform{at({7}), {Scale{{1, 0, 1}}}}, "/objects/7/transform/0/scale"},
        {WrapObject{at({7, 0, 0}), {}}, "/objects/7/objects/0/objects/0: this is no group of one object"},
        {PlaceObject{at({10}), ObjectDesc{ball({0, 0, 0}, 1, "matte")}}, "/objects/10: there is no such place"},
        {PlaceObject{at({0}), ObjectDesc{InstanceDesc{"none", {}, ""}}}, "/objects/0/prototype"},
        {PlaceObject{at({0}, "pair"), ObjectDesc{InstanceDesc{"pair", {}, ""}}}, "/prototypes/pair/0: prototype"},
        {SetMaterial{"matte", {}}, "/materials/matte: cannot be removed while it is used 4 times"},
        {SetMaterial{"none", {}}, "/materials/none: there is nothing of this name"},
        {SetMaterial{"matte", tooRough}, "/materials/matte/fuzz"},
        {SetTexture{"map", {}}, "/textures/map: cannot be removed while it is used 1 times"},
        {SetPrototype{"pair", {}}, "/prototypes/pair: cannot be removed while it is used 1 times"},
        {SetCamera{{{0, 0, 0}, {0, 0, 0}, {0, 1, 0}, 40, 0, 1}}, "/camera: look_from and look_at must differ"},
        {SetBackground{ConstantBackground{glm::dvec3(-1)}}, "/background/color"},
        {SetRenderDefaults{{-1}}, "/render/aspect"},
    };
    for (const Case& wrong : cases) {
        const std::string message = refusalOf(scene, wrong.edit);
        EXPECT_EQ(message.substr(0, wrong.message.size()), wrong.message);
    }
    EXPECT_EQ(refusalOf(scene, SetMaterial{"unused", {}}), "no error");
    EXPECT_EQ(materialUses(scene, "glass"), 3u);
}

TEST(SceneDocument, MeshesWithoutTangentsAreCounted) {
    SceneDesc scene;
    const auto add = [&scene](auto data, const char* material) {
        data.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
        data.triangles = {{0, 1, 2}};
        scene.prototypes["part"].push_back({MeshDesc{Boxed(std::move(data)), material}});
    };
    MeshData with;
    with.tangents.assign(3, {1, 0, 0, 1});
    add(MeshData(), "m");
    add(FloatMeshData(), "m");
    add(with, "m");
    add(MeshData(), "other");
    EXPECT_EQ(meshesWithoutTangents(scene, "m"), 2u);
    EXPECT_EQ(meshesWithoutTangents(scene, "none"), 0u);
}

// From an empty scene, one object after the other: what is saved is the scene, in each of its arrays.
TEST(SceneDocument, BuiltinScenesAreRebuiltByHand) {
    for (const char* id : {"cornell-box-lights", "rest-of-life-cornell-box", "one-weekend-test", "next-week-final"}) {
        const SceneDesc wanted = findBuiltinScene(id);
        SceneDocument document(SceneDesc{});
        document.perform("Camera", {SetCamera{wanted.camera}, SetRenderDefaults{wanted.render}});
        document.perform("Sky", {SetBackground{wanted.background}});
        for (const auto& [name, texture] : wanted.textures)
            document.perform("Add a texture", {SetTexture{name, texture}});
        for (const auto& [name, material] : wanted.materials)
            document.perform("Add a material", {SetMaterial{name, material}});
        for (const auto& [name, objects] : wanted.prototypes)
            document.perform("Add a prototype", {SetPrototype{name, objects}});
        for (std::uint32_t i = 0; i < wanted.objects.size(); ++i)
            document.perform("Add an object", {PlaceObject{at({i}), wanted.objects[i]}});
        document.perform("Aim", {SetTargets{wanted.importanceTargets}});
        const auto rebuilt = compileScene(parseScene(toJson(document.scene()), id, "."));
        const auto builtin = compileScene(wanted);
        EXPECT_EQ(rebuilt->hash, builtin->hash) << id;
        EXPECT_EQ(rebuilt->camera, builtin->camera) << id;
        EXPECT_EQ(rebuilt->origin, builtin->origin) << id;
        EXPECT_EQ(rebuilt->defaults, builtin->defaults) << id;
        while (document.undo()) {
        }
        EXPECT_EQ(document.scene(), SceneDesc{}) << id;
    }
}

} // namespace
} // namespace rt::scene
