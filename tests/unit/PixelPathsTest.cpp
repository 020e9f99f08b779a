// A pixel's samples that are traced again are those of a render: what they bring together is the film's pixel, all that
// they found makes up each of them, and what is said of their variance is right where it is known.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <limits>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "Common/App/Interactive/ViewProjection.h"
#include "Common/App/Session/SceneSource.h"
#include "Common/Probe/PathsReport.h"
#include "Common/Probe/PathsView.h"
#include "Common/Scene/Builtin/SceneBuilder.h"
#include "Common/Shared/Base/Sampling.h"
#include "RayTracingCPU/CpuEngine.h"
#include "tests/ConnectedScene.h"
#include "tests/unit/ProbedRoom.h"

namespace rt::probe {
namespace {

using Compiled = std::shared_ptr<const scene::CompiledScene>;

constexpr std::uint32_t kNoisySide = 18, kNoisySpp = 37; // two tiles and a bit, and blocks that are not full

app::RenderSettings settingsFor(app::LightSampling lightSampling) {
    app::RenderSettings settings;
    settings.width = settings.height = kNoisySide;
    settings.spp = kNoisySpp;
    settings.lightSampling = lightSampling;
    settings.seed = 5;
    return settings;
}

image::Image pictureOf(const Compiled& scene, const app::RenderSettings& settings) {
    const auto engine = cpu::makeCpuEngine({});
    engine->setScene(scene, nullptr);
    engine->reset(scene->camera, settings);
    while (!engine->renderSome({std::chrono::seconds(60)}).finished) {
    }
    return engine->film().resolve();
}

// Summed as films do.
class FilmSum {
  public:
    explicit FilmSum(std::uint32_t replicates) : sums_(replicates, glm::dvec3(0)), blocks_(replicates, glm::vec3(0)) {}
    void add(std::uint32_t sample, const glm::vec3& radiance) {
        const std::size_t replicate = sample % sums_.size();
        blocks_[replicate] += radiance;
        if ((sample / sums_.size() + 1) % image::Film::kBlock == 0) close(replicate);
        ++count_;
    }
    glm::vec3 mean() {
        glm::dvec3 sum(0);
        for (std::size_t i = 0; i < sums_.size(); ++i) {
            close(i);
            sum += sums_[i];
        }
        return glm::vec3(sum / static_cast<double>(count_));
    }

