// --denoise from options to files.
#include <algorithm>
#include <csignal>
#include <cstdint>
#include <filesystem>
#include <iterator>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "Common/App/Session/DenoiseFilm.h"
#include "Common/Core/Error.h"
#include "Common/Image/Film.h"
#include "Common/Image/ImageIo.h"
#include "Common/Render/ForwardingEngine.h"
#include "Common/Render/PictureDenoiser.h"
#include "tests/FileBytes.h"
#include "tests/unit/SessionFixture.h"

namespace rt::app {
namespace {

using SessionDenoise = SessionFixture;
namespace fs = std::filesystem;

// The fake engine's samples are uniform in [0, 1], of variance 1/12.
double meanSquareFromHalf(const std::string& file) {
    const image::Image image = image::readImage(file);
    double sum = 0;
    for (const float value : image.data) sum += (value - 0.5) * (value - 0.5);
    return sum / static_cast<double>(image.data.size());
}

TEST_F(SessionDenoise, WritesBesideTheRawPicture) {
    run({"--spp", "16", "--replicates", "2", "-o", path("raw.pfm")});
    run({"--spp", "16", "--denoise", "--aov", "denoised-error", "-o", path("a.pfm"), "--stats", path("stats.json")});
    EXPECT_EQ(test::bytesOfFile(path("a.pfm")), test::bytesOfFile(path("raw.pfm")));
    EXPECT_LT(meanSquareFromHalf(path("a.denoised.pfm")), 0.25 * meanSquareFromHalf(path("a.pfm")));
    EXPECT_TRUE(fs::exists(path("a.denoised-error.pfm")));
    const nlohmann::json stats = statistics();
    const nlohmann::json& denoised = stats["denoised"];
    EXPECT_EQ(stats["settings"]["replicates"], 2);
    EXPECT_LT(denoised["estimated_relmse"].get<double>(), stats["estimated_relmse"].get<double>());
    EXPECT_GT(denoised["seconds"].get<double>(), 0.0);
    double shares = denoised["raw_share"];
    for (const nlohmann::json& row : denoised["bandwidths"]) shares += row["share"].get<double>();
    EXPECT_NEAR(shares, 1, 1e-6);
    EXPECT_FALSE(denoised.contains("device")); // the processor has filtered
}

// Stands in for one that filters on a device.
class EngineWithDevice final : public FakeEngine {
  public:
    DenoisedPicture denoiseHalves(const image::DenoiseInput& halves, bool details, std::uint32_t threads) override {
        DenoisedPicture result = FakeEngine::denoiseHalves(halves, details, threads);
        result.device = "a device";
        result.passes = {{"fit", 0.25}};
        return result;
    }
};

TEST_F(SessionDenoise, TellsWhichDeviceHasFiltered) {
    const Options asked = options({"--spp", "16", "--denoise", "-o", path("a.pfm"), "--stats", path("stats.json")});
    runSession(asked, [] { return std::make_unique<EngineWithDevice>(); });
    const nlohmann::json denoised = statistics()["denoised"];
    EXPECT_EQ(denoised["device"], "a device");
    EXPECT_EQ(denoised["device_seconds"]["fit"], 0.25);
}

// Of 20 x 12 pixels, of which those of the region (8, 0, 8, 8) are grey.
image::Film filmOfRegion(Options& asked, Engine& engine) {
    asked.settings.width = 20;
    asked.settings.height = 12;
    engine.reset({}, asked.settings);
    image::Film film({20, 12, 2});
    image::Film::TileBlock block;
    constexpr std::uint32_t kTileOfRegion = 1;
    for (std::uint32_t replicate = 0; replicate < 2; ++replicate) {
        film.begin(kTileOfRegion, replicate, block);
        block.count = image::Film::kBlock;
        std::fill(std::begin(block.sum), std::end(block.sum), 0.5f * image::Film::kBlock);
        film.commit(kTileOfRegion, replicate, block);
    }
    return film;
}

// Stands in for one whose features stay on a device.
class EngineWithFeatures final : public FakeEngine {
  public:
    EngineWithFeatures(int& hostFeatures, int& filtered) : hostFeatures_(hostFeatures), filtered_(filtered) {}

    AovImages renderAovs(const AovRequest& request, std::uint32_t samples) override {
        ++hostFeatures_;
        return FakeEngine::renderAovs(request, samples);
    }
    std::optional<DenoisedPicture> denoiseWhole(const image::DenoiseInput& halves, bool details) override {
        ++filtered_;
        EXPECT_TRUE(halves.albedo.data.empty() && halves.normal.data.empty() && halves.depth.data.empty());
        return FakeEngine::denoiseHalves(halves, details, 1);
    }

