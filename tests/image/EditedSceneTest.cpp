// Whatever is kept of the scene before an edit, the picture is that of the scene from scratch, bit for bit.
#include <chrono>
#include <memory>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "Common/Accel/CpuAccel.h"
#include "Common/Scene/Compiler/CompileMemory.h"
#include "tests/image/Harness.h"
#include "tests/unit/EditedScenes.h"

namespace rt::test {
namespace {

using Scene = std::shared_ptr<const scene::CompiledScene>;

constexpr std::uint32_t kManyTriangles = 40; // squares along a side: enough that trees follow

std::vector<float> picture(app::Engine& engine, const Scene& scene) {
    engine.setScene(scene, nullptr);
    app::RenderSettings settings;
    settings.width = settings.height = 24;
    settings.spp = 2;
    engine.reset(scene->camera, settings);
    while (!engine.renderSome({std::chrono::seconds(1), nullptr}).finished) {
    }
    return engine.film().resolve().data;
}

TEST(EditedScene, KeepsNothingThatTheCpuEngineWouldSee) {
    scene::SceneDesc desc = scene::sceneOfMeshes(kManyTriangles);
    scene::CompileMemory memory;
    scene::CompileOptions remembering;
    remembering.memory = &memory;
    const auto engine = cpu::makeCpuEngine({});
    scene::EditsOfMeshes edits(77);
    std::vector<scene::SceneEdit> done;
    for (int i = 0; i < 80; ++i) {
        scene::SceneEdit edit = edits.next(desc);
        scene::exchange(desc, edit);
        done.push_back(std::move(edit));
        const Scene scene = scene::compileScene(desc, remembering);
        done.clear();
        const auto fresh = cpu::makeCpuEngine({});
        ASSERT_TRUE(sameBits(picture(*fresh, scene::compileScene(desc)), picture(*engine, scene))) << "edit " << i;
    }
}

// Moves and materials need no new tree unless it would get too loose; what is added does.
TEST(EditedScene, TreesFollowWhatMoves) {
    scene::SceneDesc desc = scene::sceneOfMeshes(kManyTriangles);
    Scene before = scene::compileScene(desc);
    const auto accel = accel::CpuAccel::build(accel::inputOf(*before), {});
    const auto follow = [&] {
        const Scene now = scene::compileScene(desc);
        const bool follows = accel->follow(accel::inputOf(*before), accel::inputOf(*now), 2);
        if (follows) before = now;
        return follows;
    };
    desc.materials["matte"] = scene::lambertian(0.1, 0.2, 0.3);
    EXPECT_TRUE(follow());
    std::get<scene::InstanceDesc>(desc.objects[3].shape).transform = {scene::Translate{{-1, 0.5, 0}}};
    EXPECT_TRUE(follow());
    std::get<scene::SphereDesc>(desc.objects[0].shape).center = {1, 1, 1};
    EXPECT_TRUE(follow());
    scene::SceneDesc with = desc;
    with.objects.push_back(desc.objects[0]);
    const Scene larger = scene::compileScene(with);
    EXPECT_FALSE(accel->follow(accel::inputOf(*before), accel::inputOf(*larger), 2));
    const auto near = desc;
    std::get<scene::InstanceDesc>(desc.objects[3].shape).transform = {scene::Translate{{-900, 0, 0}}};
    EXPECT_FALSE(follow());
    desc = near;
    EXPECT_TRUE(follow()); // it is as it was
}

} // namespace
} // namespace rt::test
