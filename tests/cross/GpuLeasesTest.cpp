// The GPU engine as a rank: from leases of tiles come the bits of the whole image, and there is memory for the tiles of
// a lease alone.
#include <algorithm>
#include <cstdint>
#include <iterator>
#include <memory>
#include <numeric>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "Common/Image/FilmTiles.h"
#include "Common/Image/SamplePlan.h"
#include "Common/Render/ForwardingEngine.h"
#include "Common/Render/RenderParams.h"
#include "RayTracingGPU/GpuEngine.h"
#include "tests/cross/BoxRender.h"
#include "tests/cross/Device.h"
#include "tests/image/Harness.h"

namespace rt::test {
namespace {

using image::Film;
using image::TileList;

// 9 x 6 tiles, of which those at the right and lower edge are partly outside of the image.
app::RenderSettings leasedImage(std::uint32_t spp) {
    app::RenderSettings settings;
    settings.width = 70;
    settings.height = 41;
    settings.spp = spp;
    return settings;
}

class GpuLeases : public ::testing::TestWithParam<app::GpuEngineKind> {
  protected:
    static BoxRender render(const app::RenderSettings& settings) {
        return {settings, gpu::makeGpuEngine(device(), {.pipelineCache = false, .engine = GetParam()})};
    }
};
INSTANTIATE_TEST_SUITE_P(Engines, GpuLeases, kFirstEngine, engineName);
INSTANTIATE_TEST_SUITE_P(Nightly, GpuLeases, ::testing::Values(app::GpuEngineKind::Pipeline, app::GpuEngineKind::Query),
                         engineName);

// All tiles, in leases that grow and shrink; the tiles of one are not side by side.
std::vector<TileList> leasesOf(const Film& film) {
    std::vector<TileList> leases(4);
    const std::size_t turn[] = {1, 0, 1, 2, 1, 3, 1, 2, 1, 1};
    for (const std::uint32_t tile : image::allTiles(film)) leases[turn[tile % std::size(turn)]].push_back(tile);
    return leases;
}

// Takes all tiles of the film to `spp` samples per pixel.
void renderLeases(app::Engine& engine, std::uint32_t spp, Film& film) {
    for (const TileList& lease : leasesOf(film)) {
        engine.renderOnly(lease, spp, image::packTiles(film, lease));
        while (!engine.renderSome({}).finished) {
        }
        EXPECT_EQ(image::unpackTiles(engine.takeTiles(lease)(), film), lease);
    }
}

// To the last bit of every pixel inside of the image; what others hold counts for nothing.
void expectSameFilm(const Film& expected, const Film& actual) {
    const image::FilmDesc& desc = expected.desc();
    const std::uint32_t across = expected.tilesX();
    const auto isInside = [&](std::uint32_t tile, std::size_t pixel) {
        return tile % across * Film::kTile + pixel % Film::kTile < desc.width &&
               tile / across * Film::kTile + pixel / Film::kTile < desc.height;
    };
    std::size_t unlike = 0; // values
    for (std::uint32_t tile = 0; tile < expected.tileCount(); ++tile)
        for (std::uint32_t replicate = 0; replicate < desc.replicates; ++replicate) {
            const Film::TileState a = expected.state(tile, replicate), b = actual.state(tile, replicate);
            ASSERT_EQ(a.samples, b.samples) << tile;
            const auto compare = [&](const auto& some, const auto& others) {
                ASSERT_EQ(some.size(), others.size()) << tile;
                for (std::size_t i = 0; i < some.size(); ++i)
                    if (isInside(tile, i / 3) && some[i] != others[i]) ++unlike;
            };
            compare(a.sums, b.sums);
            compare(a.squares, b.squares);
            compare(a.open, b.open);
        }
    EXPECT_EQ(unlike, 0u);
}

// Also in two rounds, the first of which ends within a block.
TEST_P(GpuLeases, GiveTheBitsOfTheWholeImage) {
    if (lacks(GetParam())) return;
    for (const std::uint32_t replicates : {1u, 3u}) {
        app::RenderSettings settings = leasedImage(37);
        settings.replicates = replicates;
        settings.secondMoments = true;
        BoxRender whole = render(settings), rank = render(settings);
        rank.engine->resetForLeases(rank.scene->camera, settings);
        Film film(app::filmDesc(settings));
        renderLeases(*rank.engine, 20, film);
        EXPECT_EQ(film.minSamples(), 20u);
        renderLeases(*rank.engine, settings.spp, film);
        expectSameFilm(whole.finish(), film);
        EXPECT_EQ(rank.engine->report().rays.camera, whole.engine->report().rays.camera);
    }
}

// The pilot, and what the plan of all of it adds. How far a tile is beyond its plan's end, where none of its pixels gets
// samples, depends on the launches.
TEST_P(GpuLeases, GiveTheBitsOfTheWholeImageWithAdaptiveSamples) {
    if (lacks(GetParam())) return;
    app::RenderSettings settings = leasedImage(64);
    settings.replicates = 2;
    settings.adaptive = true;
    BoxRender whole = render(settings), rank = render(settings);
    rank.engine->resetForLeases(rank.scene->camera, settings);
    Film film(app::filmDesc(settings));
    const auto goal = [&] { return static_cast<std::uint32_t>(image::goalOf(film, settings.spp)); };
    renderLeases(*rank.engine, goal(), film);
    film.setPlan(image::makeSamplePlan(film, settings.spp, app::dependentSide(rank.engine->report().features)));
    renderLeases(*rank.engine, goal(), film);
    const Film& expected = whole.finish();
    EXPECT_TRUE(sameBits(expected.resolve().data, film.resolve().data));
    EXPECT_TRUE(sameBits(expected.sampleCounts().data, film.sampleCounts().data));
}

// An image after leases is as any other.
TEST_P(GpuLeases, AreForgottenByAReset) {
    if (lacks(GetParam())) return;
    const app::RenderSettings settings = leasedImage(5);
    BoxRender whole = render(settings), rank = render(settings);
    rank.engine->resetForLeases(rank.scene->camera, settings);
    rank.engine->renderOnly({3, 8}, 5);
    rank.engine->renderSome({});
    rank.engine->reset(rank.scene->camera, settings);
    expectSameFilm(whole.finish(), rank.finish());
}

class Forwarding final : public app::ForwardingEngine {
  public:
    explicit Forwarding(std::unique_ptr<app::Engine> engine) { engine_ = std::move(engine); }
};

TEST_P(GpuLeases, AreHandedOnToTheEngine) {
    if (lacks(GetParam())) return;
    const app::RenderSettings settings = leasedImage(5);
    BoxRender rank = render(settings);
    Forwarding outer(std::move(rank.engine));
    outer.resetForLeases(rank.scene->camera, settings);
    EXPECT_TRUE(outer.film().isPart());
}

// ---- memory --------------------------------------------------------------------------------------------------------

// Of so many tiles on the device: two floats for each channel of a sum, as many for squares, the samples of each
// replicate, and where the tile is.
std::uint64_t deviceFilmBytes(std::uint64_t tiles, const app::RenderSettings& settings) {
    const std::uint64_t sums = Film::kTilePixels * 3 * 2 * sizeof(float);
    const std::uint64_t slot = (settings.secondMoments ? 2 : 1) * sums + sizeof(std::uint32_t);
    return tiles * (settings.replicates * slot + sizeof(std::uint32_t));
}

constexpr std::uint64_t kAlignment = 3 * 4096; // of three buffers, at most

class LeasedMemory : public GpuLeases {
  protected:
    LeasedMemory() {
        settings_.secondMoments = true;
        settings_.replicates = 2;
    }
    std::uint64_t deviceBytes() const { return render_->engine->report().deviceBytes; }
    // Since it had `before`.
    void expectFilmOf(std::uint64_t tiles, std::uint64_t before) const {
        const std::uint64_t expected = deviceFilmBytes(tiles, settings_);
        EXPECT_GE(deviceBytes(), before + expected) << tiles;
        EXPECT_LE(deviceBytes(), before + expected + kAlignment) << tiles;
    }