  private:
    int& hostFeatures_;
    int& filtered_;
};

class Forwarded final : public ForwardingEngine {
  public:
    explicit Forwarded(std::unique_ptr<Engine> engine) { engine_ = std::move(engine); }
};

TEST_F(SessionDenoise, LeavesFeaturesWhereTheEngineHasThem) {
    int hostFeatures = 0, filtered = 0;
    const auto make = [&] {
        return std::make_unique<Forwarded>(std::make_unique<EngineWithFeatures>(hostFeatures, filtered));
    };
    runSession(options({"--spp", "16", "--denoise", "-o", path("a.pfm")}), make);
    EXPECT_EQ(hostFeatures, 0);
    EXPECT_EQ(filtered, 1);
    run({"--spp", "16", "--denoise", "-o", path("b.pfm")});
    EXPECT_EQ(test::bytesOfFile(path("a.pfm")), test::bytesOfFile(path("b.pfm")));
    Options part = options({"--spp", "32", "--denoise", "--region", "8,0,8,8", "-o", path("a.pfm")});
    EngineWithFeatures engine(hostFeatures, filtered);
    FilmDenoiser(part, engine).denoise(filmOfRegion(part, engine));
    EXPECT_EQ(hostFeatures, 1); // of which a part is filtered
    EXPECT_EQ(filtered, 1);
}

TEST_F(SessionDenoise, OnlyReplacesTheRawPicture) {
    run({"--spp", "16", "--denoise", "-o", path("a.pfm"), "--seed", "3"});
    run({"--spp", "16", "--denoise", "only", "-o", path("b.pfm"), "--seed", "3"});
    EXPECT_EQ(test::bytesOfFile(path("b.pfm")), test::bytesOfFile(path("a.denoised.pfm")));
    EXPECT_FALSE(fs::exists(path("b.denoised.pfm")));
}

TEST_F(SessionDenoise, ARegionIsBlackAround) {
    Options asked = options({"--spp", "32", "--denoise", "--region", "8,0,8,8", "-o", path("a.pfm")});
    FakeEngine engine;
    const image::Film film = filmOfRegion(asked, engine);
    const image::Image image = FilmDenoiser(asked, engine).denoise(film).picture;
    for (std::uint32_t y = 0; y < image.height; ++y)
        for (std::uint32_t x = 0; x < image.width; ++x) {
            const bool inside = x >= 8 && x < 16 && y < 8;
            EXPECT_NEAR(image.pixel(x, y)[0], inside ? 0.5f : 0.0f, 1e-4f) << x << ", " << y;
        }
}

TEST_F(SessionDenoise, StopsWhenTheDenoisedPictureIsGoodEnough) {
    const auto sppFor = [this](std::vector<std::string> more) {
        std::vector<std::string> arguments = {"--spp", "100000",      "--target-error", "0.002",
                                              "-o",    path("a.pfm"), "--stats",        path("stats.json")};
        arguments.insert(arguments.end(), more.begin(), more.end());
        run(arguments);
        EXPECT_EQ(statistics()["stopped_by"], "target_error");
        return statistics()["spp_done"].get<int>();
    };
    const int raw = sppFor({}), denoised = sppFor({"--denoise"});
    EXPECT_LT(denoised, raw);
}

TEST_F(SessionDenoise, SaysWhatItCannotDo) {
    EXPECT_EQ(error<UsageError>({"--spp", "1", "--denoise", "-o", path("a.pfm")}),
              "--denoise: needs two halves of the samples: --spp 2 or more");
    EXPECT_NE(error<UsageError>({"--denoise", "much", "-o", path("a.pfm")}).find("nothing, on, off, only or oidn"),
              std::string::npos);
    EXPECT_EQ(error<UsageError>({"--spp", "8", "--denoise", "--tiles", "1/2", "-o", path("a.pfm")}),
              "--denoise: not with --tiles; ray-tracing-image denoise takes the checkpoint that they make");
    EXPECT_EQ(error<UsageError>({"--denoise", "--stats", path("stats.json")}), "--denoise: needs --output");
}

TEST_F(SessionDenoise, MakesAnEvenNumberOfReplicates) {
    EXPECT_EQ(options({"--denoise", "-o", path("a.pfm")}).settings.replicates, 2u);
    EXPECT_EQ(options({"--denoise", "--replicates", "3", "-o", path("a.pfm")}).settings.replicates, 4u);
    EXPECT_EQ(options({"-o", path("a.pfm")}).settings.replicates, 1u);
    const Options both = options({"--denoise", "--aov", "denoised", "-o", path("a.pfm")});
    EXPECT_EQ(both.aovs.size(), 1u);
}

TEST_F(SessionDenoise, GoesOnFromACheckpointToTheSameBits) {
    const std::vector<std::string> common = {"--denoise", "--aov", "denoised-error", "--spp", "60"};
    const auto with = [&common](std::vector<std::string> more) {
        more.insert(more.begin(), common.begin(), common.end());
        return more;
    };
    run(with({"-o", path("whole.pfm")}));
    const auto interruptAt31 = [](std::uint32_t spp) {
        if (spp == 31) std::raise(SIGINT);
    };
    run(with({"--checkpoint", path("c.rtc"), "-o", path("part.pfm")}), interruptAt31);
    EXPECT_NE(test::bytesOfFile(path("part.denoised.pfm")), test::bytesOfFile(path("whole.denoised.pfm")));
    run(with({"--resume", path("c.rtc"), "-o", path("part.pfm")}));
    for (const std::string layer : {"", ".denoised", ".denoised-error"})
        EXPECT_EQ(test::bytesOfFile(path("part" + layer + ".pfm")), test::bytesOfFile(path("whole" + layer + ".pfm")))
            << layer;
}

} // namespace
} // namespace rt::app
