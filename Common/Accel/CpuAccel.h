// The acceleration structure of the CPU engine: everything between a compiled scene's arrays and AccelView.
#pragma once
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>

#include "Common/Accel/AccelInput.h"
#include "Common/Accel/AccelView.h"
#include "Common/Accel/Build/BvhBuilder.h"

namespace rt::accel {

struct BuildSettings {
    BvhSettings tree;
    // A world without instances and with at most this many primitives has no tree: every ray tests them all.
    std::uint32_t maxLinear = 64;
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

    // Becomes that of another version of the scene it was built of, where only places and forms differ: trees stay, and
    // boxes change. False: it is as it was, and must be built anew; so it is also where trees are small, or would no
    // longer be good as too much has moved.
    bool follow(const AccelInput& before, const AccelInput& now, std::uint32_t threads);

    const AccelView& view() const { return view_; } // points into this object
    std::size_t bytes() const;                      // of memory held

  private:
    CpuAccel();

    std::unique_ptr<AccelStorage> storage_;
    AccelView view_;
    std::optional<double> builtArea_; // of the tree's boxes, once they were to change
    double area_ = 0;                 // by now
};

} // namespace rt::accel
