// Which objects are selected, and that they stay so wherever edits lead them.
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "Common/App/Interactive/ObjectSelection.h"
#include "Common/Scene/Edit/SceneDocument.h"
#include "tests/unit/CompilerScenes.h"

namespace rt::app {
namespace {

using namespace scene;
using Paths = std::vector<ObjectPath>;

ObjectPath to(std::vector<std::uint32_t> indices) {
    return {"", std::move(indices)};
}

TEST(ObjectSelection, NoneLiesWithinAnother) {
    ObjectSelection selection;
    selection.set(to({3}));
    selection.toggle(to({1, 2}));
    EXPECT_EQ(selection.paths(), (Paths{to({1, 2}), to({3})}));
    EXPECT_EQ(selection.active(), to({1, 2}));
    selection.toggle(to({1})); // the group in place of what is in it
    EXPECT_EQ(selection.paths(), (Paths{to({1}), to({3})}));
    selection.toggle(to({1, 4})); // and the reverse
    EXPECT_EQ(selection.paths(), (Paths{to({1, 4}), to({3})}));
    const std::uint64_t serial = selection.serial();
    selection.toggle(to({1, 4})); // once more: no longer
    EXPECT_EQ(selection.paths(), Paths{to({3})});
    EXPECT_EQ(selection.active(), to({3}));
    EXPECT_GT(selection.serial(), serial);
    selection.set({to({2, 1}), to({2}), to({0}), to({2, 0, 5})}, to({2, 0, 5}));
    EXPECT_EQ(selection.paths(), (Paths{to({0}), to({2})}));
    EXPECT_EQ(selection.active(), to({2})) << "the group that it is in";
    EXPECT_FALSE(selection.contains(to({2, 1})));
    selection.set(std::nullopt);
    EXPECT_EQ(selection.size(), 0u);
    EXPECT_FALSE(selection.active());
}

TEST(ObjectSelection, WhatIsRemovedIsNoLongerSelected) {
    ObjectSelection selection;
    selection.set({to({1}), to({2}), to({4, 0})}, to({2}));
    selection.follow(PlaceObject{to({2}), {}});
    EXPECT_EQ(selection.paths(), (Paths{to({1}), to({3, 0})}));
    EXPECT_TRUE(selection.active());
    SceneDesc scene;
    scene.objects = {{SphereDesc{}}, {SphereDesc{}}};
    selection.keepExisting(scene);
    EXPECT_EQ(selection.paths(), Paths{to({1})});
    EXPECT_EQ(selection.active(), to({1}));
}

// Spheres that are known by their radius, in a tree that grows, shrinks and gets groups.
TEST(ObjectSelection, FollowsItsObjectsThroughEdits) {
    std::mt19937_64 random(3);
    const auto pick = [&](std::size_t count) { return random() % count; };
    SceneDesc scene = withMaterials();
    double radius = 1;
    const auto ball = [&] {
        SphereDesc sphere;
        sphere.radius = radius++;
        sphere.material = "matte";
        return ObjectDesc{sphere};
    };
    GroupDesc inner, outer;
    for (int i = 0; i < 5; ++i) inner.objects.push_back(ball());
    for (int i = 0; i < 3; ++i) outer.objects.push_back(ball());
    outer.objects.push_back({inner});
    for (int i = 0; i < 4; ++i) scene.objects.push_back(ball());
    scene.objects.insert(scene.objects.begin() + 1, {outer});
    SceneDocument document(scene);
    const Paths chosen = {to({0}), to({1, 1}), to({1, 3, 2}), to({3})};
    ObjectSelection selection;
    selection.set(chosen, to({3}));
    const auto radii = [&] {
        std::vector<double> found;
        for (const ObjectPath& path : selection.paths()) {
            const ObjectDesc* object = findObject(document.scene(), path);
            while (const auto* group = std::get_if<GroupDesc>(&object->shape)) object = &group->objects.front();
            found.push_back(std::get<SphereDesc>(object->shape).radius);
        }
        return found;
    };
    const std::vector<double> wanted = radii();
    const auto anywhere = [&](bool isToAdd) {
        const Paths lists = {to({}), to({1}), to({1, 3})};
        ObjectPath path = lists[pick(3)];
        std::size_t size = document.scene().objects.size();
        if (!path.indices.empty()) size = std::get<GroupDesc>(findObject(document.scene(), path)->shape).objects.size();
        return path.child(pick(size + isToAdd));
    };
    int done = 0;
    for (int i = 0; i < 300; ++i) {
        const ObjectPath path = anywhere(i % 2 == 0);
        // Groups that the lists are named by stay where they are.
        const bool isBefore = path.indices.back() <= (path.indices.size() == 1 ? 1u : 3u) && path.indices.size() < 3;
        if (isBefore) continue;
        const SceneEdit edit = i % 2 == 0   ? SceneEdit(PlaceObject{path, ball()})
                               : i % 3 == 0 ? SceneEdit(WrapObject{path, Transform{}})
                                            : SceneEdit(PlaceObject{path, {}});
        const bool removesChosen = i % 2 != 0 && i % 3 != 0 && selection.contains(path);
        if (removesChosen) continue;
        document.perform("Step", {edit});
        for (const SceneEdit& each : document.takeJournal()) selection.follow(each);
        ASSERT_EQ(radii(), wanted) << "after step " << i;
        ++done;
    }
    EXPECT_GT(done, 80);
    while (document.undo())
        for (const SceneEdit& each : document.takeJournal()) selection.follow(each);
    EXPECT_EQ(selection.paths(), chosen);
}

} // namespace
} // namespace rt::app
