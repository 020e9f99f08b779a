// Models that bring no light are seen well in their studio.
#include <algorithm>
#include <cmath>
#include <vector>

#include "Common/Scene/FramingCamera.h"
#include "Common/Scene/Studio.h"
#include "tests/image/Harness.h"

namespace rt::test {
namespace {

using namespace rt::scene;
using glm::dvec3;

// A box of grey as OBJ files without materials have it.
SceneDesc boxInStudio(const dvec3& halves) {
    SceneDesc scene;
    scene.materials["grey"].albedo = dvec3(0.7);
    BoxDesc box;
    box.min = -halves;
    box.max = halves;
    box.material = "grey";
    scene.objects.push_back({box});
    Bounds bounds;
    bounds.add(box.min);
    bounds.add(box.max);
    scene.camera = framingCamera(bounds);
    addStudioIfUnlit(scene, bounds);
    return scene;
}

TEST(Studio, ModelsOfAllSizesAreLitWell) {
    const app::RenderSettings settings = smallSettings(32, 64);
    double first = 0;
    for (const double size : {1.0, 1e-3, 1e5}) {
        for (const dvec3& shape : {dvec3(1, 1, 1), dvec3(1, 1e-3, 1)}) {
            const Estimate estimate = render(boxInStudio(size * shape), settings);
            EXPECT_EQ(estimate.nonfinite, 0u);
            EXPECT_GT(estimate.mean.g, 0.2) << size;
            EXPECT_LT(estimate.mean.g, 0.6) << size;
            const auto [darkest, brightest] =
                std::minmax_element(estimate.image.data.begin(), estimate.image.data.end());
            EXPECT_GT(*darkest, 0.02f) << size;  // no black
            EXPECT_LT(*brightest, 1.2f) << size; // no blown highlight on what is white and dull
            if (shape.y < 1) continue;
            if (first == 0) first = estimate.mean.g;
            EXPECT_NEAR(estimate.mean.g / first, 1, 0.02) << size;
        }
    }
}

} // namespace
} // namespace rt::test
