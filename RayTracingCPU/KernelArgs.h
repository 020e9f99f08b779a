// What the engine hands to a kernel. Only plain data crosses, because kernels are compiled for other instruction sets.
#pragma once
#include <atomic>
#include <cstdint>
#include <span>

#include "Common/Accel/Traverse/RayQuery.h"
#include "Common/Shared/Base/SceneAccess.h"
#include "Common/Shared/Base/Types.h"

namespace rt::cpu {

// The scene and its acceleration structure. Owned by the engine.
struct CpuScene : shared::SceneView {
    accel::AccelView accel;
    accel::Tracer tracer; // for the primitives in `accel`
};

struct KernelCounters {
    std::uint64_t camera = 0;
    std::uint64_t scattered = 0;
    std::uint64_t shadow = 0;
    std::uint64_t edge = 0;
    std::uint64_t reuse = 0;
    std::uint64_t nonfinite = 0;
    double cutOff = 0; // as EngineReport::cutOff
};

// Samples first .. first + count - 1 of one replicate, for the pixels of one tile.
struct TileTask {
    std::uint32_t x = 0; // upper left pixel
    std::uint32_t y = 0;
    std::uint32_t width = 0; // pixels inside the image
    std::uint32_t height = 0;
    std::uint32_t stride = 0; // pixels from row to row in sum
    std::uint32_t replicate = 0;
    std::uint32_t first = 0;
    std::uint32_t count = 0;
    const std::uint32_t* plan = nullptr; // of each pixel, as sum: index at which its samples end before the others'
    float* sum = nullptr;                // RGB a pixel: continued, not cleared
    float* squares = nullptr;            // RGB of the samples' squares a pixel, continued; null: not wanted

    std::uint32_t samplesOf(std::uint32_t column, std::uint32_t row) const {
        if (plan == nullptr) return count;
        const std::uint32_t end = plan[row * stride + column];
        return end <= first ? 0 : end - first < count ? end - first : count;
    }
    std::uint32_t samples() const {
        if (plan == nullptr) return count * width * height;
        std::uint32_t total = 0;
        for (std::uint32_t row = 0; row < height; ++row)
            for (std::uint32_t column = 0; column < width; ++column) total += samplesOf(column, row);
        return total;
    }
};

inline constexpr std::uint32_t kBatchSamples = 1024; // of all tasks that a kernel is given at a time: a block of a tile

// Where a row's features of surfaces go; null planes are not wanted.
struct SurfacePlanes {
    float* albedo = nullptr; // RGB a pixel of the row
    float* normal = nullptr;
    float* depth = nullptr; // one a pixel
    bool isWanted() const { return albedo != nullptr || normal != nullptr || depth != nullptr; }
};

// Features of one row, averaged over samples 0 .. count - 1 of their own, or if adaptive over the first few where these
// agree: see Common/Shared/Path/SeenSurfaces.h.
struct AovTask {
    shared::Features features; // of the scene and the settings: without specialisations, a test is all that they cost
    std::uint32_t y = 0;
    std::uint32_t count = 0;
    bool isAdaptive = false;
    SurfacePlanes first, wide;
    float* emission = nullptr; // RGB a pixel; null: not wanted
};

struct KernelContext {
    const CpuScene* scene = nullptr;
    shared::RenderParams params{};
    shared::Camera camera{};
    const std::uint32_t* edges = nullptr; // of params.edgeRays, as scene::LightEdges::parts; null: there are none

    // 0: no edge.
    std::uint32_t edgePart(std::uint32_t pixel) const { return edges != nullptr ? edges[pixel] : 0u; }
};

// One specialisation. A kernel renders every scene whose features it covers.
struct Kernel {
    shared::Features features;
    const char* name;
    // At most kBatchSamples in all tasks. False: cancelled, the tasks' sums are not usable.
    bool (*renderTiles)(const KernelContext&, std::span<const TileTask>, const std::atomic<bool>* cancel,
                        KernelCounters&);
    void (*renderAovs)(const KernelContext&, const AovTask&);
};

inline constexpr std::uint32_t kKernelCount = 8;

// The table of each instruction set; only those of the architecture at hand exist.
const Kernel* kernels_x86_64_v2();
const Kernel* kernels_x86_64_v3();
const Kernel* kernels_x86_64_v4();
const Kernel* kernels_generic();

} // namespace rt::cpu