    app::RenderSettings settings_ = leasedImage(5);
    std::unique_ptr<BoxRender> render_;
};
INSTANTIATE_TEST_SUITE_P(Engines, LeasedMemory,
                         ::testing::Values(app::GpuEngineKind::Pipeline, app::GpuEngineKind::Compute,
                                           app::GpuEngineKind::Query),
                         engineName);

// Of the largest that there was so far, on the device and on the host.
TEST_P(LeasedMemory, IsThatOfALeaseAlone) {
    if (lacks(GetParam())) return;
    render_ = std::make_unique<BoxRender>(render(settings_));
    const std::uint64_t whole = deviceBytes();
    app::Engine& engine = *render_->engine;
    engine.resetForLeases(render_->scene->camera, settings_);
    const std::uint64_t none = deviceBytes();
    const image::FilmDesc desc = app::filmDesc(settings_);
    const std::uint32_t allTiles = Film(desc).tileCount();
    EXPECT_GE(whole, none + deviceFilmBytes(allTiles, settings_));
    Film held = Film::part(desc);
    EXPECT_EQ(engine.film().bytes(), held.bytes());
    std::size_t largest = 0;
    for (const std::size_t count : {2u, 6u, 4u, 1u}) {
        TileList lease(count);
        std::iota(lease.begin(), lease.end(), 11u);
        engine.renderOnly(lease, settings_.spp);
        largest = std::max(largest, count);
        expectFilmOf(largest, none);
        held.hold(lease);
        EXPECT_EQ(engine.film().bytes(), held.bytes());
    }
    EXPECT_LT(engine.film().bytes(), Film(desc).bytes() / 5);
    engine.reset(render_->scene->camera, settings_);
    EXPECT_EQ(deviceBytes(), whole);
}

// A share of the image without ranks, whose film on the host is that of the whole image, for the checkpoint.
TEST_P(LeasedMemory, OfAShareIsItsOwnOnTheDevice) {
    if (lacks(GetParam())) return;
    render_ = std::make_unique<BoxRender>(render(settings_));
    app::Engine& engine = *render_->engine;
    const std::uint64_t none = deviceBytes() - deviceFilmBytes(engine.film().tileCount(), settings_);
    engine.renderOnly({1, 5, 30}, settings_.spp);
    EXPECT_LE(deviceBytes(), none + deviceFilmBytes(3, settings_) + kAlignment);
}

} // namespace
} // namespace rt::test
