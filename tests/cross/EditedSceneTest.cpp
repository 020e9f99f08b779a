// What the device keeps of the scene before an edit: pictures are those of the scene from scratch, bit for bit, and
// nothing is uploaded or built that is there.
#include <chrono>
#include <memory>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "Common/Scene/Compiler/SceneCompiler.h"
#include "RayTracingGPU/EngineChoice.h"
#include "RayTracingGPU/GpuEngine.h"
#include "RayTracingGPU/GpuScene.h"
#include "tests/cross/Device.h"
#include "tests/unit/EditedScenes.h"

namespace rt::test {
namespace {

using Scene = std::shared_ptr<const scene::CompiledScene>;

std::vector<float> picture(app::Engine& engine, const Scene& scene) {
    engine.setScene(scene, nullptr);
    app::RenderSettings settings;
    settings.width = settings.height = 16;
    settings.spp = 1;
    settings.maxDepth = 4;
    engine.reset(scene->camera, settings);
    while (!engine.renderSome({std::chrono::seconds(1), nullptr}).finished) {
    }
    return engine.film().resolve().data;
}

class EditedScene : public ::testing::TestWithParam<app::GpuEngineKind> {};

// Moves, materials, and what is added and removed between: one engine follows, one for each begins anew.
TEST_P(EditedScene, KeepsNothingThatTheGpuEngineWouldSee) {
    scene::SceneDesc desc = scene::sceneOfMeshes();
    const auto engine = gpu::makeGpuEngine(device(), {.pipelineCache = false, .engine = GetParam()});
    const auto fresh = gpu::makeGpuEngine(device(), {.pipelineCache = false, .engine = GetParam()});
    const Scene unlike = scene::compileScene(scene::SceneDesc{});
    scene::EditsOfMeshes edits(78);
    for (int i = 0; i < 8; ++i) {
        scene::SceneEdit edit = edits.next(desc);
        scene::exchange(desc, edit);
        const Scene scene = scene::compileScene(desc);
        const std::vector<float> followed = picture(*engine, scene);
        fresh->setScene(unlike, nullptr); // has nothing in common with it
        ASSERT_EQ(picture(*fresh, scene), followed) << "edit " << i;
    }
}

TEST_P(EditedScene, UploadsAndBuildsWhatHasChanged) {
    scene::SceneDesc desc = scene::sceneOfMeshes();
    const auto made = [&](const gpu::GpuScene* before) {
        return gpu::GpuScene(device(), GetParam(), scene::compileScene(desc), nullptr, before);
    };
    const gpu::GpuScene first = made(nullptr);
    const auto sharesGeometry = [&](const gpu::GpuScene& other) {
        const shared::SceneArrays &a = first.arrays(), &b = other.arrays();
        return a.positions == b.positions && a.triangles == b.triangles && a.normals == b.normals && a.uvs == b.uvs;
    };
    desc.materials["matte"] = scene::lambertian(0.1, 0.2, 0.3);
    const gpu::GpuScene painted = made(&first);
    EXPECT_TRUE(sharesGeometry(painted));
    EXPECT_NE(painted.arrays().materials, first.arrays().materials);
    EXPECT_EQ(painted.buildSeconds(), 0);
    if (gpu::usesAccelStructure(GetParam())) {
        EXPECT_EQ(painted.topLevel(), first.topLevel());
    } else {
        EXPECT_EQ(painted.tree().triangles, first.tree().triangles);
    }

    std::get<scene::InstanceDesc>(desc.objects[3].shape).transform = {scene::Translate{{-1, 0.5, 0}}};
    const gpu::GpuScene moved = made(&painted);
    EXPECT_TRUE(sharesGeometry(moved));
    EXPECT_EQ(moved.arrays().materials, painted.arrays().materials);
    EXPECT_NE(moved.arrays().instances, painted.arrays().instances);
    if (gpu::usesAccelStructure(GetParam())) {
        EXPECT_NE(moved.topLevel(), painted.topLevel());
    }
}

INSTANTIATE_TEST_SUITE_P(Engines, EditedScene, kBothEngines, engineName);

} // namespace
} // namespace rt::test
