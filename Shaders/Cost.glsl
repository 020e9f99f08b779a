// Rays that a pixel costs, averaged over its first samples: camera, scattered and shadow. The includer provides traceRay().
#include "SceneAccess.glsl"
#include "Common/Shared/PathStep.h"

layout(push_constant, scalar) uniform Launch { AovLaunch launch; };

// What the invocation of one pixel of a launch does.
void writeCost(uint index) {
    if (index >= launch.pixels) return;
    SceneRef scene;
    scene.unused = 0u;
    RenderParams params = renderParams();
    uvec2 pixel = uvec2(index % params.width, launch.firstRow + index / params.width);
    Sampler smp = makeSampler(params, pixel.y * params.width + pixel.x, 0u, 0u);
    uint rays = 0u;
    for (; smp.index < launch.samples; smp.index++) {
        PathState path = startPath(kFeatures, params, constants.camera, smp, pixel, randomPair(smp, kPairPixel));
        bool goesOn = true;
        while (goesOn) {
            DirectLight direct = noDirectLight();
            Hit hit = traceRay(path.ray, false, kInfinity);
            goesOn = pathVertex(kFeatures, scene, params, smp, vertexNumbers(smp, path.vertex), hit, path, direct);
            // Whether the light arrives makes no difference to how the path goes on.
            rays += direct.distance > 0.0f ? 2u : 1u;
        }
    }
    launch.values.at[index] = float(rays) / float(launch.samples);
}
