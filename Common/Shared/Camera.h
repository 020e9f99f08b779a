// Rays of the camera. The record is made from a CameraDesc by rt::scene::makeCamera.
#ifndef RT_SHARED_CAMERA_H
#define RT_SHARED_CAMERA_H
#include "Common/Shared/Base/Features.h"
#include "Common/Shared/Base/Sampling.h"

RT_SHARED_BEGIN

// The ray through `uPixel` of a pixel (box filter; pixel (0,0) is the upper left one), from the point of the lens that
// `uLens` selects. `time` in [0,1). What `features` lack is not evaluated.
RT_FN Ray generateCameraRay(Features features, RT_IN(Camera) camera, uvec2 pixel, uvec2 size, vec2 uPixel, vec2 uLens,
                            float time) {
    vec2 image = (vec2(pixel) + uPixel) / vec2(size);
    vec3 target = camera.corner + camera.across * image.x + camera.down * image.y;
    Ray ray;
    ray.origin = camera.origin;
    if (has(features, kFeatureThinLens)) {
        vec2 disk = sampleDisk(uLens);
        vec3 lens = camera.lensU * disk.x + camera.lensV * disk.y;
        ray.origin = ray.origin + lens;
        target = target - lens;
    }
    ray.direction = normalize(target);
    ray.time = has(features, kFeatureMovingSpheres) ? time : 0.0f;
    return ray;
}

RT_SHARED_END

#endif
