// What is sampled at a surface: densities integrate to one, samples follow them whatever is drawn, light that is traced
// is what is known of it.
#include <cmath>
#include <numbers>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "Common/App/Session/SceneSource.h"
#include "Common/Probe/ProbePicture.h"
#include "tests/unit/ProbedRoom.h"

namespace rt::probe {
namespace {

using test::kRoomSide;

class Probes : public testing::Test {
  protected:
    // The middle of the image.
    void look(const scene::SceneDesc& desc, const app::RenderSettings& like = {}) {
        app::RenderSettings settings = like;
        settings.width = settings.height = kRoomSide;
        formulas_ = std::make_unique<SceneFormulas>(test::compiled(desc), test::optionsFor(settings), 0.0);
        probe_ = Probe::at(*formulas_, kRoomSide / 2, kRoomSide / 2);
        ASSERT_TRUE(probe_);
    }
    // A pixel of a built-in scene.
    void lookAt(const std::string& scene, std::uint32_t x, std::uint32_t y, std::uint32_t side = kRoomSide) {
        app::RenderSettings settings;
        settings.width = settings.height = side;
        formulas_ =
            std::make_unique<SceneFormulas>(app::compile(app::SceneRequest{scene}), test::optionsFor(settings), 0.0);
        probe_ = Probe::at(*formulas_, x, y);
        ASSERT_TRUE(probe_);
    }
    ProbeResult resultOf(const ProbeSettings& settings) const {
        ProbeRun run(*probe_, settings);
        while (!run.isDone()) run.advance();
        return run.result();
    }
    std::vector<Strategy> allStrategies() const {
        std::vector<Strategy> all;
        for (const auto& row : kStrategies) all.push_back({row.value});
        for (std::uint32_t i = 0; i < formulas_->compiled()->globals.lightCount; ++i)
            all.push_back({StrategyKind::Light, i});
        return all;
    }
    static void expectThatItHolds(const ProbeResult& result, const std::string& name) {
        const DensityTest& test = result.tests.back().test;
        ASSERT_TRUE(test.cells) << name;
        EXPECT_TRUE(test.isResolved()) << name << ": " << test.cells->uncertainty << ", " << test.error;
        EXPECT_GT(test.cells->p, 1e-4) << name;
        EXPECT_GT(test.total, 1e-4) << name;
    }
    void expectThatAllHold(const std::string& what) const {
        for (const Strategy& strategy : allStrategies()) {
            ProbeSettings settings;
            settings.strategy = strategy;
            settings.rows = 64;
            const ProbeResult result = resultOf(settings);
            const std::string name = what + ", " + nameOf(strategy);
            const double dropped = static_cast<double>(result.dropped) / result.samples;
            EXPECT_NEAR(result.density.integral() + dropped, 1, 0.02) << name;
            ASSERT_FALSE(result.tests.empty()) << name;
            EXPECT_EQ(result.tests.back().samples, result.samples);
            expectThatItHolds(result, name);
            EXPECT_GT(result.tests.back().test.cells->degrees, 8u) << name;
        }
    }

