// The light that a ray finds, by the path tracer of the renderers.
#pragma once
#include "Common/Probe/SceneFormulas.h"
#include "Common/Shared/Base/Random.h"

namespace rt::probe {

class ArrivingLight {
  public:
    explicit ArrivingLight(const SceneFormulas& scene); // which must outlive it

    // An estimate from one path, which takes its numbers from the sampler. It has one vertex less than a path of the
    // render may have: the first one is where the ray begins.
    shared::vec3 trace(const shared::Ray& ray, const shared::Sampler& sampler) const;
    // What it hits first, whether opaque or not.
    shared::Hit closest(const shared::Ray& ray) const;

  private:
    const SceneFormulas* scene_;
    shared::RenderParams params_;
    shared::Features features_;
};

} // namespace rt::probe
