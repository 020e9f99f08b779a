// What this machine's processor can do with rays alone, by a library made for nothing else.
#pragma once
#include <cstddef>
#include <memory>
#include <optional>

#include "Common/Scene/CompiledScene.h"

namespace rt::bench {

// A scene's geometry in Embree 3 (robust mode, single-ray calls), and rays through it: those of the camera and three
// cosine-distributed bounces of each, in the order of paths.
class EmbreeRays {
  public:
    // Nothing for scenes with instances or moving spheres, and where the program was built without Embree.
    static std::optional<EmbreeRays> make(const scene::CompiledScene& scene);
    EmbreeRays(EmbreeRays&&) noexcept;
    ~EmbreeRays();

    // Rays per second of one pass over all of them; threads: 0: all.
    double trace(std::size_t threads);

  private:
    struct Data;
    explicit EmbreeRays(std::unique_ptr<Data> data);
    std::unique_ptr<Data> data_;
};

// The median of some passes on all threads. Takes a second or two.
std::optional<double> embreeRaysPerSecond(const scene::CompiledScene& scene);

} // namespace rt::bench