    std::unique_ptr<SceneFormulas> formulas_;
    std::optional<Probe> probe_;
};

TEST_F(Probes, DensitiesIntegrateToOneAndSamplesFollowThem) {
    using app::ShapeSampling;
    for (const ShapeSampling shape :
         {ShapeSampling::Auto, ShapeSampling::Area, ShapeSampling::SolidAngle, ShapeSampling::Projected}) {
        app::RenderSettings settings;
        settings.sphereLight = settings.quadLight = settings.triangleLight = shape;
        look(test::probedRoom(), settings);
        expectThatAllHold("shapes sampled by " + std::to_string(static_cast<int>(shape)));
    }
    for (const app::LightSelection selection : {app::LightSelection::Power, app::LightSelection::Uniform}) {
        app::RenderSettings settings;
        settings.lightSelection = selection;
        look(test::probedRoom(0.4), settings);
        expectThatAllHold("metal, selection " + std::to_string(static_cast<int>(selection)));
    }
}

// Whose smallest one is less than what is between two places of a cell.
TEST_F(Probes, ThatHoldsForSmallLamps) {
    lookAt("veach-mis", kRoomSide / 2, kRoomSide * 3 / 4);
    ProbeSettings settings;
    settings.strategy = {StrategyKind::Light, 0};
    const ProbeResult smallest = resultOf(settings);
    EXPECT_NEAR(smallest.density.integral(), 1, 0.03);
    for (const StrategyKind kind : {StrategyKind::Lights, StrategyKind::Mixture, StrategyKind::Mis}) {
        settings.strategy = {kind};
        const ProbeResult result = resultOf(settings);
        const double dropped = static_cast<double>(result.dropped) / result.samples;
        EXPECT_NEAR(result.density.integral() + dropped, 1, 0.02) << nameOf(settings.strategy);
        expectThatItHolds(result, nameOf(settings.strategy));
    }
}

TEST_F(Probes, ThatHoldsAmongManyLights) {
    lookAt("many-lights:100", kRoomSide / 2, kRoomSide - 4);
    EXPECT_FALSE(probe_->isOfOneSquare({StrategyKind::Lights})) << "a tree takes numbers of its own";
    ProbeSettings asked;
    const ProbeResult result = resultOf(asked);
    const double dropped = static_cast<double>(result.dropped) / result.samples;
    EXPECT_NEAR(result.density.integral() + dropped, 1, 0.05);
    expectThatItHolds(result, "many lights");
    ASSERT_EQ(result.selection.size(), 16u);
    for (std::size_t i = 1; i < result.selection.size(); ++i)
        EXPECT_LE(result.selection[i].probability, result.selection[i - 1].probability);
}

// Tubes along the ceiling's edge, by area: thin, and without a bound at their edges.
TEST_F(Probes, ThatHoldsForThinLamps) {
    lookAt("cornell-box-lights", 300, 470, 600);
    for (const std::uint32_t light : {0u, 5u, 7u, 8u}) {
        ProbeSettings settings;
        settings.strategy = {StrategyKind::Light, light};
        const ProbeResult result = resultOf(settings);
        EXPECT_NEAR(result.density.integral(), 1, 4.5 * result.density.integralError() + 1e-3) << light;
        EXPECT_LT(result.density.integralError(), 0.01) << light;
        expectThatItHolds(result, "light " + std::to_string(light));
    }
}

// As counted, but by a density that is another one: in all, or in a corner of the light.
TEST_F(Probes, ADensityThatIsABitWrongFails) {
    look(test::probedRoom());
    ProbeSettings settings;
    settings.strategy = {StrategyKind::Light, 1};
    settings.samples = 65536;
    const ProbeResult result = resultOf(settings);
    expectThatItHolds(result, "right");
    std::vector<double> counts(result.density.values.size());
    double dropped = 0;
    for (std::uint32_t i = 0; i < settings.samples; ++i) {
        const auto direction = probe_->draw(settings.strategy, settings.numbers, i).direction;
        direction ? ++counts[result.density.cellOf(*direction)] : ++dropped;
    }
    for (const float factor : {0.98f, 1.02f}) {
        DirectionMap wrong = result.density;
        for (float& value : wrong.values) value *= factor;
        const DensityTest test = testDensity(counts, dropped, wrong);
        EXPECT_TRUE(test.isResolved());
        EXPECT_LT(test.total, 1e-6) << factor;
    }
    DirectionMap wrong = result.density;
    double left = 0.03 / wrong.cellSolidAngle(); // of the light, from where it begins
    for (float& value : wrong.values)
        if (left > 0) left -= std::exchange(value, value * 0.7f);
    const DensityTest test = testDensity(counts, dropped, wrong);
    EXPECT_TRUE(test.isResolved());
    EXPECT_LT(test.cells->p, 1e-6);
}

TEST_F(Probes, WhatIsNotKnownWellEnoughIsNotWrong) {
    lookAt("cornell-box-lights", 300, 470, 600);
    ProbeSettings settings;
    settings.strategy = {StrategyKind::Light, 7};
    settings.samples = 1 << 17;
    EXPECT_FALSE(resultOf(settings).tests.back().test.isResolved());
}

TEST_F(Probes, WhatIsExactIsSaidToBe) {
    scene::SceneDesc room = test::probedRoom();
    room.objects.resize(2); // the floor, and a ball that is sampled by projected solid angle
    look(room);
    ProbeSettings settings;
    settings.rows = 16;
    for (const EstimateOf& estimate : resultOf(settings).estimates)
        EXPECT_EQ(estimate.isExact(), estimate.name == "lights" || estimate.name == "lights-projected")
            << estimate.name;
}

TEST_F(Probes, AWrongDensityFails) {
    look(test::probedRoom());
    ProbeSettings settings;
    settings.strategy = {StrategyKind::Light, 0};
    ProbeResult result = resultOf(settings);
    settings.strategy = {StrategyKind::Bsdf};
    const ProbeResult other = resultOf(settings);
    std::vector<double> counts(result.density.values.size());
    for (const Drawn& drawn : other.shown)
        if (drawn.direction) ++counts[result.density.cellOf(*drawn.direction)];
    const std::vector<double> expected(result.density.values.begin(), result.density.values.end());
    const auto test = chiSquare(counts, expected);
    ASSERT_TRUE(test);
    EXPECT_LT(test->p, 1e-6);
}

TEST_F(Probes, ProjectionsAgree) {
    look(test::probedRoom());
    for (const Strategy& strategy : allStrategies()) {
        const double sphere = mapOf(*probe_, strategy, {}, 0).integral();
        const double above =
            mapOf(*probe_, strategy, {Quantity::Density, Projection::Hemisphere, 128, 4, 1}, 0).integral();
        EXPECT_NEAR(sphere, above, 0.02) << nameOf(strategy);
    }
    const DirectionMap map = mapOf(*probe_, {}, {Quantity::Density, Projection::Hemisphere, 32, 1, 1}, 0);
    for (const glm::dvec2 place : {glm::dvec2(0.5, 0.5), glm::dvec2(0.2, 0.6), glm::dvec2(0.9, 0.45)}) {
        const auto direction = map.directionOf(place);
        ASSERT_TRUE(direction);
        const auto back = map.placeOf(*direction);
        ASSERT_TRUE(back);
        EXPECT_NEAR(back->x, place.x, 1e-5);
        EXPECT_NEAR(back->y, place.y, 1e-5);
    }
    EXPECT_FALSE(map.directionOf({0.01, 0.01})) << "outside of the disk";
    EXPECT_FALSE(map.placeOf(-probe_->vertex().shading)) << "below the surface";
}

TEST_F(Probes, WeightsOfBothStrategiesAreOne) {
    look(test::probedRoom(0.3));
    const Strategy bsdf{StrategyKind::Bsdf}, lights{StrategyKind::Lights};
    const DirectionMap ofBsdf = mapOf(*probe_, bsdf, {Quantity::Weight, Projection::Sphere, 96, 1, 1}, 0);
    const DirectionMap ofLights = mapOf(*probe_, lights, {Quantity::Weight, Projection::Sphere, 96, 1, 1}, 0);
    const DirectionMap density = mapOf(*probe_, bsdf, {Quantity::Density, Projection::Sphere, 96, 1, 1}, 0);
    std::size_t shared = 0;
    for (std::size_t i = 0; i < density.values.size(); ++i) {
        if (!(density.values[i] > 0)) continue;
        EXPECT_NEAR(ofBsdf.values[i] + ofLights.values[i], 1, 1e-5);
        shared += ofLights.values[i] > 0 ? 1 : 0;
    }
    EXPECT_GT(shared, 20u);
}

TEST_F(Probes, StrataHaveOneSampleEach) {
    look(test::probedRoom());
    for (const app::SamplerKind kind : {app::SamplerKind::Stratified, app::SamplerKind::Sobol})
        for (const StrategyKind strategy : {StrategyKind::Bsdf, StrategyKind::Lights}) {
            std::set<std::pair<int, int>> cells;
            for (std::uint32_t i = 0; i < 64; ++i) {
                const shared::vec2 place = probe_->draw({strategy}, {kind, 8, 5}, i).place;
                cells.insert({static_cast<int>(place.x * 8), static_cast<int>(place.y * 8)});
            }
            EXPECT_EQ(cells.size(), 64u) << static_cast<int>(kind);
        }
}

// What is on the outermost lines may be just beside the light.
TEST_F(Probes, EdgesOfStrataLieWhereIsDrawn) {
    look(test::probedRoom());
    ProbeSettings settings;
    settings.strategy = {StrategyKind::Light, 1};
    settings.rows = 16;
    settings.samples = 64;
    EXPECT_TRUE(resultOf(settings).edges.empty()) << "which were not asked for";
    settings.showsStrata = true;
    const ProbeResult result = resultOf(settings);
    EXPECT_EQ(result.edges.size(), 18u) << "9 lines along either side of the square";
    std::size_t points = 0, inside = 0;
    for (const auto& line : result.edges)
        for (const shared::vec3& direction : line) {
            ++points;
            inside += probe_->density(settings.strategy, direction) > 0 ? 1 : 0;
        }
    EXPECT_GT(points, 1000u);
    EXPECT_GT(static_cast<double>(inside), 0.75 * static_cast<double>(points));
    settings.strategy = {StrategyKind::Mixture};
    EXPECT_TRUE(resultOf(settings).edges.empty()) << "no single square";
}

// In a closed room where everything emits and reflects a half.
TEST_F(Probes, RadianceOfAFurnaceIsOneFromEverywhere) {
    lookAt("furnace", kRoomSide / 2, kRoomSide / 2);
    const DirectionMap map = mapOf(*probe_, {}, {Quantity::Radiance, Projection::Sphere, 16, 1, 64}, 1);
    EXPECT_NEAR(map.integral(), 2 * std::numbers::pi, 0.05 * 2 * std::numbers::pi);
    const DirectionMap product = mapOf(*probe_, {}, {Quantity::Product, Projection::Sphere, 32, 1, 64}, 1);
    EXPECT_NEAR(product.integral(), 0.5, 0.02) << "half of it is reflected";
}

// Nothing but lamps sends light to a floor that is alone.
TEST_F(Probes, TheProductIsWhatStrategiesEstimate) {
    look(test::probedRoom());
    const double integral = mapOf(*probe_, {}, {Quantity::Product, Projection::Hemisphere, 192, 1, 8}, 2).integral();
    ProbeSettings settings;
    settings.samples = 16384;
    settings.rows = 16;
    for (const EstimateOf& estimate : resultOf(settings).estimates) {
        EXPECT_EQ(estimate.samples, settings.samples);
        const double deviation = std::sqrt(estimate.variance / estimate.samples);
        EXPECT_NEAR(estimate.mean, integral, 4.5 * deviation + 0.01 * integral) << estimate.name;
    }
}

TEST_F(Probes, DisksAndCylindersAreMet) {
    look(test::probedRoom());
    for (std::uint32_t light = 0; light < formulas_->compiled()->globals.lightCount; ++light) {
        std::size_t lit = 0, drawn = 0;
        for (std::uint32_t i = 0; i < 64; ++i) {
            const auto direction = probe_->draw({StrategyKind::Light, light}, {}, i).direction;
            if (!direction) continue;
            ++drawn;
            lit += probe_->contribution(*direction) > 0 ? 1 : 0;
        }
        EXPECT_GT(drawn, 0u) << light;
        EXPECT_EQ(lit, drawn) << light;
    }
}

TEST_F(Probes, PicturesHaveAllMapsDotsAndEdges) {
    look(test::probedRoom());
    ProbeSettings settings;
    settings.projections = {Projection::Sphere, Projection::Hemisphere};
    settings.rows = 64;
    settings.samples = 200;
    settings.showsStrata = true;
    const image::Image picture = pictureOf(resultOf(settings));
    ASSERT_EQ(picture.width, 192u);
    ASSERT_EQ(picture.height, 64u);
    std::size_t dots[2] = {}, edges[2] = {};
    for (std::uint32_t y = 0; y < 64; ++y)
        for (std::uint32_t x = 0; x < 192; ++x) {
            const float* p = picture.pixel(x, y);
            dots[x / 128] += p[0] > 2 * p[1] + 0.1f ? 1 : 0;
            edges[x / 128] += p[1] > 2 * p[0] + 0.05f ? 1 : 0;
        }
    for (const int part : {0, 1}) {
        EXPECT_GT(dots[part], 40u) << part;
        EXPECT_GT(edges[part], 20u) << part;
    }
}

} // namespace
} // namespace rt::probe
