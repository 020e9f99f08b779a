// What drives a renderer: no window, no file, no flag. The CPU engine and the GPU engine implement it, Session uses it.
#pragma once
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "Common/Image/Denoise/Denoiser.h"
#include "Common/Image/Film.h"
#include "Common/Image/FilmTiles.h"
#include "Common/Render/Settings.h"
#include "Common/Scene/CompiledScene.h"

namespace rt::app {

// Bounds one call of Engine::renderSome. Work in flight when `cancel` becomes true is abandoned within 100 ms; what had
// been committed to the film stays.
struct Budget {
    std::chrono::duration<double> time{0.2};
    const std::atomic<bool>* cancel = nullptr;
    bool isWatched = false; // every pixel is to have a few samples soon, though that takes longer in all
};

struct RenderStatus {
    bool finished = false;         // every pixel has all its samples
    std::uint64_t samplesDone = 0; // over all pixels that are to be rendered
    std::uint64_t samplesTotal = 0;
};

struct RayCounts {
    std::uint64_t camera = 0; // of paths
    std::uint64_t scattered = 0;
    std::uint64_t shadow = 0;
    std::uint64_t edge = 0;  // from the camera too, at edges of lights
    std::uint64_t reuse = 0; // between vertices of neighbours' paths

    std::uint64_t all() const { return camera + scattered + shadow + edge + reuse; }
    friend RayCounts operator-(const RayCounts& a, const RayCounts& b) {
        return {a.camera - b.camera, a.scattered - b.scattered, a.shadow - b.shadow, a.edge - b.edge,
                a.reuse - b.reuse};
    }
    RayCounts& operator+=(const RayCounts& other) {
        camera += other.camera;
        scattered += other.scattered;
        shadow += other.shadow;
        edge += other.edge;
        reuse += other.reuse;
        return *this;
    }
};

// Of one of several processes that render together, see Common/App/Ranks.
struct RankFigures {
    std::string device;
    std::uint32_t threads = 0; // CPU only
    std::uint64_t samples = 0; // of pixels inside of the image
    double busySeconds = 0;    // with its tiles
    double busyShare = 0;      // of the time of sampling
    std::uint64_t bytes = 0;   // exchanged with rank 0
};

// What a device's driver tells of a shader that it compiled: its registers, and the like, each in words of the driver.
struct ShaderFigure {
    std::string shader;
    std::string name;
    double value = 0;
};

// How fast an engine was when `auto` chose among several.
struct EngineRate {
    std::string engine;
    double raysPerSecond = 0;
};

// What motion blur has come from, see ShutterEngine.h.
struct ShutterFigures {
    double open = 0, close = 0; // seconds of the animation
    std::uint32_t poses = 0;    // of the scene that samples were taken of, since the engine was made
    double poseSeconds = 0;     // that posing it has taken
};

struct EngineReport {
    std::string engine;        // "multi", "single", "pipeline", "compute", "query"
    std::string device;        // processor or Vulkan device
    std::string kernel;        // which specialisation runs, e.g. "surfaces+lights/x86-64-v4"
    bool isSoftware = false;   // a Vulkan device whose work the processor does
    std::uint32_t threads = 0; // CPU only
    shared::Features features; // in force, after any forced superset
    double accelBuildSeconds = 0;
    double pipelineSeconds = 0;
    double renderDeviceSeconds = 0;    // time in kernels: GPU timestamps, or wall time inside CPU workers
    double longestDispatchSeconds = 0; // of a GPU for what it gets at a time, since it was opened: draws wait for that
    RayCounts rays;
    std::uint64_t nonfiniteSamples = 0;
    double cutOff = 0;              // throughput that max depth cut off: the sum over all samples, which begin with 1
    std::uint64_t deviceBytes = 0;  // acceleration structure, scene and film held by the engine
    std::vector<RankFigures> ranks; // empty for one process
    std::string lightSampling;      // what `auto` came to, e.g. "sphere: cone, quad: solid-angle"
    std::vector<EngineRate> rates;  // by which the engine was chosen; empty: it was named, or there was no choice
    bool ratesAreOfBefore = false;  // another run has measured them
    std::vector<ShaderFigure> shaders;     // of the kernel; empty unless asked for
    std::optional<ShutterFigures> shutter; // none: the picture is of one instant

