// The acceleration structure of the CPU engine: everything between a flat scene's arrays and AccelView.
#pragma once
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "Common/Accel/AccelView.h"
#include "Common/Accel/Build/BvhBuilder.h"

namespace rt::accel {

// The geometry of a flat scene, as in scene::CompiledScene; read during the build only.
struct AccelInput {
    std::span<const shared::Sphere> spheres;
    std::span<const shared::vec3> motions; // displacement of each sphere over the shutter; empty: nothing moves
    std::span<const shared::Quad> quads;
    std::span<const shared::vec3> positions;
    std::span<const shared::uvec3> triangles;
    std::span<const shared::Geometry> geometries; // [0] is the world's own
    std::span<const shared::Instance> instances;
};

struct BuildSettings {
    BvhSettings tree;
    // A world without instances and with at most this many primitives has no tree: every ray tests them all.
    std::uint32_t flatPrimitives = 64;
};

struct AccelStorage;

class CpuAccel {
  public:
    // Null when *cancel became true. Throws RenderError when there are more primitives than references can name.
    // *primitivesDone, if given, rises to the number of primitives and instances, counting
    // those of shared geometries once.
    static std::unique_ptr<CpuAccel> build(const AccelInput& input, const BuildSettings& settings,
                                           const std::atomic<bool>* cancel = nullptr,
                                           std::atomic<std::uint64_t>* primitivesDone = nullptr);
    ~CpuAccel();

    const AccelView& view() const { return view_; } // points into this object
    std::size_t bytes() const;                      // of memory held

  private:
    CpuAccel();

    std::unique_ptr<AccelStorage> storage_;
    AccelView view_;
};

} // namespace rt::accel