  private:
    void close(std::size_t replicate) {
        sums_[replicate] += glm::dvec3(blocks_[replicate]);
        blocks_[replicate] = glm::vec3(0);
    }
    std::vector<glm::dvec3> sums_;
    std::vector<glm::vec3> blocks_;
    std::uint32_t count_ = 0;
};

void expectMakesUp(const TracedSample& traced) {
    glm::dvec3 sum(0);
    for (const FoundLight& found : traced.found) {
        sum += glm::dvec3(found.radiance);
        ASSERT_EQ(found.line.size(), found.bounces + 2) << textOf(found);
        EXPECT_EQ(found.line.front().kind, PointKind::Camera);
        EXPECT_TRUE(found.line.back().kind == PointKind::Light || found.line.back().kind == PointKind::Sky);
        EXPECT_GE(found.weight, 0.0f) << textOf(found);
        EXPECT_LE(found.weight, 1.0001f) << textOf(found);
    }
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(sum[c], static_cast<double>(traced.radiance[c]), 1e-5 * std::abs(sum[c]) + 1e-7);
}

// Of pixels all over the picture; what techniques have found something.
std::set<Technique> compare(const Compiled& scene, const app::RenderSettings& settings) {
    const image::Image picture = pictureOf(scene, settings);
    const SceneFormulas formulas(scene, test::optionsFor(settings), 0.0);
    std::set<Technique> techniques;
    for (std::uint32_t pixel = 3; pixel < kNoisySide * kNoisySide; pixel += 17) {
        const std::uint32_t x = pixel % kNoisySide, y = pixel / kNoisySide;
        const PixelPaths paths(formulas, scene->camera, x, y);
        FilmSum sum(settings.replicates);
        for (std::uint32_t s = 0; s < settings.spp; ++s) {
            const TracedSample traced = paths.trace(s);
            expectMakesUp(traced);
            for (const FoundLight& found : traced.found) techniques.insert(found.technique);
            sum.add(s, traced.radiance);
        }
        const glm::vec3 mean = sum.mean();
        for (int c = 0; c < 3; ++c)
            EXPECT_EQ(mean[c], picture.pixel(x, y)[c]) << scene->id << " " << x << "," << y << " channel " << c;
    }
    return techniques;
}

class PixelPathsOf : public testing::TestWithParam<const char*> {};

TEST_P(PixelPathsOf, AreThoseOfTheFilm) {
    const Compiled scene = test::connectedThroughAll(*app::compile(app::loadScene(GetParam()), true, true));
    for (const auto& estimator : app::kLightSamplings) compare(scene, settingsFor(estimator.value));
}
INSTANTIATE_TEST_SUITE_P(, PixelPathsOf,
                         testing::Values("cornell-box-lights", "rest-of-life-cornell-box-glass", "many-lights:60",
                                         "next-week-final"),
                         [](const auto& info) {
                             std::string name = info.param;
                             std::erase_if(name, [](char c) { return !std::isalnum(static_cast<unsigned char>(c)); });
                             return name;
                         });

TEST(PixelPaths, AreThoseOfTheFilmByEverySamplerAndInReplicates) {
    const Compiled scene = app::compile(app::loadScene("cornell-box-lights"), true, true);
    for (const auto& sampler : app::kSamplers) {
        app::RenderSettings settings = settingsFor(app::LightSampling::Mis);
        settings.sampler = sampler.value;
        settings.replicates = 2;
        compare(scene, settings);
    }
}

TEST(PixelPaths, TellTechniquesApart) {
    const Compiled scene = test::connectedThroughAll(*app::compile(app::loadScene("cornell-box-lights"), true, true));
    app::RenderSettings settings = settingsFor(app::LightSampling::Mis);
    settings.pathReuse = app::PathReuse::On;
    const std::set<Technique> mis = compare(scene, settings);
    for (const Technique technique : {Technique::Scattering, Technique::LightSampling, Technique::Connection,
                                      Technique::EdgeRay, Technique::SharedPath})
        EXPECT_TRUE(mis.contains(technique)) << app::nameOf(kTechniques, technique);
    settings.edgeRays = settings.specularConnections = false;
    settings.lightSampling = app::LightSampling::Mixture;
    EXPECT_EQ(compare(scene, settings), (std::set{Technique::Seen, Technique::Mixture, Technique::BehindSpecular}));
    settings.lightSampling = app::LightSampling::Bsdf;
    settings.pathReuse = app::PathReuse::Off;
    EXPECT_EQ(compare(scene, settings), (std::set{Technique::Seen, Technique::Scattering, Technique::BehindSpecular}));
}

// ---- why it is noisy -----------------------------------------------------------------------------------------------

// A floor under a lamp of this radius.
Compiled floorUnderLamp(double radius) {
    using namespace scene;
    SceneDesc desc;
    desc.id = "floor";
    desc.camera = camera({0, 1, 4}, {0, 0, 0}, 40);
    desc.materials = {{"floor", lambertian(0.5, 0.5, 0.5)}, {"lamp", emitter({400, 400, 400}, Sides::Both)}};
    add(desc, quad({-5, 0, 5}, {10, 0, 0}, {0, 0, -10}, "floor"));
    add(desc, sphere({0, 2, 0}, radius, "lamp"));
    return test::compiled(desc);
}

PathsResult resultOf(const Compiled& scene, const app::RenderSettings& settings, const PathsSettings& asked) {
    const SceneFormulas formulas(scene, test::optionsFor(settings), 0.0);
    PathsRun run(formulas, scene->camera, kNoisySide / 2, kNoisySide / 2 + 2, asked);
    while (!run.isDone()) run.advance();
    return run.result();
}

TEST(PathsRuns, BlameScatteringForATinyLampThatIsNotAimedAt) {
    const PathsResult result = resultOf(floorUnderLamp(0.1), settingsFor(app::LightSampling::Bsdf), {4000, 8, {}});
    const std::vector<NoiseShare> techniques = sharesByTechnique(result);
    EXPECT_EQ(techniques.front().technique, Technique::Scattering);
    EXPECT_GT(techniques.front().share, 0.99);
    ASSERT_EQ(sharesByBounces(result).front().bounces, 1u) << "the lamp is out of sight";
    EXPECT_GT(sharesByBounces(result).front().share, 0.9);
    EXPECT_NE(adviceOf(result, settingsFor(app::LightSampling::Bsdf)).find("BSDF sampling after 1 bounce"),
              std::string::npos);
    // By MIS hardly anything is left of it.
    const PathsResult aimed = resultOf(floorUnderLamp(0.1), settingsFor(app::LightSampling::Mis), {4000, 8, {}});
    EXPECT_LT(aimed.variance, 0.01 * result.variance);
    EXPECT_NEAR(aimed.mean, result.mean, 5 * result.standardError());
}

TEST(PathsRuns, ListTheBrightestSampleFirst) {
    const PathsResult result = resultOf(floorUnderLamp(0.1), settingsFor(app::LightSampling::Bsdf), {4000, 8, {}});
    const auto brightest = std::ranges::max_element(result.samples) - result.samples.begin();
    ASSERT_GT(result.samples[static_cast<std::size_t>(brightest)], 0.0f);
    ASSERT_FALSE(result.listed.empty());
    EXPECT_EQ(result.listed.front().sample, result.worst().first);
    EXPECT_EQ(result.samples[result.listed.front().sample], result.samples[static_cast<std::size_t>(brightest)]);
    EXPECT_TRUE(std::ranges::is_sorted(result.listed, std::ranges::greater(),
                                       [](const ListedPath& path) { return shared::luminance(path.found.radiance); }));
}

TEST(PathsRuns, SharesMakeUpTheVariance) {
    const Compiled scene = app::compile(app::loadScene("cornell-box-lights"), true, true);
    const PathsResult result = resultOf(scene, settingsFor(app::LightSampling::Mis), {200, 8, 7});
    double mean = 0, share = 0;
    for (const NoiseShare& part : result.shares) {
        mean += part.mean;
        share += part.share;
    }
    EXPECT_NEAR(mean, result.mean, 1e-5 * result.mean);
    EXPECT_NEAR(share, 1, 1e-4);
    ASSERT_FALSE(result.selected.empty());
    double selected = 0;
    for (const ListedPath& path : result.selected) {
        EXPECT_EQ(path.sample, 7u);
        selected += static_cast<double>(shared::luminance(path.found.radiance));
    }
    EXPECT_NEAR(selected, static_cast<double>(result.samples[7]), 1e-5 * selected);
}

TEST(PathsRuns, ALightSampleEndsOnItsLamp) {
    app::RenderSettings settings = settingsFor(app::LightSampling::Mis);
    const PathsResult result = resultOf(floorUnderLamp(0.3), settings, {50, 8, {}});
    for (const ListedPath& path : result.listed) {
        ASSERT_EQ(path.found.technique, Technique::LightSampling);
        ASSERT_EQ(path.found.line.size(), 3u);
        EXPECT_NEAR(glm::distance(path.found.line[0].position, glm::vec3(0, 1, 4)), 0, 1e-5);
        EXPECT_NEAR(path.found.line[1].position.y, 0, 1e-5) << "on the floor";
        EXPECT_NEAR(glm::distance(path.found.line[2].position, glm::vec3(0, 2, 0)), 0.3, 1e-3);
        EXPECT_EQ(path.found.light, 0u);
        EXPECT_EQ(path.found.selection, 1.0f);
        // The sphere's cone, and a floor that scatters by the cosine.
        const glm::vec3 toLamp = glm::vec3(0, 2, 0) - path.found.line[1].position;
        const double sine = 0.3 / static_cast<double>(glm::length(toLamp));
        const double cone = 1 / (2 * 3.14159265 * (1 - std::sqrt(1 - sine * sine)));
        EXPECT_NEAR(path.found.lightPdf, cone, 0.25 * cone);
        const double cosine =
            static_cast<double>(glm::normalize(path.found.line[2].position - path.found.line[1].position).y);
        EXPECT_NEAR(path.found.directionPdf, cosine / 3.14159265, 1e-4);
        const double light = static_cast<double>(path.found.lightPdf),
                     bsdf = static_cast<double>(path.found.directionPdf);
        EXPECT_NEAR(path.found.weight, light * light / (light * light + bsdf * bsdf), 1e-4);
    }
}

// ---- in a window ----------------------------------------------------------------------------------------------------

TEST(PathsViews, PathsBeginInTheirPixelAndAreHiddenBehindThings) {
    const Compiled scene = app::compile(app::loadScene("cornell-box-lights"), true, true);
    app::RenderSettings settings = settingsFor(app::LightSampling::Mis);
    settings.edgeRays = false;
    const SceneFormulas formulas(scene, test::optionsFor(settings), 0.0);
    PathsRun run(formulas, scene->camera, 7, 12, {60, 40, {}});
    while (!run.isDone()) run.advance();
    const std::vector<ListedPath> paths = run.result().listed;
    ASSERT_EQ(paths.size(), 40u);
    const app::ViewProjection view(scene->camera, 1.0);
    for (const ListedPath& path : paths) {
        const auto place = view.place(glm::dvec3(path.found.line[1].position));
        ASSERT_TRUE(place);
        EXPECT_NEAR(place->x * kNoisySide, 7.5, 0.501);
        EXPECT_NEAR(place->y * kNoisySide, 12.5, 0.501);
    }
    const std::vector<PathLine> lines = linesSeenFrom(formulas, view.eye(), paths);
    ASSERT_EQ(lines.size(), paths.size());
    for (const PathLine& line : lines) { // to the first vertex nothing is in the way
        const std::size_t segment = line.pieces.size() / (paths[line.path].found.line.size() - 1);
        for (std::size_t i = 0; i < segment; ++i) EXPECT_FALSE(line.pieces[i].isHidden) << i;
        EXPECT_EQ(line.pieces.back().to, paths[line.path].found.line.back().position);
    }
    // From below the floor none of them is seen.
    const glm::dvec3 below = scene->lower - glm::dvec3(0, 100, 0);
    for (const PathLine& line : linesSeenFrom(formulas, below, paths)) EXPECT_TRUE(line.pieces.back().isHidden);
}

TEST(PathsViews, AnswerWhatARunGives) {
    const Compiled scene = floorUnderLamp(0.5);
    std::mutex mutex;
    std::condition_variable changed;
    PathsView view([&] {
        { const std::scoped_lock lock(mutex); }
        changed.notify_all();
    });
    PathsWish wish;
    wish.scene = scene;
    wish.rendering = settingsFor(app::LightSampling::Bsdf);
    wish.camera = scene->camera;
    wish.pixel = {kNoisySide / 2, kNoisySide / 2 + 2};
    wish.settings = {300, 8, {}};
    wish.eye = scene->camera.lookFrom;
    const auto answer = [&] {
        view.wish(wish);
        std::unique_lock lock(mutex);
        EXPECT_TRUE(changed.wait_for(lock, std::chrono::minutes(5), [&] {
            const auto state = view.state();
            return state && state->wish == wish && (state->result.result.isDone || !state->whyNot.empty());
        }));
        return view.state();
    };
    const PathsPlace place{"floor", wish.pixel, wish.rendering};
    const PathsResult alone = resultOf(scene, wish.rendering, wish.settings);
    EXPECT_EQ(figuresOf(answer()->result.result, place), figuresOf(alone, place));
    wish.eye.y += 1; // the camera moves: the samples stay
    EXPECT_EQ(figuresOf(answer()->result.result, place), figuresOf(alone, place));
    wish.settings.selected = alone.worst().first;
    const auto selected = answer();
    ASSERT_FALSE(selected->result.paths().empty());
    EXPECT_EQ(selected->result.paths().front().sample, alone.worst().first);
    EXPECT_EQ(selected->result.lines.size(), selected->result.paths().size());
    wish.camera.lookAt = wish.camera.lookFrom;
    EXPECT_FALSE(answer()->whyNot.empty());
    view.wish(std::nullopt);
    EXPECT_EQ(view.state(), nullptr);
}

TEST(PathsReports, SayTheSameAsFiguresAndAsText) {
    const Compiled scene = floorUnderLamp(0.5);
    const app::RenderSettings settings = settingsFor(app::LightSampling::Bsdf);
    const PathsResult result = resultOf(scene, settings, {300, 4, {}});
    const PathsPlace place{"floor", {9, 11}, settings};
    const nlohmann::ordered_json figures = figuresOf(result, place);
    EXPECT_EQ(figures["samples"], 300);
    EXPECT_EQ(figures["luminance"].size(), 300u);
    EXPECT_EQ(figures["advice"], adviceOf(result, settings));
    EXPECT_EQ(figures["settings"]["light_sampling"], "bsdf");
    EXPECT_EQ(figures["paths"].size(), result.listed.size());
    const std::string text = textOf(result, place);
    EXPECT_NE(text.find(adviceOf(result, settings)), std::string::npos) << text;
    EXPECT_NE(text.find("floor, pixel 9,11, 300 samples"), std::string::npos) << text;
    const image::Image strip = stripOf(result);
    const auto brightest =
        static_cast<std::uint32_t>(std::ranges::max_element(result.samples) - result.samples.begin());
    const std::uint32_t bar = strip.width / 300;
    EXPECT_GT(strip.pixel(brightest * bar, 0)[2], 0.5f) << "as high as the strip, and blue";
}

TEST(PathsReports, NoBrightSampleIsMissingFromTheStrip) {
    PathsResult result;
    result.samples.assign(100'000, 0.01f);
    result.samples[77'776] = std::numeric_limits<float>::quiet_NaN();
    result.samples[77'777] = 1;
    result.dominant.assign(result.samples.size(), Technique::Scattering);
    const image::Image strip = stripOf(result);
    std::uint32_t highest = 0;
    for (std::uint32_t x = 0; x < strip.width; ++x)
        if (strip.pixel(x, 0)[2] > 0.5f) ++highest;
    EXPECT_EQ(highest, 1u) << "of " << strip.width << " columns";
}

TEST(PathsReports, AStripOfDarkSamplesIsDark) {
    PathsResult result;
    result.samples.assign(20'000, 0.0f);
    result.dominant.assign(result.samples.size(), Technique::Scattering);
    for (const float value : stripOf(result).data) ASSERT_LT(value, 0.1f);
}

} // namespace
} // namespace rt::probe