    // By how much max depth has darkened the picture where light comes from everywhere.
    double cutOffShare() const { return rays.camera > 0 ? cutOff / static_cast<double>(rays.camera) : 0; }
};

// Features of surfaces averaged over some samples of each pixel; empty unless asked for.
struct SurfaceRequest {
    bool albedo = false;
    bool normal = false; // world space, shading normal facing the camera
    bool depth = false;  // distance along the path, of the samples that hit something; 0 where none did
    bool any() const { return albedo || normal || depth; }
};
struct AovRequest : SurfaceRequest {      // of the first surface that is hit
    std::uint32_t firstRow = 0, rows = 0; // that the images are to have, and no others; 0: all
    SurfaceRequest wide{};                // of the first that scatters widely, through mirrors and clear glass
    bool emission = false;                // radiance of lights and sky in sight, in mirrors and glass too
    bool isAdaptive = false; // few samples where these see the same first surface, as the denoiser wants it
    bool looksThrough() const { return wide.any() || emission; }
    bool any() const { return SurfaceRequest::any() || looksThrough(); }
};
inline constexpr std::uint32_t kAovSamples = 16; // of each pixel in files, or fewer when the render has fewer
struct SurfaceImages {
    image::Image albedo, normal, depth;
};
struct AovImages : SurfaceImages {
    SurfaceImages wide; // the albedo is times the throughput of mirrors and glass
    image::Image emission;
};
// All that is asked for, black, of an image of this size.
AovImages makeAovImages(const AovRequest& request, std::uint32_t width, std::uint32_t height);

// The film as a picture.
struct Snapshot {
    image::Image radiance;                  // linear; the mean of each pixel's samples, 0 where it has none
    std::vector<std::uint64_t> tileSamples; // of a pixel, tile by tile as Film::samples()
    std::uint64_t minSamples() const {
        return tileSamples.empty() ? 0 : *std::min_element(tileSamples.begin(), tileSamples.end());
    }
};

// The scene as rasterisation draws it at once: lit without shadows, one ray a pixel.
struct Preview {
    image::Image picture; // linear radiance
    image::Image depth;   // as AovImages'
};

enum class Cost {
    Rays, // but for those by which pixels share paths
    Time, // by the processor's clock, in seconds, or by that of the device's shaders, in its ticks
};

// Packs tiles (FilmTiles.h). May be called once, by any thread and while the engine goes on with other work, but not
// when that has been destroyed.
using TilesToPack = std::function<std::vector<std::byte>()>;

class PictureDenoiser;
struct DenoisedPicture;

// Not thread-safe: one thread drives an engine. Order of calls: setScene, reset, renderSome until finished.
struct Engine {
    virtual ~Engine() = default;
    // Builds acceleration structures, or changes those of the previous scene where little is new: the engine keeps the
    // scene to compare it with the next one. A failure (rt::Error) leaves the previous scene in place. Returns false,
    // with the previous scene in place, when cancelled.
    virtual bool setScene(std::shared_ptr<const scene::CompiledScene> scene, const std::atomic<bool>* cancel) = 0;
    // Starts a new film.
    virtual void reset(const scene::CameraDesc& camera, const RenderSettings& settings) = 0;
    // As reset(), for an engine that gets its tiles by renderOnly(), packed, before anything is asked of its film: of
    // that it need keep those of the last call only.
    virtual void resetForLeases(const scene::CameraDesc& camera, const RenderSettings& settings) {
        reset(camera, settings);
    }
    // After reset: goes on from this film, whose desc() must be that of the new one.
    virtual void restore(image::Film film) = 0;
    // After reset and restore: from now on only these tiles, and of them `spp` samples per pixel, at most those of the
    // settings; none of the bits depends on it. The film first takes over what `packed` holds (FilmTiles.h), plans
    // included: an adaptive film makes none of its own any more, and `spp` is at most its pilot's samples, or with a
    // plan what it gives any pixel.
    virtual void renderOnly(image::TileList tiles, std::uint32_t spp, std::span<const std::byte> packed = {}) = 0;
    virtual RenderStatus renderSome(const Budget& budget) = 0;
    // The film on the host, up to date; the reference stays valid until the next reset. When it cannot be brought up to
    // date that is a RenderError, once: later calls return it as it was.
    virtual const image::Film& film() = 0;
    // After renderOnly: its tiles as far as they got. Whoever takes them need not find them on film() any more.
    virtual TilesToPack takeTiles(const image::TileList& tiles);
    // film() resolved, but for rounding; it may cost far less than the film on the host.
    virtual Snapshot snapshot();
    // Averages over the first `samples` samples of each pixel, at most where the request is adaptive.
    virtual AovImages renderAovs(const AovRequest& request, std::uint32_t samples) = 0;
    // What each pixel costs, averaged over the first `samples` samples; one channel. The film stays as it is. An engine
    // that does not know the cost returns an image without pixels.
    virtual bool knowsCost(Cost cost) const {
        (void)cost;
        return false;
    }
    virtual image::Image renderCost(Cost cost, std::uint32_t samples) {
        (void)cost, (void)samples;
        return {};
    }
    // Needs a scene but no film, and leaves that as it is. An engine that cannot draw returns images without pixels.
    virtual bool canPreview() const { return false; }
    virtual Preview renderPreview(const scene::CameraDesc& camera, std::uint32_t width, std::uint32_t height) {
        (void)camera, (void)width, (void)height;
        return {};
    }
    // After reset: for the film that it has begun, see there.
    virtual std::unique_ptr<PictureDenoiser> makeDenoiser();
    // After reset: filters halves of a picture as image::denoise() does; on the engine's device, if it can. `details`
    // as of a DenoiseRequest; `threads` are those of the processor, 0: as many as it has.
    virtual DenoisedPicture denoiseHalves(const image::DenoiseInput& halves, bool details, std::uint32_t threads);
    // The same for halves of the whole picture by first-hit features of kAovSamples, made once, that stay on the
    // engine's device. None where there is no such device, or it failed.
    virtual std::optional<DenoisedPicture> denoiseWhole(const image::DenoiseInput& halves, bool details);
    virtual EngineReport report() const = 0;
    // What tells the motion of a picture from others, which may take as long as two poses of the scene; 0: it is of one
    // instant. Throws what posing throws.
    virtual std::uint64_t motionHash() { return 0; }
};

} // namespace rt::app
