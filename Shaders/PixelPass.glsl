// How shaders of one invocation a pixel begin, which go through the pixel's first samples. The includer provides
// traceRay().
#include "SceneAccess.glsl"
#include "Common/Shared/Path/PathStep.h"

layout(push_constant, scalar) uniform Launch { PixelLaunch launch; };

struct PixelSamples {
    uvec2 pixel;
    Sampler smp; // of the next sample
};

// False: there is no pixel for this invocation. `replicate`: whose samples these are.
bool beginPixel(uint invocation, uint replicate, RenderParams params, out PixelSamples samples) {
    uint index = launch.firstPixel + invocation;
    samples.pixel = uvec2(index % params.width, index / params.width);
    samples.smp = makeSampler(params, index, replicate, 0u);
    return invocation < launch.pixels;
}
