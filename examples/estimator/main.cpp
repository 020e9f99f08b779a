// An estimator of one's own as an Engine: what drives the renderers of the library, here a FilmRun, drives it, too.
//
// It estimates how much of the sky each point sees (ambient occlusion). A ball of radius 1 lies on a floor, of which
// a point at the distance d from where they touch has it at D = sqrt(1 + d^2): it covers cos / D^2 of the hemisphere
// weighted by the cosine, and leaves 1 - D^-3. The picture is compared with that.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <stdexcept>
#include <utility>

#include "Common/Accel/CpuAccel.h"
#include "Common/Accel/Traverse/RayQuery.h"
#include "Common/Render/Engine.h"
#include "Common/Render/FilmRun.h"
#include "Common/Render/RenderParams.h"
#include "Common/Scene/Builtin/SceneBuilder.h"
#include "Common/Scene/CameraRecord.h"
#include "Common/Scene/Compiler/SceneCompiler.h"
#include "Common/Shared/Base/Random.h"
#include "Common/Shared/Camera.h"
#include "Common/Shared/Shape/Surface.h"

namespace app = rt::app;
using namespace rt::shared; // vec3, Ray, and the formulas
using rt::image::Film;

namespace {
class AmbientOcclusion final : public app::Engine {
  public:
    bool setScene(std::shared_ptr<const rt::scene::CompiledScene> scene, const std::atomic<bool>* cancel) override {
        const rt::scene::CompiledScene& s = *scene;
        auto tree = rt::accel::CpuAccel::build(
            {s.spheres, s.sphereMotions, s.quads, s.positions, s.triangles, s.geometries, s.instances, s.rounds}, {},
            cancel);
        if (!tree) return false;
        tree_ = std::move(tree);
        tracer_ = rt::accel::rayQuery().tracer(tree_->view().kinds);
        view_ = viewOf(s, s.globals);
        scene_ = std::move(scene);
        return true;
    }

    void reset(const rt::scene::CameraDesc& camera, const app::RenderSettings& settings) override {
        settings_ = settings;
        params_ = app::makeRenderParams(*scene_, settings);
        camera_ = rt::scene::makeCamera(camera, settings.width, settings.height, scene_->origin);
        film_ = Film(app::filmDesc(settings));
        film_.reserveOpenBlocks(); // where the last block does not fill up
        tile_ = 0;
    }
    void restore(Film film) override { film_ = std::move(film); }
    void renderOnly(rt::image::TileList, std::uint32_t, std::span<const std::byte>) override {
        throw std::logic_error("this engine renders whole pictures");
    }

    // At most 16 samples of a tile's pixels at a time, tiles in turn: so the time is looked at often.
    app::RenderStatus renderSome(const app::Budget& budget) override {
        const auto deadline = std::chrono::steady_clock::now() + budget.time;
        const std::uint64_t total = std::uint64_t{settings_.spp} * settings_.width * settings_.height;
        for (; film_.totalSamples() < total; tile_ = (tile_ + 1) % film_.tileCount()) {
            renderBlock(tile_);
            if (*budget.cancel || std::chrono::steady_clock::now() >= deadline) break;
        }
        return {film_.totalSamples() >= total, film_.totalSamples(), total};
    }

    const Film& film() override { return film_; }
    app::AovImages renderAovs(const app::AovRequest& request, std::uint32_t) override {
        return app::makeAovImages(request, settings_.width, settings_.height);
    }
    app::EngineReport report() const override { return {}; }

  private:
    // Goes on with the block that the film has begun there, up to 16 samples or the last one.
    void renderBlock(std::uint32_t tile) {
        Film::TileBlock block;
        film_.begin(tile, 0, block);
        const std::uint32_t first = block.firstSample + block.count;
        const std::uint32_t end = std::min(block.firstSample + Film::kBlock, settings_.spp);
        const std::uint32_t x0 = tile % film_.tilesX() * Film::kTile, y0 = tile / film_.tilesX() * Film::kTile;
        for (std::uint32_t i = 0; i < Film::kTilePixels; ++i) {
            const uvec2 pixel(x0 + i % Film::kTile, y0 + i / Film::kTile);
            for (std::uint32_t s = first; s < end; ++s) {
                const float value = visibility(pixel, s);
                for (std::uint32_t channel : {0, 1, 2}) block.sum[3 * i + channel] += value;
            }
        }
        block.count = end - block.firstSample; // the same again where the tile is done
        film_.commit(tile, 0, block);
    }

    // One sample: is the sky there in a direction drawn by the cosine? So its mean is the share of the hemisphere.
    float visibility(uvec2 pixel, std::uint32_t index) const {
        const Sampler sampler = makeSampler(params_, pixel.y * settings_.width + pixel.x, 0, index);
        const uvec2 size(settings_.width, settings_.height);
        const Features features = scene_->features;
        const Ray ray = generateCameraRay(features, camera_, pixel, size, sample2D(sampler, 0), vec2(0.5f), 0.0f);
        const Hit hit = tracer_.closest(tree_->view(), ray, kInfinity);
        if (hit.t < 0) return 1;
        const Surface surface = makeSurface(features, view_, ray, hit);
        const vec3 n = dot(surface.normal, ray.direction) < 0 ? surface.normal : -surface.normal;
        const vec3 up = toWorld(makeFrame(n), sampleCosineHemisphere(sample2D(sampler, 1)));
        const Ray shadow{offsetOrigin(surface.position, surface.error, n, up), up, 0.0f};
        return tracer_.occluded(tree_->view(), shadow, kInfinity) ? 0.0f : 1.0f;
    }

    std::shared_ptr<const rt::scene::CompiledScene> scene_;
    std::unique_ptr<rt::accel::CpuAccel> tree_;
    SceneView view_; // of its arrays, as formulas read them
    rt::accel::Tracer tracer_;
    app::RenderSettings settings_;
    RenderParams params_{};
    Camera camera_{};
    Film film_;
    std::uint32_t tile_ = 0; // the next one
};
} // namespace

int main() {
    rt::scene::SceneDesc scene;
    scene.camera = rt::scene::camera({4, 9, 0}, {4, 0, 0}, 30); // straight down at the floor beside the ball
    scene.camera.up = {0, 0, 1};
    scene.materials["white"] = rt::scene::lambertian(1, 1, 1);
    rt::scene::addQuad(scene, {-1000, 0, 1000}, {2000, 0, 0}, {0, 0, -2000}, "white");
    rt::scene::addSphere(scene, {0, 1, 0}, 1, "white");

    AmbientOcclusion engine;
    engine.setScene(rt::scene::compileScene(scene), nullptr);
    app::RenderSettings settings;
    settings.width = settings.height = 64;
    settings.spp = 256;
    app::FilmRun(engine, scene.camera, settings).untilStopped(false);

    const rt::image::Image picture = engine.film().resolve();
    const double side = 9 * std::tan(15 * 3.14159265 / 180); // half of what is seen, on the floor
    double worst = 0;
    for (std::uint32_t x = 0; x < settings.width; ++x) {
        const double d = 4 - side * (2 * (x + 0.5) / settings.width - 1); // the middle rows; -x is to the right
        const double expected = 1 - std::pow(1 + d * d, -1.5);
        const double found = 0.5 * (picture.pixel(x, 31)[0] + picture.pixel(x, 32)[0]);
        worst = std::max(worst, std::abs(found - expected));
        if (x % 16 == 8) std::printf("distance %.2f: %.4f of the sky, %.4f by the formula\n", d, found, expected);
    }
    std::printf("largest difference: %.4f\n", worst);
}
