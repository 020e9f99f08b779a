// What the engine hands to a kernel. Only plain data crosses, because kernels are compiled for other instruction sets.
#pragma once
#include <atomic>
#include <cstdint>

#include "Common/Accel/Traverse/RayQuery.h"
#include "Common/Shared/Base/SceneAccess.h"
#include "Common/Shared/Base/Types.h"

namespace rt::cpu {

// Arrays of LightBound's fields, so that the weights of all lights are computed side by side; entries past the last light
// have no intensity.
struct LightBoundsSoa {
    float centerX[shared::kContributionLights] = {};
    float centerY[shared::kContributionLights] = {};
    float centerZ[shared::kContributionLights] = {};
    float radius[shared::kContributionLights] = {};
    float axisX[shared::kContributionLights] = {};
    float axisY[shared::kContributionLights] = {};
    float axisZ[shared::kContributionLights] = {};
    float twoSided[shared::kContributionLights] = {};
    float intensity[shared::kContributionLights] = {};
};

RT_FN void setBound(LightBoundsSoa& bounds, std::size_t i, const shared::LightBound& bound) {
    bounds.centerX[i] = bound.center.x;
    bounds.centerY[i] = bound.center.y;
    bounds.centerZ[i] = bound.center.z;
    bounds.radius[i] = bound.radius;
    bounds.axisX[i] = bound.axis.x;
    bounds.axisY[i] = bound.axis.y;
    bounds.axisZ[i] = bound.axis.z;
    bounds.twoSided[i] = bound.twoSided;
    bounds.intensity[i] = bound.intensity;
}

// The scene and its acceleration structure. Owned by the engine.
struct CpuScene : shared::SceneView {
    accel::AccelView accel;
    accel::Tracer tracer;                           // for the primitives in `accel`
    const LightBoundsSoa* lightBoundsSoa = nullptr; // of a table that is chosen from light by light
};

struct KernelCounters {
    std::uint64_t camera = 0;
    std::uint64_t scattered = 0;
    std::uint64_t shadow = 0;
    std::uint64_t nonfinite = 0;
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
    float* sum = nullptr; // RGB a pixel: continued, not cleared
    const std::atomic<bool>* cancel = nullptr;
};

// First-hit features of one row, averaged over samples 0 .. count - 1; null planes are not computed.
struct AovTask {
    std::uint32_t y = 0;
    std::uint32_t count = 0;
    float* albedo = nullptr; // RGB a pixel of the row
    float* normal = nullptr;
    float* depth = nullptr; // one a pixel
};

struct KernelContext {
    const CpuScene* scene = nullptr;
    shared::RenderParams params{};
    shared::Camera camera{};
};

// One specialisation. A kernel renders every scene whose features it covers.
struct Kernel {
    std::uint32_t features;
    const char* name;
    // False: cancelled, the task's sums are not usable.
    bool (*renderTile)(const KernelContext&, const TileTask&, KernelCounters&);
    void (*renderAovs)(const KernelContext&, const AovTask&);
};

inline constexpr std::uint32_t kKernelCount = 5;

// The table of each instruction set; only those of the architecture at hand exist.
const Kernel* kernels_x86_64_v2();
const Kernel* kernels_x86_64_v3();
const Kernel* kernels_x86_64_v4();
const Kernel* kernels_generic();

} // namespace rt::cpu
