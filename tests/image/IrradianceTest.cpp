// A Lambert floor under one light, seen at a point: radiance = albedo / pi * irradiance, which is known in closed form.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>
#include <vector>

#include "Common/Scene/Affine.h"
#include "Common/Scene/Daylight.h"
#include "tests/image/AnalyticScenes.h"
#include "tests/image/Harness.h"
#include "tests/unit/Oracles.h"

namespace rt::test {
namespace {

using namespace rt::scene;
using glm::dvec3;

void expectIrradiance(const SceneDesc& desc, double formFactor, const char* what) {
    const auto scene = compileScene(desc);
    const dvec3 truth = dvec3(3, 2, 1) * (formFactor * kFloorAlbedo / std::numbers::pi);
    for (app::RenderSettings settings : estimatorsInPairs(smallSettings(4, 2048))) {
        settings.maxDepth = 2;
        for (auto shape : {app::ShapeSampling::Auto, app::ShapeSampling::SolidAngle, app::ShapeSampling::Projected,
                           app::ShapeSampling::Area}) {
            if (settings.lightSampling == app::LightSampling::Bsdf && shape != app::ShapeSampling::Auto) continue;
            settings.sphereLight = settings.quadLight = settings.triangleLight = shape;
            EXPECT_TRUE(isMean(render(*scene, settings), truth))
                << what << ", " << describe(settings) << ", shape " << static_cast<int>(shape);
        }
    }
}

TEST(Irradiance, UnderASphere) {
    for (dvec3 center : {dvec3(0, 2, 0), dvec3(1.5, 1.2, -0.5)}) {
        SceneDesc desc = floorScene();
        desc.objects.push_back({SphereDesc{center, 0.8, {}, "light"}});
        const double d = glm::length(center);
        expectIrradiance(desc, std::numbers::pi * (0.64 / (d * d)) * center.y / d, "sphere");
    }
}

// Half axes of 1 : 10 : 0.1, turned; and a sheared and mirrored one.
TEST(Irradiance, UnderAnEllipsoid) {
    const dvec3 center(0.5, 2.5, -0.4);
    const Transform turned = {Scale{{0.2, 2, 0.02}}, Rotate{{1, 0, 0.2}, 75}, Translate{center}};
    const Transform sheared = {Rotate{{1, 2, 3}, 50}, Scale{{-0.8, 0.3, 0.5}}, Translate{center}};
    for (const Transform& transform : {turned, sheared}) {
        SceneDesc desc = floorScene();
        GroupDesc group;
        group.transform = transform;
        group.objects.push_back({SphereDesc{dvec3(0), 1, {}, "light"}});
        desc.objects.push_back({group});
        const Affine map = toAffine(transform);
        expectIrradiance(desc, polygonIrradiance(ellipsoidOutline(map.offset, map.linear)), "ellipsoid");
    }
}

TEST(Irradiance, UnderAQuad) {
    for (auto [corner, u, v] : {std::array<dvec3, 3>{dvec3(-0.5, 1, -0.7), dvec3(1.5, 0, 0), dvec3(0, 0, 1)},
                                std::array<dvec3, 3>{dvec3(0.4, 0.1, -1), dvec3(0.3, 1, 0.2), dvec3(0, 0.5, 2)}}) {
        SceneDesc desc = floorScene();
        desc.objects.push_back({QuadDesc{corner, u, v, "light"}});
        const std::array<dvec3, 4> outline{corner, corner + u, corner + u + v, corner + v};
        expectIrradiance(desc, polygonIrradiance(outline), "quad");
    }
}

// On the axis the form factor is r^2 / (r^2 + h^2); elsewhere by the polygon of so many sides. Holes are subtracted.
TEST(Irradiance, UnderADisk) {
    constexpr int kSides = 4096;
    const auto outline = [](const DiskDesc& disk, double radius) {
        const dvec3 u = glm::normalize(glm::cross(disk.normal, dvec3(0.3, 0.2, 1))), v = glm::cross(disk.normal, u);
        std::vector<dvec3> points;
        for (int i = 0; i < kSides; ++i) {
            const double turn = 2 * std::numbers::pi * i / kSides;
            points.push_back(disk.center + radius * (std::cos(turn) * u + std::sin(turn) * v));
        }
        return points;
    };
    SceneDesc above = floorScene();
    above.objects.push_back({DiskDesc{{0, 1.5, 0}, {0, -1, 0}, 1, 0, "light"}});
    expectIrradiance(above, std::numbers::pi / (1 + 1.5 * 1.5), "disk on the axis");
    for (const DiskDesc& disk : {DiskDesc{{0.8, 1.2, -0.5}, {0.6, -0.8, 0}, 0.9, 0, "light"},
                                 DiskDesc{{0.4, 0.7, -0.3}, {0, -0.8, 0.6}, 0.6, 0.25, "light"}}) {
        SceneDesc desc = floorScene();
        desc.objects.push_back({disk});
        const double hole = disk.innerRadius > 0 ? polygonIrradiance(outline(disk, disk.innerRadius)) : 0;
        expectIrradiance(desc, polygonIrradiance(outline(disk, disk.radius)) - hole, "disk");
    }
}

// By the sum over the side that faces the floor.
TEST(Irradiance, UnderACylinder) {
    constexpr int kSteps = 1000;
    for (const CylinderDesc& tube : {CylinderDesc{{-0.8, 1.2, 0.3}, {1.1, 1.5, -0.4}, 0.3, "light"},
                                     CylinderDesc{{1.2, 0.1, 0.2}, {1.0, 1.6, 0.1}, 0.4, "light"}}) {
        const dvec3 axis = tube.top - tube.base, w = glm::normalize(axis);
        const dvec3 u = glm::normalize(glm::cross(w, dvec3(0.3, 0.2, 1))), v = glm::cross(w, u);
        double sum = 0;
        for (int i = 0; i < kSteps; ++i) {
            const double turn = 2 * std::numbers::pi * (i + 0.5) / kSteps;
            const dvec3 normal = std::cos(turn) * u + std::sin(turn) * v;
            for (int j = 0; j < kSteps; ++j) {
                const dvec3 p = tube.base + axis * ((j + 0.5) / kSteps) + tube.radius * normal;
                const double d2 = glm::dot(p, p);
                sum += std::max(p.y, 0.0) * std::max(-glm::dot(p, normal), 0.0) / (d2 * d2);
            }
        }
        SceneDesc desc = floorScene();
        desc.materials["light"].sides = Sides::Front;
        desc.objects.push_back({tube});
        expectIrradiance(desc, sum * 2 * std::numbers::pi * tube.radius * glm::length(axis) / (kSteps * kSteps),
                         "cylinder");
    }
}

TEST(Irradiance, UnderATriangle) {
    const std::array<dvec3, 3> triangle{dvec3(-1, 0.8, 0.3), dvec3(1.2, 1.1, 0.1), dvec3(0.2, 0.9, -1.4)};
    SceneDesc desc = floorScene();
    MeshData mesh;
    mesh.positions.assign(triangle.begin(), triangle.end());
    mesh.triangles = {{0, 1, 2}};
    desc.objects.push_back({MeshDesc{mesh, "light"}});
    expectIrradiance(desc, polygonIrradiance(triangle), "triangle");
}

// What rounds must not grow with the floor.
TEST(Irradiance, BesideABallOnAHugeFloor) {
    app::RenderSettings settings = smallSettings(4, 1024);
    settings.maxDepth = 2;
    for (const HugeFloor floor : {HugeFloor::Quad, HugeFloor::Triangles, HugeFloor::Box}) {
        for (const double halfSize : {1e3, 1e5, 1e7}) {
            for (const double x : {0.1, 0.3, 1.0}) {
                const Estimate seen = render(ballOnFloor(floor, halfSize, x), settings);
                EXPECT_NEAR(seen.mean.x / skyBesideBall(x), 1, 0.01 + 4 * seen.standardError.x / skyBesideBall(x))
                    << "floor " << static_cast<int>(floor) << " of " << halfSize << " at " << x;
            }
        }
    }
}

// Rays go through a part of a lamp, and shadow rays end before it: its samples have to know.
TEST(Irradiance, UnderLampsThatArePartlyClear) {
    for (const ClearLamp& lamp : clearLamps()) expectIrradiance(lamp.desc, lamp.formFactor, lamp.what);
}

TEST(Irradiance, LampsThatNothingMeetsAreNoLights) {
    for (const ClearLamp& lamp : clearLamps())
        EXPECT_EQ(compileScene(lamp.desc)->lights.empty(), lamp.formFactor == 0) << lamp.what;
}

// Shirley's mixture aims at a lamp and at a target, beside which a point light is sampled: each by numbers that chose
// between the others.
TEST(Irradiance, UnderALampAPointLightAndATarget) {
    SceneDesc desc = floorScene();
    const dvec3 center(0, 2, 0);
    desc.objects.push_back({SphereDesc{center, 0.8, {}, "light"}});
    const std::vector<ObjectDesc> lights = {{PointLightDesc{dvec3(1, 2, -0.5), dvec3(0.5)}}};
    desc.objects.push_back(lights[0]);
    const dvec3 irradiance = dvec3(3, 2, 1) * (std::numbers::pi * 0.64 / 4) + punctualIrradiance(lights);
    for (const int targets : {1, 3}) {
        desc.importanceTargets.assign(static_cast<std::size_t>(targets), {SphereBoundary{dvec3(-2, 1, 0.5), 0.5}});
        const auto scene = compileScene(desc);
        for (app::RenderSettings settings : allEstimators(smallSettings(4, 4096))) {
            settings.maxDepth = 2;
            EXPECT_TRUE(isMean(render(*scene, settings), irradiance * (kFloorAlbedo / std::numbers::pi)))
                << targets << " targets, " << describe(settings);
        }
    }
}

// The radiance of the floor, by every estimator, which all sample punctual lights.
void expectPunctual(const std::vector<ObjectDesc>& lights, std::uint32_t spp) {
    const auto scene = compileScene(floorUnder(lights));
    const dvec3 truth = punctualIrradiance(lights) * (kFloorAlbedo / std::numbers::pi);
    for (app::RenderSettings settings : allEstimators(smallSettings(4, spp))) {
        settings.maxDepth = 2;
        EXPECT_TRUE(isMean(render(*scene, settings), truth)) << describe(settings);
    }
}

TEST(Irradiance, UnderAPunctualLight) {
    for (const ObjectDesc& light : punctualLights()) {
        SCOPED_TRACE(light.shape.index());
        ASSERT_GT(punctualIrradiance({light}).y, 0);
        expectPunctual({light}, 256);
    }
}

TEST(Irradiance, UnderSomePunctualLightsAndUnderSoManyThatATreeChooses) {
    for (const std::uint32_t count : {12u, 40u, 300u}) expectPunctual(manyPunctualLights(count), 512);
}

// A lamp and a point light: scattering finds the one, next-event estimation alone the other.
TEST(Irradiance, UnderALampAndAPunctualLight) {
    SceneDesc desc = floorScene();
    const dvec3 center(0, 2, 0), position(1, 2, -0.5);
    desc.objects.push_back({SphereDesc{center, 0.8, {}, "light"}});
    const std::vector<ObjectDesc> lights = {{PointLightDesc{position, dvec3(0.5)}}};
    desc.objects.push_back(lights[0]);
    const auto scene = compileScene(desc);
    const dvec3 irradiance = dvec3(3, 2, 1) * (std::numbers::pi * 0.64 / 4) + punctualIrradiance(lights);
    for (app::RenderSettings settings : allEstimators(smallSettings(4, 2048))) {
        settings.maxDepth = 2;
        EXPECT_TRUE(isMean(render(*scene, settings), irradiance * (kFloorAlbedo / std::numbers::pi)))
            << describe(settings);
    }
}

TEST(Irradiance, OfPunctualLightsInTheShadow) {
    for (const ObjectDesc& light : punctualLights()) {
        SceneDesc desc = floorScene();
        desc.objects.push_back(light);
        desc.objects.push_back({QuadDesc{{-0.1, 0.01, -0.1}, {0.2, 0, 0}, {0, 0, 0.2}, "floor"}});
        desc.camera.lookFrom = {0, 0.005, 0.004}; // below the cover
        if (const auto* sun = std::get_if<DirectionalLightDesc>(&light.shape); sun && sun->direction.y > -0.1) continue;
        app::RenderSettings settings = smallSettings(4, 64);
        settings.maxDepth = 2;
        EXPECT_EQ(render(desc, settings).mean, dvec3(0)) << light.shape.index();
    }
}

// The light stands next to the camera, where coordinates are small, and the wall far away: its shadow rays are long
// against the coordinates of the light, and rounding must not let them end behind it.
TEST(Irradiance, OfAWallFarAway) {
    for (const double distance : {1e2, 1e3, 1e4}) {
        SceneDesc desc = emptyScene({0.1, 0.2, 0.3}, {0.2 * distance, distance, 0.6 * distance}, 1e-3);
        const dvec3 toWall = glm::normalize(desc.camera.lookAt - desc.camera.lookFrom);
        const dvec3 u = glm::normalize(glm::cross(toWall, dvec3(1, 0, 0)));
        const dvec3 v = glm::cross(toWall, u);
        MaterialDesc wall;
        wall.albedo = dvec3(kFloorAlbedo);
        desc.materials["wall"] = wall;
        MaterialDesc light;
        light.kind = MaterialKind::Emitter;
        light.emission = dvec3(3, 2, 1) * distance * distance;
        light.sides = Sides::Both;
        desc.materials["light"] = light;
        const dvec3 at = desc.camera.lookAt;
        desc.objects.push_back({QuadDesc{at - distance * (u + v), 2 * distance * u, 2 * distance * v, "wall"}});
        const dvec3 corner = desc.camera.lookFrom + 0.5 * u;
        const dvec3 edgeU = u * 0.7;
        const dvec3 edgeV = (v + 0.5 * toWall) * 0.9;
        desc.objects.push_back({QuadDesc{corner, edgeU, edgeV, "light"}});
        const dvec3 middle = corner + 0.5 * (edgeU + edgeV) - at;
        const dvec3 way = glm::normalize(middle);
        const double formFactor =
            std::abs(glm::dot(glm::cross(edgeU, edgeV), way) * glm::dot(toWall, way)) /
            glm::dot(middle, middle); // but for the square of the light's extent over the distance
        app::RenderSettings settings = smallSettings(8, 4096);
        settings.maxDepth = 2;
        const dvec3 truth = dvec3(3, 2, 1) * (distance * distance * formFactor * kFloorAlbedo / std::numbers::pi);
        const Estimate estimate = render(desc, settings);
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(estimate.mean[c] / truth[c], 1, 5e-4) << distance;
    }
}

// E = pi (A + 2/3 B n_y) under the sky A + B direction.y.
TEST(Irradiance, UnderTheGradientSky) {
    SceneDesc desc = floorScene();
    desc.background = GradientBackground{dvec3(1), dvec3(0.5, 0.7, 1.0)};
    const dvec3 middle = (dvec3(1) + dvec3(0.5, 0.7, 1.0)) / 2.0;
    const dvec3 slope = (dvec3(0.5, 0.7, 1.0) - dvec3(1)) / 2.0;
    EXPECT_TRUE(isMean(render(desc, smallSettings(4, 2048)), kFloorAlbedo * (middle + slope * (2.0 / 3.0))));
}

// E = E_sun sin(elevation) + the integral of L cos over the sky, by a quadrature of the formulas around the zenith.
TEST(Irradiance, UnderSunAndSky) {
    constexpr int kSteps = 300;
    for (const double elevation : {15.0, 70.0}) {
        SceneDesc desc = floorScene();
        SunSkyBackground sky;
        sky.sunElevation = elevation;
        sky.factor = dvec3(2, 1, 0.5);
        desc.background = sky;
        const Daylight daylight(sky);
        const dvec3 sun = sunDirection(sky);
        dvec3 ofSky(0);
        for (int i = 0; i < kSteps; ++i) // of the squared cosine, which makes all cells alike
            for (int j = 0; j < kSteps; ++j) {
                const double y = std::sqrt((i + 0.5) / kSteps), r = std::sqrt(1 - y * y);
                const double around = 2 * std::numbers::pi * (j + 0.5) / kSteps;
                const double toSun = glm::dot(dvec3(r * std::cos(around), y, r * std::sin(around)), sun);
                ofSky += daylight.sky(y, std::acos(std::clamp(toSun, -1.0, 1.0)));
            }
        const dvec3 irradiance = daylight.sun() * sun.y + ofSky * (std::numbers::pi / (kSteps * kSteps));
        const dvec3 truth = kFloorAlbedo / std::numbers::pi * sky.factor * irradiance;
        const Estimate estimate = render(desc, smallSettings(4, 4096));
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(estimate.mean[c] / truth[c], 1, 2e-3 + 4 * estimate.standardError[c] / truth[c]) << elevation;
    }
}

TEST(Transmittance, OfAnAbsorbingSlab) {
    for (double depth : {1e-4, 0.1, 1.0, 5.0}) {
        SceneDesc desc = emptyScene({0, 0, 4}, {0, 0, 0}, 1e-3);
        desc.background = ConstantBackground{dvec3(1)};
        desc.objects.push_back({MediumDesc{BoxBoundary{dvec3(-3, -3, -1), dvec3(3, 3, 1)}, depth / 2, dvec3(0)}});
        EXPECT_TRUE(isMean(render(desc, smallSettings(8, 16384)), dvec3(std::exp(-depth))))
            << "optical depth " << depth;
    }
}

// Light sampling looks through media: the shadow ray is multiplied by their transmittance.
// Of light that comes from infinity the whole layer is in the way.
TEST(Transmittance, OfALayerUnderADirectionalLight) {
    SceneDesc desc = floorScene();
    const std::vector<ObjectDesc> lights = {{DirectionalLightDesc{{3, -4, 0}, dvec3(3, 2, 1)}}};
    desc.objects.push_back(lights[0]);
    desc.objects.push_back({MediumDesc{BoxBoundary{dvec3(-9, 2, -9), dvec3(9, 3, 9)}, 0.8, dvec3(0)}});
    app::RenderSettings settings = smallSettings(4, 64);
    settings.maxDepth = 2;
    const dvec3 irradiance = punctualIrradiance(lights) * std::exp(-0.8 / 0.8); // the cosine is 0.8, too
    EXPECT_TRUE(isMean(render(desc, settings), irradiance * (kFloorAlbedo / std::numbers::pi)));
}

// Light that a thin layer scatters once: isotropic, its collisions a fraction of those that go through.
TEST(Transmittance, OfAMediumUnderAPunctualLight) {
    const double depth = 1e-3;
    SceneDesc desc = emptyScene({0, 0, 4}, {0, 0, 0}, 1e-3);
    desc.objects.push_back({MediumDesc{BoxBoundary{dvec3(-9, -9, -0.01), dvec3(9, 9, 0.01)}, depth / 0.02, dvec3(1)}});
    desc.objects.push_back({PointLightDesc{{0, 3, 4}, dvec3(3, 2, 1)}});
    app::RenderSettings settings = smallSettings(8, 4096);
    settings.maxDepth = 2;
    const Estimate estimate = render(desc, settings);
    const double once = depth / (4 * std::numbers::pi * 25);
    // But for what is scattered or lost twice, in the order of the depth.
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(estimate.mean[c], (3 - c) * once, 4 * estimate.standardError[c] + 2 * depth * (3 - c) * once) << c;
}

TEST(Transmittance, OfALayerBetweenLightAndFloor) {
    SceneDesc desc = floorScene();
    desc.objects.push_back({SphereDesc{dvec3(0, 4, 0), 0.01, {}, "light"}});
    desc.objects.push_back({MediumDesc{BoxBoundary{dvec3(-9, 2, -9), dvec3(9, 3, 9)}, 0.8, dvec3(0)}});
    const double e = std::numbers::pi * 1e-4 / 16 * std::exp(-0.8);
    app::RenderSettings settings = smallSettings(4, 1024);
    settings.maxDepth = 2;
    // Over the light's cone the path through the layer varies by less than 1e-5.
    EXPECT_TRUE(isMean(render(desc, settings), dvec3(3, 2, 1) * (e * kFloorAlbedo / std::numbers::pi)));
}

} // namespace
} // namespace rt::test
