#include <cmath>
#include <limits>
#include <random>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "Common/App/Interactive/CameraController.h"
#include "Common/Scene/CameraRecord.h"

namespace rt::app {
namespace {

scene::CameraDesc boxCamera() {
    scene::CameraDesc camera;
    camera.lookFrom = {278, 278, -800};
    camera.lookAt = {278, 278, 0};
    camera.verticalFov = 40;
    return camera;
}

CameraController controller() {
    CameraController c;
    c.setHome(boxCamera());
    return c;
}

TEST(CameraController, FliesAlongTheDirectionsOfTheCamera) {
    CameraController c = controller();
    const double speed = c.speed();
    EXPECT_NEAR(speed, 800.0 / 3, 1e-9);
    c.fly(0, 0, 1, 0.5);
    EXPECT_NEAR(c.camera().lookFrom.z, -800 + 0.5 * speed, 1e-9);
    EXPECT_NEAR(c.camera().lookAt.z, 0.5 * speed, 1e-9);
    c.reset();
    c.fly(1, 0, 0, 1); // seen towards +z with +y up, right is -x
    EXPECT_NEAR(c.camera().lookFrom.x, 278 - speed, 1e-9);
    c.fly(0, 1, 0, 1);
    EXPECT_NEAR(c.camera().lookFrom.y, 278 + speed, 1e-9);
    c.reset();
    EXPECT_EQ(c.camera(), boxCamera());
}

TEST(CameraController, OrbitKeepsTargetAndDistanceLookKeepsThePosition) {
    CameraController c = controller();
    c.orbit(0.7, 0.3);
    EXPECT_EQ(c.camera().lookAt, boxCamera().lookAt);
    EXPECT_NEAR(glm::length(c.camera().lookAt - c.camera().lookFrom), 800, 1e-9);
    EXPECT_GT(glm::length(c.camera().lookFrom - boxCamera().lookFrom), 100);
    c.reset();
    c.look(1.5707963267948966, 0);
    EXPECT_EQ(c.camera().lookFrom, boxCamera().lookFrom);
    EXPECT_NEAR(c.camera().lookAt.x, 278 + 800, 1e-9); // a quarter turn to the left of +z is +x
}

TEST(CameraController, PansByImageHeights) {
    CameraController c = controller();
    const double height = 2 * 800 * std::tan(20 * 3.14159265358979323846 / 180);
    c.pan(0, 0.5);
    EXPECT_NEAR(c.camera().lookFrom.y - 278, 0.5 * height, 1e-9);
    EXPECT_NEAR(c.camera().lookAt.y - 278, 0.5 * height, 1e-9);
}

TEST(CameraController, NeverLosesItsOrientation) {
    CameraController c = controller();
    std::mt19937 random(7);
    std::uniform_real_distribution<double> any(-1, 1);
    for (int i = 0; i < 20'000; ++i) {
        const double size = std::pow(10, 4 * any(random));
        switch (random() % 6) {
            case 0:
                c.fly(any(random), any(random), any(random), size);
                break;
            case 1:
                c.look(size * any(random), size * any(random));
                break;
            case 2:
                c.orbit(size * any(random), size * any(random));
                break;
            case 3:
                c.pan(size * any(random), size * any(random));
                break;
            case 4:
                c.dolly(size * any(random));
                break;
            default:
                c.changeSpeed(size * any(random));
                break;
        }
        ASSERT_NO_THROW(scene::makeCamera(c.camera(), 16, 9, glm::dvec3(0))) << i;
        ASSERT_TRUE(std::isfinite(c.speed()) && c.speed() > 0) << i;
    }
}

TEST(CameraController, RefusesWhatIsNoPose) {
    CameraController c = controller();
    scene::CameraDesc bad = boxCamera();
    bad.lookAt = bad.lookFrom;
    c.set(bad);
    EXPECT_EQ(c.camera(), boxCamera());
    bad = boxCamera();
    bad.up = {0, 0, 1};
    c.set(bad);
    EXPECT_EQ(c.camera(), boxCamera());
    bad = boxCamera();
    bad.lookFrom.x = std::numeric_limits<double>::quiet_NaN();
    c.set(bad);
    EXPECT_EQ(c.camera(), boxCamera());
    c.focusAt(-1, 1);
    EXPECT_EQ(c.camera(), boxCamera());
    c.focusAt(500, 0.5);
    EXPECT_EQ(c.camera().focusDistance, 250);
}

TEST(CameraController, PosesSurviveTheClipboard) {
    scene::CameraDesc pose = boxCamera();
    pose.lookFrom.x = 0.1;
    pose.defocusAngle = 1.0 / 3;
    EXPECT_EQ(CameraController::fromText(CameraController::toText(pose), boxCamera()), pose);
    for (const char* text : {"", "hello", "[]", "12", "{\"look_from\": [1, 2]}", "{\"look_from\": \"a\"}",
                             "{\"vertical_fov\": 500}", "{\"look_at\": [278, 278, -800]}"}) {
        EXPECT_FALSE(CameraController::fromText(text, boxCamera())) << text;
    }
}

} // namespace
} // namespace rt::app
