// A scene that moves, read once and posed often: what it takes over from the pose before changes nothing.
#include <atomic>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>

#include <gtest/gtest.h>

#include "Common/App/Session/PosedScene.h"
#include "Common/App/Session/SceneLoader.h"
#include "Common/Core/Error.h"
#include "Common/Core/Interruption.h"
#include "tests/TempFolder.h"
#include "tests/unit/MovingModels.h"

namespace rt::app {
namespace {

class PosedSceneTest : public testing::Test {
  protected:
    // A lamp that moves, one that stands, one that is there from the middle on, and two places of one mesh.
    std::string saveModel() const {
        scene::MovingModel model;
        const int moving = model.addNode({{"mesh", model.addMesh(model.lamp(0.5f, 4))}});
        model.addNode({{"mesh", model.addMesh(model.lamp(0.1f, 0.1f))}});
        const int shared = model.addMesh(model.rectangle(1, 1, {{"name", "plate"}}));
        for (const float y : {-1.0f, 1.0f}) model.addNode({{"mesh", shared}, {"translation", {0, y, -1}}});
        const int growing = model.addNode({{"mesh", model.addMesh(model.lamp(0.2f, 0.2f))}, {"scale", {1, 1, 1}}});
        model.addCamera();
        model.move(moving, "translation", {-0.6f, 0, 0}, {0.6f, 0, 0});
        nlohmann::json& animation = model.json["animations"][0];
        const int times = model.addAccessor(std::vector<float>{0, 0.5f, 1}, "SCALAR");
        const int scales = model.addAccessor(std::vector<float>{0, 0, 0, 0, 0, 0, 1, 1, 1}, "VEC3");
        animation["samplers"].push_back({{"input", times}, {"output", scales}});
        animation["channels"].push_back({{"sampler", 1}, {"target", {{"node", growing}, {"path", "scale"}}}});
        return model.save(folder_ / "model.gltf").string();
    }
    static std::uint64_t hashAt(SceneRequest request, double time) {
        request.moment = {"", time, true, true};
        return compile(request)->hash;
    }
    static void expectPosesOf(const SceneRequest& request) {
        PosedScene posed(request);
        ASSERT_TRUE(posed.isAnimated());
        EXPECT_NE(hashAt(request, 0.25), hashAt(request, 0.75));
        for (const double time : {0.5, 0.75, 0.25, 0.0, 1.0, 0.75}) {
            const auto scene = posed.at({"", time, true, true});
            EXPECT_EQ(scene->hash, hashAt(request, time)) << time;
            EXPECT_EQ(scene->motion.time, time);
            EXPECT_EQ(scene->motion.length, 1);
        }
    }

    test::TempFolder folder_;
};

TEST_F(PosedSceneTest, IsWhatIsCompiledAtThatTime) {
    expectPosesOf({saveModel()});
}

TEST_F(PosedSceneTest, OfAnImportHasItsChanges) {
    saveModel();
    std::ofstream(folder_ / "own.json") << R"({"version": 1, "import": {"file": "model.gltf", "time": 0.5},
        "changes": [{"object": ["mesh 2 #1"], "becomes": []}],
        "objects": [{"type": "sphere", "center": [0, 0, 0], "radius": 0.25, "material": "plate"}]})";
    const SceneRequest request{(folder_ / "own.json").string()};
    expectPosesOf(request);
    EXPECT_EQ(compile(request)->hash, hashAt(request, 0.5));
    EXPECT_EQ(compile(request)->motion.time, 0.5);
    EXPECT_EQ(wholeMoment(request), (scene::Moment{"", 0.5, false, true}));
}

// Meshes that the memory knows stay where they are until a compilation succeeds.
TEST_F(PosedSceneTest, GoesOnAfterOneThatWasCalledOff) {
    const SceneRequest request{saveModel()};
    PosedScene posed(request);
    posed.at({"", 0.25});
    {
        const std::atomic<bool> flag{true};
        const Interruptible interruptible(flag);
        EXPECT_THROW(posed.at({"", 0.75}), Interrupted);
    }
    EXPECT_THROW(posed.at({"no such", 0.75}), UsageError);
    EXPECT_EQ(posed.at({"", 1})->hash, hashAt(request, 1));
}

TEST_F(PosedSceneTest, OfAStillSceneIsNone) {
    EXPECT_FALSE(PosedScene({"cornell-box-lights"}).isAnimated());
    std::ofstream(folder_ / "still.json") << R"({"version": 1, "objects": []})";
    EXPECT_FALSE(PosedScene({(folder_ / "still.json").string()}).isAnimated());
    EXPECT_FALSE(posesOf({"cornell-box-lights"}));
}

} // namespace
} // namespace rt::app
