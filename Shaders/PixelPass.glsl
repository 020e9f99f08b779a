// How shaders begin that go through the first samples of pixels. The includer provides traceRay().
#include "SceneAccess.glsl"
#include "Common/Shared/Path/PathStep.h"

layout(push_constant, scalar) uniform Launch { PixelLaunch launch; };

// The first pixel of an invocation's run; `invocation` may be beyond the last run.
uvec2 firstPixelOf(uint invocation, uint pixelsOfRun, RenderParams params) {
    return firstPixelOfRun(launch.firstRun + invocation, params.width, pixelsOfRun);
}

// Which of the launch's pixels this one is.
uint placeInLaunch(uvec2 pixel, uint pixelsOfRun, RenderParams params) {
    uvec2 first = firstPixelOf(0u, pixelsOfRun, params);
    return (pixel.y - first.y) * params.width + pixel.x - first.x;
}

// Before the first sample. `replicate`: whose samples these are.
Sampler samplerOf(uvec2 pixel, uint replicate, uint firstSample, RenderParams params) {
    return makeSampler(params, pixel.y * params.width + pixel.x, replicate, firstSample);
}
