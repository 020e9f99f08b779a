// Scenes of pbrt whose radiance is known: tests/data/pbrt says why.
#include <string>

#include <gtest/gtest.h>

#include "Common/Scene/Pbrt/PbrtLoader.h"
#include "tests/image/Harness.h"

namespace rt::test {
namespace {

Estimate pbrtRender(const char* name, std::uint32_t spp) {
    const SceneDesc scene = scene::loadPbrtScene(std::string(RT_TEST_DATA_DIR "/pbrt/") + name + ".pbrt");
    return render(scene, smallSettings(16, spp));
}

TEST(PbrtRadiance, AWhiteBallIsNotSeenInAFurnace) {
    EXPECT_TRUE(isMean(pbrtRender("furnace", 512), glm::dvec3(1)));
}

TEST(PbrtRadiance, AFloorUnderABallOfLight) {
    EXPECT_TRUE(isMean(pbrtRender("sphere-light", 64), glm::dvec3(0.125)));
}

} // namespace
} // namespace rt::test
