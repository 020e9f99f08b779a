// Moving, turning and scaling objects: wherever an edit puts the numbers, points of the surface go where the map takes
// them.
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "Common/Scene/Edit/ObjectMotion.h"
#include "Common/Scene/Edit/SameChange.h"
#include "Common/Scene/Edit/SceneDocument.h"
#include "tests/unit/CompilerScenes.h"

namespace rt::scene {
namespace {

// Points that lie on each kind of object, in the object's own space: what is moved is compared by where they are.
struct Points {
    std::vector<glm::dvec3> operator()(const SphereDesc& s) const { return {s.center}; }
    std::vector<glm::dvec3> operator()(const SphereSetDesc& s) const { return s.centers; }
    std::vector<glm::dvec3> operator()(const QuadDesc& q) const {
        return {q.corner, q.corner + q.edgeU, q.corner + q.edgeV};
    }
    std::vector<glm::dvec3> operator()(const BoxDesc& b) const { return {b.min, b.max}; }
    std::vector<glm::dvec3> operator()(const DiskDesc& d) const {
        return {d.center, d.center + d.radius * glm::normalize(d.normal)};
    }
    std::vector<glm::dvec3> operator()(const CylinderDesc& c) const { return {c.base, c.top}; }
    std::vector<glm::dvec3> operator()(const MeshDesc& m) const {
        return std::get<Boxed<MeshData>>(m.source)->positions;
    }
    std::vector<glm::dvec3> operator()(const MediumDesc& m) const {
        if (const auto* box = std::get_if<BoxBoundary>(&m.boundary)) return {box->min, box->max};
        return {std::get<SphereBoundary>(m.boundary).center};
    }
    std::vector<glm::dvec3> operator()(const PointLightDesc& l) const { return {l.position}; }
    std::vector<glm::dvec3> operator()(const SpotLightDesc& l) const {
        return {l.position, l.position + glm::normalize(l.direction)};
    }
    std::vector<glm::dvec3> operator()(const DirectionalLightDesc&) const { return {}; }
    std::vector<glm::dvec3> operator()(const InstanceDesc& i) const { return {toAffine(i.transform).point({1, 2, 3})}; }
    std::vector<glm::dvec3> operator()(const GroupDesc& g) const {
        std::vector<glm::dvec3> points;
        for (const ObjectDesc& object : g.objects)
            for (const glm::dvec3& point : std::visit(Points{}, object.shape))
                points.push_back(toAffine(g.transform).point(point));
        return points;
    }
};

std::vector<glm::dvec3> pointsOf(const SceneDesc& scene) {
    GroupDesc all;
    all.objects = scene.objects;
    return Points{}(all);
}

// Each within two groups, one of which turns and scales.
SceneDesc nested(const ObjectDesc::Shape& shape) {
    SceneDesc scene = withMaterials();
    scene.prototypes["pair"] = {};
    const Transform outer = {Rotate{{1, 2, 3}, 40}, Scale{{2, 2, 2}}, Translate{{1, -1, 4}}};
    scene.objects = {{group(outer, group({Translate{{3, 0, 0}}}, shape))}};
    return scene;
}

std::vector<ObjectDesc::Shape> allKinds() {
    SphereDesc sphere;
    SphereSetDesc set;
    set.centers = {{1, 0, 0}, {0, 2, 0}};
    BoxDesc box;
    DiskDesc disk;
    disk.normal = {0, 3, 4};
    CylinderDesc cylinder;
    MeshDesc mesh;
    mesh.source = MeshData{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {}, {}, {}, {}, {}, {{0, 1, 2}}};
    QuadDesc quad;
    sphere.material = set.material = box.material = disk.material = cylinder.material = "matte";
    mesh.material = quad.material = "matte";
    MediumDesc fog, mist;
    fog.boundary = SphereBoundary{{1, 1, 1}, 2};
    mist.boundary = BoxBoundary{};
    return {sphere,
            set,
            box,
            disk,
            cylinder,
            mesh,
            quad,
            fog,
            mist,
            PointLightDesc{{1, 2, 3}, glm::dvec3(1)},
            SpotLightDesc{},
            InstanceDesc{"pair", {Translate{{1, 1, 1}}}, ""}};
}

TEST(ObjectMotion, TakesPointsWhereTheMapDoesWhateverTheKind) {
    const std::vector<Transform> motions = {{Translate{{1, 2, 3}}},
                                            turned({1, 0, 2}, {0, 1, 0}, 25),
                                            turned({0, 0, 0}, {1, 1, 0}, 170),
                                            scaled({1, 1, 1}, glm::dvec3(2.5))};
    for (const ObjectDesc::Shape& kind : allKinds())
        for (const Transform& steps : motions) {
            const SceneDesc before = nested(kind);
            SceneDocument document(before);
            document.perform("Move", {moved(before, {"", {0, 0, 0}}, steps)});
            document.perform("Move", {moved(document.scene(), {"", {0, 0, 0}}, steps)}); // and once more
            const std::vector<glm::dvec3> from = pointsOf(before), to = pointsOf(document.scene());
            ASSERT_EQ(from.size(), to.size());
            const Affine map = toAffine(steps) * toAffine(steps);
            // A light's direction keeps its length, and what it points at is no point of it.
            const bool isSpot = std::holds_alternative<SpotLightDesc>(kind);
            const bool isDisk = std::holds_alternative<DiskDesc>(kind);
            for (std::size_t i = 0; i < from.size(); ++i)
                if (i == 0 || !isSpot) expectNear(to[i], map.point(from[i]), isDisk ? 1e-9 : 1e-10);
            document.undo();
            document.undo();
            EXPECT_EQ(document.scene(), before);
        }
}

// Whatever scales along an axis: a sphere becomes an ellipsoid by a group around it, a quad needs none.
TEST(ObjectMotion, ScalesAlongAnAxis) {
    const Transform steps = scaled({0, 0, 0}, {1, 3, 1});
    SceneDesc scene = withMaterials();
    for (const ObjectDesc::Shape& kind : allKinds()) scene.objects.push_back({kind});
    scene.prototypes["pair"] = {};
    const std::vector<glm::dvec3> from = pointsOf(scene);
    SceneDocument document(scene);
    for (std::uint32_t i = 0; i < scene.objects.size(); ++i) {
        const SceneEdit edit = moved(document.scene(), {"", {i}}, steps);
        const auto& kind = scene.objects[i].shape;
        EXPECT_EQ(std::holds_alternative<WrapObject>(edit),
                  std::holds_alternative<SphereDesc>(kind) || std::holds_alternative<SphereSetDesc>(kind) ||
                      std::holds_alternative<DiskDesc>(kind) || std::holds_alternative<CylinderDesc>(kind) ||
                      std::holds_alternative<MeshDesc>(kind) || i == 7) // the medium within a sphere
            << i;
        document.perform("Scale", {edit});
    }
    const std::vector<glm::dvec3> to = pointsOf(document.scene());
    const Affine map = toAffine(steps);
    ASSERT_EQ(from.size(), to.size());
    for (std::size_t i = 0; i < from.size(); ++i) {
        const bool isSpotsAim = i + 2 == from.size();
        if (!isSpotsAim) expectNear(to[i], map.point(from[i]), 1e-10);
    }
}

TEST(ObjectMotion, MovesInARowAreOne) {
    SceneDocument document(nested(allKinds()[5]));
    for (int i = 0; i < 5; ++i)
        document.perform("Move", {moved(document.scene(), {"", {0, 0, 0}}, {Translate{{0.25, 0, 0}}})});
    const auto& own = std::get<GroupDesc>(findObject(document.scene(), {"", {0, 0, 0}})->shape);
    EXPECT_EQ(own.transform.size(), 1u);
    SceneDesc scene = withMaterials();
    scene.prototypes["pair"] = {};
    scene.objects = {{InstanceDesc{"pair", {Rotate{{0, 1, 0}, 10}, Translate{{1, 0, 0}}}, ""}}};
    const auto edit = moved(scene, {"", {0}}, {Translate{{0.5, 0, 2}}});
    const Transform expected = {Rotate{{0, 1, 0}, 10}, Translate{{1.5, 0, 2}}};
    EXPECT_EQ(std::get<SetTransform>(edit).transform, expected);
}

TEST(ObjectMotion, LightsAreWhereTheirGroupsPutThem) {
    const SceneDesc scene = nested(PointLightDesc{{1, 0, 0}, glm::dvec3(1)});
    const auto position = lightPosition(scene, {"", {0, 0, 0}});
    ASSERT_TRUE(position);
    expectNear(*position, pointsOf(scene)[0], 1e-12);
    EXPECT_FALSE(lightPosition(scene, {"", {0}}));
    EXPECT_FALSE(lightPosition(scene, {"", {1}}));
}

TEST(ObjectPath, LeavesAreCountedDepthFirst) {
    SceneDesc scene = withMaterials();
    GroupDesc inner, outer;
    inner.objects = {{SphereDesc{}}, {BoxDesc{}}};
    outer.objects = {{DiskDesc{}}, {inner}, {QuadDesc{}}};
    scene.objects = {{SphereDesc{}}, {GroupDesc{}}, {outer}, {PointLightDesc{}}};
    const std::vector<std::string> expected = {"/objects/0",
                                               "/objects/2/objects/0",
                                               "/objects/2/objects/1/objects/0",
                                               "/objects/2/objects/1/objects/1",
                                               "/objects/2/objects/2",
                                               "/objects/3"};
    for (std::uint32_t leaf = 0; leaf < expected.size(); ++leaf) {
        const ObjectPath path = pathOfLeaf(scene, leaf);
        EXPECT_EQ(textOf(path), expected[leaf]);
        const ObjectRange leaves = leavesOf(scene, std::vector<ObjectPath>{path}).front();
        EXPECT_EQ(leaves.first, leaf);
        EXPECT_EQ(leaves.count, 1u);
    }
    EXPECT_TRUE(pathOfLeaf(scene, 6).indices.empty());
    const std::vector<ObjectPath> paths = {{"", {0}},    {"", {0, 3}}, {"", {1}}, {"", {2, 0}},
                                           {"", {2, 1}}, {"", {3}},    {"", {4}}, {"pair", {0}}};
    const std::vector<ObjectRange> ranges = leavesOf(scene, paths);
    const std::vector<std::pair<std::uint32_t, std::uint32_t>> wanted = {{0, 1}, {1, 0}, {1, 0}, {1, 1},
                                                                         {2, 2}, {5, 1}, {6, 0}, {6, 0}};
    ASSERT_EQ(ranges.size(), wanted.size());
    for (std::size_t i = 0; i < ranges.size(); ++i) {
        EXPECT_EQ(ranges[i].first, wanted[i].first) << textOf(paths[i]);
        EXPECT_EQ(ranges[i].count, wanted[i].second) << textOf(paths[i]);
    }
    EXPECT_EQ(leavesOf(scene, std::vector<ObjectPath>{{"", {2}}}).front().count, 4u);
}

// Numbers that were changed, and no others.
TEST(SameChange, IsThatOfOthersOfItsKind) {
    SphereDesc before, after, other;
    before.center = {1, 2, 3};
    after = before;
    after.center.y = 5;
    after.radius = 2;
    other.center = {7, 8, 9};
    other.material = "glass";
    ObjectDesc changed{other}, box{BoxDesc{}};
    changeAlike({before}, {after}, changed);
    other.center.y = 5;
    other.radius = 2;
    EXPECT_EQ(changed, ObjectDesc{other});
    changeAlike({before}, {after}, box);
    EXPECT_EQ(box, ObjectDesc{BoxDesc{}});
    MediumDesc round, flat;
    round.boundary = SphereBoundary{};
    flat.boundary = BoxBoundary{};
    MediumDesc dense = round;
    dense.density = 4;
    std::get<SphereBoundary>(dense.boundary).radius = 6;
    ObjectDesc medium{flat};
    changeAlike({round}, {dense}, medium);
    flat.density = 4;
    EXPECT_EQ(medium, ObjectDesc{flat}) << "it has no radius";
    const Transform moved = {Translate{{1, 2, 3}}, Rotate{{0, 1, 0}, 30}};
    Transform turned = moved, alike = {Translate{{4, 5, 6}}, Rotate{{1, 0, 0}, 0}}, unlike = {Scale{}, Rotate{}};
    std::get<Rotate>(turned[1]).degrees = 45;
    const Transform asBefore = unlike;
    changeAlike(moved, turned, alike);
    EXPECT_EQ(alike, (Transform{Translate{{4, 5, 6}}, Rotate{{1, 0, 0}, 45}}));
    changeAlike(moved, turned, unlike);
    EXPECT_EQ(unlike, asBefore);
}

} // namespace
} // namespace rt::scene
