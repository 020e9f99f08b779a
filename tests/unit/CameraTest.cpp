#include <algorithm>
#include <numbers>

#include "Common/Core/Error.h"
#include "Common/Scene/Json/CameraRecord.h"
#include "Common/Shared/Camera.h"
#include "tests/unit/Statistics.h"

namespace rt::shared {
namespace {

using glm::dvec3;
using scene::CameraDesc;
using scene::makeCamera;
using test::chiSquareP;
using test::kSignificance;
using test::Uniforms;

CameraDesc cornell() {
    CameraDesc desc;
    desc.lookFrom = {278, 278, -800};
    desc.lookAt = {278, 278, 0};
    desc.verticalFov = 40;
    return desc;
}

Ray rayAt(const Camera& camera, uvec2 pixel, uvec2 size, vec2 inPixel, vec2 lens = vec2(0.5f), float time = 0) {
    return generateCameraRay(kFeatureAll, camera, pixel, size, inPixel, lens, time);
}

TEST(Camera, MiddleAndCornersOfTheImage) {
    const Camera camera = makeCamera(cornell(), 600, 600, dvec3(278, 278, -800));
    EXPECT_EQ(camera.origin, vec3(0));
    const Ray middle = rayAt(camera, uvec2(300, 300), uvec2(600, 600), vec2(0));
    EXPECT_NEAR(glm::length(dvec3(middle.direction) - dvec3(0, 0, 1)), 0, 2e-7);
    // Image right is -x for a view along +z, and rows go down.
    const double edge = std::tan(20 * std::numbers::pi / 180);
    const Ray upperLeft = rayAt(camera, uvec2(0, 0), uvec2(600, 600), vec2(0));
    EXPECT_NEAR(upperLeft.direction.x / upperLeft.direction.z, edge, 1e-6);
    EXPECT_NEAR(upperLeft.direction.y / upperLeft.direction.z, edge, 1e-6);
    const Ray lowerRight = rayAt(camera, uvec2(599, 599), uvec2(600, 600), vec2(1));
    EXPECT_NEAR(lowerRight.direction.x / lowerRight.direction.z, -edge, 1e-6);
    EXPECT_NEAR(lowerRight.direction.y / lowerRight.direction.z, -edge, 1e-6);
}

TEST(Camera, FieldOfViewIsVertical) {
    const Camera camera = makeCamera(cornell(), 800, 400, dvec3(0));
    EXPECT_EQ(camera.origin, vec3(278, 278, -800));
    const double edge = std::tan(20 * std::numbers::pi / 180);
    const Ray corner = rayAt(camera, uvec2(0, 0), uvec2(800, 400), vec2(0));
    EXPECT_NEAR(corner.direction.x / corner.direction.z, 2 * edge, 2e-6);
    EXPECT_NEAR(corner.direction.y / corner.direction.z, edge, 1e-6);
}

TEST(Camera, DirectionsAreUnitAndFillThePixel) {
    CameraDesc desc = cornell();
    desc.up = {0.3, 1, -0.2};
    const Camera camera = makeCamera(desc, 320, 200, dvec3(0));
    Uniforms uniform(1);
    for (int i = 0; i < 10000; ++i) {
        const uvec2 pixel(uniform.word() % 320, uniform.word() % 200);
        const Ray ray = rayAt(camera, pixel, uvec2(320, 200), uniform.pair());
        ASSERT_NEAR(glm::length(dvec3(ray.direction)), 1, 3e-7);
    }
    // One point of the image, reached from two pixels that share it.
    const Ray a = rayAt(camera, uvec2(10, 20), uvec2(320, 200), vec2(1, 0.5f));
    const Ray b = rayAt(camera, uvec2(11, 20), uvec2(320, 200), vec2(0, 0.5f));
    EXPECT_EQ(a.direction, b.direction);
}

TEST(Camera, LensRaysMeetOnThePlaneOfFocus) {
    CameraDesc desc;
    desc.lookFrom = {13, 2, 3};
    desc.lookAt = {0, 0, 0};
    desc.verticalFov = 20;
    desc.defocusAngle = 0.6;
    desc.focusDistance = 10;
    const Camera camera = makeCamera(desc, 600, 600, desc.lookFrom);
    const dvec3 forward = glm::normalize(desc.lookAt - desc.lookFrom);
    const double radius = 10 * std::tan(0.3 * std::numbers::pi / 180);
    const Ray chief = rayAt(camera, uvec2(100, 500), uvec2(600, 600), vec2(0.25f));
    Uniforms uniform(2);
    std::vector<std::uint64_t> counts(16 * 16);
    const auto onFocus = [&](const Ray& ray) {
        const double t = (10 - glm::dot(dvec3(ray.origin), forward)) / glm::dot(dvec3(ray.direction), forward);
        return dvec3(ray.origin) + dvec3(ray.direction) * t;
    };
    for (int i = 0; i < 1 << 16; ++i) {
        const Ray ray = rayAt(camera, uvec2(100, 500), uvec2(600, 600), vec2(0.25f), uniform.pair());
        ASSERT_LE(glm::length(onFocus(ray) - onFocus(chief)), 1e-5);
        ASSERT_NEAR(glm::dot(dvec3(ray.origin), forward), 0, 1e-7);
        const double x = glm::dot(dvec3(ray.origin), glm::normalize(dvec3(camera.lensU))) / radius;
        const double y = glm::dot(dvec3(ray.origin), glm::normalize(dvec3(camera.lensV))) / radius;
        ASSERT_LE(x * x + y * y, 1 + 1e-6);
        const int ring = std::min(static_cast<int>((x * x + y * y) * 16), 15);
        const int sector = static_cast<int>((std::atan2(y, x) / (2 * std::numbers::pi) + 1) * 16) % 16;
        ++counts[ring * 16 + sector];
    }
    EXPECT_GT(chiSquareP(counts), kSignificance);
}

TEST(Camera, FeaturesDecideWhatIsEvaluated) {
    CameraDesc desc = cornell();
    desc.defocusAngle = 2;
    const Camera lens = makeCamera(desc, 600, 600, dvec3(0));
    desc.defocusAngle = 0;
    const Camera pinhole = makeCamera(desc, 600, 600, dvec3(0));
    const uvec2 pixel(3, 4), size(600, 600);
    const vec2 u(0.9f, 0.1f);
    const Ray plain = generateCameraRay(kFeatureNone, lens, pixel, size, u, u, 0.5f);
    EXPECT_EQ(plain.origin, lens.origin);
    EXPECT_EQ(plain.time, 0.0f);
    const Ray full = generateCameraRay(kFeatureAll, lens, pixel, size, u, u, 0.5f);
    EXPECT_NE(full.origin, lens.origin);
    EXPECT_EQ(full.time, 0.5f);
    // A lens without extent gives the pinhole's bits.
    EXPECT_EQ(generateCameraRay(kFeatureAll, pinhole, pixel, size, u, u, 0).direction, plain.direction);
}

// The camera is made in double and relative to the origin: how far it is from zero does not matter.
TEST(Camera, FarFromZero) {
    CameraDesc desc = cornell();
    desc.defocusAngle = 1;
    const Camera near = makeCamera(desc, 600, 600, desc.lookFrom);
    const dvec3 shift(1 << 20, -(1 << 21), 1 << 22);
    desc.lookFrom += shift, desc.lookAt += shift;
    const Camera far = makeCamera(desc, 600, 600, desc.lookFrom);
    EXPECT_EQ(near.origin, far.origin);
    EXPECT_EQ(near.corner, far.corner);
    EXPECT_EQ(near.across, far.across);
    EXPECT_EQ(near.down, far.down);
    EXPECT_EQ(near.lensU, far.lensU);
}

TEST(Camera, ImpossibleCamerasAreErrors) {
    const auto fails = [](auto change) {
        CameraDesc desc = cornell();
        change(desc);
        EXPECT_THROW(makeCamera(desc, 10, 10, dvec3(0)), InputError);
    };
    fails([](CameraDesc& d) { d.lookAt = d.lookFrom; });
    fails([](CameraDesc& d) { d.up = {0, 0, 3}; });
    fails([](CameraDesc& d) { d.up = {0, 0, 0}; });
    fails([](CameraDesc& d) { d.lookAt.x = std::nan(""); });
    fails([](CameraDesc& d) { d.verticalFov = 180; });
    fails([](CameraDesc& d) { d.verticalFov = std::nan(""); });
    fails([](CameraDesc& d) { d.focusDistance = 0; });
    fails([](CameraDesc& d) { d.defocusAngle = -1; });
}

} // namespace
} // namespace rt::shared
