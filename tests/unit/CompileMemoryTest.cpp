// What a compilation takes over from the one before is what it would have made itself, to the byte.
#include <cstring>
#include <memory>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

#include "Common/Scene/Compiler/CompileMemory.h"
#include "Common/Scene/Compiler/SceneCompiler.h"
#include "Common/Scene/Edit/SceneEdit.h"
#include "Common/Shared/Base/SceneAccess.h"
#include "tests/unit/EditedScenes.h"

namespace rt::scene {
namespace {

void expectSameScene(const CompiledScene& a, const CompiledScene& b) {
    const auto compare = [](const char* name, const auto& x, const auto& y) {
        ASSERT_EQ(x.size(), y.size()) << name;
        EXPECT_TRUE(x.empty() || std::memcmp(x.data(), y.data(), x.size() * sizeof x[0]) == 0) << name;
    };
    shared::forEachArray(compare, a, b);
    EXPECT_EQ(std::memcmp(&a.globals, &b.globals, sizeof a.globals), 0);
    EXPECT_TRUE(a.features == b.features);
    EXPECT_EQ(a.hash, b.hash);
    EXPECT_EQ(a.lower, b.lower);
    EXPECT_EQ(a.upper, b.upper);
    EXPECT_EQ(a.notices, b.notices);
    EXPECT_EQ(a.materialNames, b.materialNames);
    EXPECT_EQ(a.origins.instances, b.origins.instances);
    compare("origins", a.origins.triangles, b.origins.triangles);
    compare("origins", a.origins.spheres, b.origins.spheres);
}

TEST(CompileMemory, EditedScenesAreThoseCompiledFromScratch) {
    SceneDesc scene = sceneOfMeshes();
    CompileMemory memory;
    CompileOptions remembering;
    remembering.memory = &memory;
    EditsOfMeshes edits(31);
    std::vector<SceneEdit> done;
    for (int i = 0; i < 400; ++i) {
        SceneEdit edit = edits.next(scene);
        exchange(scene, edit);
        done.push_back(std::move(edit));
        if (i % 3 == 0) continue; // several edits at once
        const auto remembered = compileScene(scene, remembering);
        done.clear();
        expectSameScene(*remembered, *compileScene(scene));
        if (HasFailure()) FAIL() << "after edit " << i;
    }
}

// Vertices and triangles of what stays are those that were there, which a mesh in memory that is no longer what it was
// shows: nobody has looked at it.
TEST(CompileMemory, TakesOverWhatHasNotChanged) {
    SceneDesc scene = sceneOfMeshes();
    CompileMemory memory;
    CompileOptions remembering;
    remembering.memory = &memory;
    compileScene(scene, remembering);
    EXPECT_EQ(memory.surfaces.size(), 4u); // of the scene two, of the prototype two
    const auto first = compileScene(scene);
    const auto& world = std::get<Boxed<MeshData>>(std::get<MeshDesc>(scene.objects[1].shape).source);
    const_cast<MeshData&>(*world).positions.assign(world->positions.size(), glm::dvec3(7)); // in place
    EXPECT_EQ(compileScene(scene, remembering)->hash, first->hash);
    EXPECT_NE(compileScene(scene)->hash, first->hash);
}

MeshDesc& worldMesh(SceneDesc& scene) {
    return std::get<MeshDesc>(scene.objects[1].shape);
}

TEST(CompileMemory, MeshesThatNobodyNeedsAreGivenBack) {
    const SceneDesc kept = sceneOfMeshes();
    SceneDesc given = sceneOfMeshes();
    expectSameScene(*compileScene(std::move(given)), *compileScene(kept));
    const MeshData& left = *std::get<Boxed<MeshData>>(worldMesh(given).source);
    EXPECT_TRUE(left.positions.empty() && left.normals.empty() && left.uvs.empty() && left.triangles.empty());
    // Those of prototypes are compiled for each of their instances.
    EXPECT_EQ(given.prototypes, kept.prototypes);
    // The next compilation takes over what it knows by its place in memory.
    CompileMemory memory;
    CompileOptions remembering;
    remembering.memory = &memory;
    SceneDesc edited = sceneOfMeshes();
    compileScene(std::move(edited), remembering);
    EXPECT_EQ(edited.objects, kept.objects); // NOLINT(bugprone-use-after-move): that nothing was taken away
    // So is what another description shares.
    SceneDesc shared = kept;
    compileScene(std::move(shared));
    EXPECT_EQ(kept, sceneOfMeshes());
}

TEST(CompileMemory, MeshesInSinglePrecisionAreAsThoseInDouble) {
    SceneDesc doubles = sceneOfMeshes();
    const FloatMeshData data = std::as_const(*std::get<Boxed<MeshData>>(worldMesh(doubles).source)).as<float>();
    worldMesh(doubles).source = data.as<double>();
    SceneDesc floats = doubles;
    worldMesh(floats).source = data;
    expectSameScene(*compileScene(floats), *compileScene(doubles));
    CompileMemory memory;
    CompileOptions remembering;
    remembering.memory = &memory;
    compileScene(floats, remembering);
    floats.objects[1] = {GroupDesc{{}, {floats.objects[1]}}}; // elsewhere in memory, at the same place
    compileScene(floats, remembering);
    expectSameScene(*compileScene(floats, remembering), *compileScene(floats));
    expectSameScene(*compileScene(std::move(floats)), *compileScene(doubles));
}

} // namespace
} // namespace rt::scene
