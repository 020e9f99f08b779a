// What a ray that leaves the scene meets, and its importance sampling when it is an image.
#ifndef RT_SHARED_SKY_H
#define RT_SHARED_SKY_H
#include "Common/Shared/Base/Features.h"
#include "Common/Shared/Base/Random.h"
#include "Common/Shared/Light/Lights.h"
#include "Common/Shared/Texture/Textures.h"

RT_SHARED_BEGIN

// Latitude-longitude coordinates of a unit direction as seen from inside: u to the right, from -x by way of -z,
// with +x in the middle; v = 0 at the zenith. On a sphere's outside u runs the other way.
RT_FN vec2 skyUv(vec3 direction) {
    return vec2(1.0f, 1.0f) - sphereUv(direction);
}

// A direction of the world in the frame of the sky image, which is turned about +y, and back.
RT_FN vec3 toSkyImage(RT_IN(SceneGlobals) globals, vec3 d) {
    vec2 turn = globals.skyTurn;
    return vec3(turn.x * d.x - turn.y * d.z, d.y, turn.x * d.z + turn.y * d.x);
}
RT_FN vec3 fromSkyImage(RT_IN(SceneGlobals) globals, vec3 d) {
    vec2 turn = globals.skyTurn;
    return vec3(turn.x * d.x + turn.y * d.z, d.y, turn.x * d.z - turn.y * d.x);
}

// The texel that holds uv: sky images are piecewise constant, so that their distribution function is exact.
RT_FN uvec2 skyTexel(RT_IN(Image) image, vec2 uv) {
    return uvec2(min(uint(uv.x * float(image.width)), image.width - 1u),
                 min(uint(uv.y * float(image.height)), image.height - 1u));
}

RT_FN vec3 skyRadiance(Features features, SceneRef scene, vec3 direction) {
    RT_IN(SceneGlobals) globals = loadGlobals(scene);
    if (globals.skyKind == kSkyBlack) return vec3(0.0f, 0.0f, 0.0f);
    if (globals.skyKind == kSkyGradient) return mix(globals.skyBottom, globals.skyTop, 0.5f * (direction.y + 1.0f));
    if (has(features, kFeatureSkyImage) && globals.skyKind == kSkyImage) {
        RT_IN(Image) image = loadImage(scene, globals.skyImage);
        uvec2 texel = skyTexel(image, skyUv(toSkyImage(globals, direction)));
        return globals.skyTop * vec3(loadTexel(scene, image, texel.x, texel.y));
    }
    return globals.skyTop;
}

// Largest i in [0, n) with cdf(first + i) <= u: the cell that u falls into, never one of zero mass.
RT_FN uint skyCell(SceneRef scene, uint first, uint n, float u) {
    uint low = 0u;
    uint high = n;
    while (low + 1u < high) {
        uint middle = (low + high) / 2u;
        if (loadSkyCdf(scene, first + middle) <= u) {
            low = middle;
        } else {
            high = middle;
        }
    }
    return low;
}

// Element of skyCdf where the distribution over columns of this row begins.
RT_FN uint skyColumns(RT_IN(Image) image, uint row) {
    return image.height + 1u + row * (image.width + 1u);
}

// Density over solid angle of sampleSky inside a texel, which covers 2 pi / width * (difference of cosines).
RT_FN float skyTexelPdf(SceneRef scene, RT_IN(Image) image, uvec2 texel) {
    uint columns = skyColumns(image, texel.y) + texel.x;
    float mass = (loadSkyCdf(scene, texel.y + 1u) - loadSkyCdf(scene, texel.y)) *
                 (loadSkyCdf(scene, columns + 1u) - loadSkyCdf(scene, columns));
    float top = sinCos2Pi(0.5f * float(texel.y) / float(image.height)).y;
    float bottom = sinCos2Pi(0.5f * float(texel.y + 1u) / float(image.height)).y;
    return mass * float(image.width) / (2.0f * kPi * (top - bottom));
}

RT_FN float skyPdf(SceneRef scene, vec3 direction) {
    RT_IN(SceneGlobals) globals = loadGlobals(scene);
    RT_IN(Image) image = loadImage(scene, globals.skyImage);
    return skyTexelPdf(scene, image, skyTexel(image, skyUv(toSkyImage(globals, direction))));
}

// A direction inside the texel that u falls into, uniform in solid angle, with the density of sampleSky.
RT_FN LightSample sampleSkyTexel(SceneRef scene, uvec2 texel, vec2 u) {
    RT_IN(SceneGlobals) globals = loadGlobals(scene);
    RT_IN(Image) image = loadImage(scene, globals.skyImage);
    uint row = texel.y;
    uint column = texel.x;
    uint columns = skyColumns(image, row);
    float inRow = remapSample(u.y, loadSkyCdf(scene, row), loadSkyCdf(scene, row + 1u));
    float inColumn = remapSample(u.x, loadSkyCdf(scene, columns + column), loadSkyCdf(scene, columns + column + 1u));
    float top = sinCos2Pi(0.5f * float(row) / float(image.height)).y;
    float bottom = sinCos2Pi(0.5f * float(row + 1u) / float(image.height)).y;
    float y = mix(top, bottom, inRow);
    float r = sqrt(max(0.0f, (1.0f - y) * (1.0f + y)));
    // Inverse of skyUv: u = (atan2(z, x) + pi) / 2 pi.
    vec2 sinCos = sinCos2Pi((float(column) + inColumn) / float(image.width));
    LightSample s;
    s.wi = fromSkyImage(globals, vec3(-r * sinCos.y, y, -r * sinCos.x));
    s.distance = kInfinity;
    s.pdf = skyTexelPdf(scene, image, uvec2(column, row));
    s.radiance = globals.skyTop * vec3(loadTexel(scene, image, column, row));
    s.point = vec3(0.0f, 0.0f, 0.0f);
    s.error = vec3(0.0f, 0.0f, 0.0f);
    s.normal = -s.wi;
    s.uv = vec2(0.0f, 0.0f);
    return s;
}

// A direction with density proportional to the image, uniform in solid angle inside a texel.
RT_FN LightSample sampleSky(SceneRef scene, vec2 u) {
    RT_IN(Image) image = loadImage(scene, loadGlobals(scene).skyImage);
    uint row = skyCell(scene, 0u, image.height, u.y);
    uint columns = skyColumns(image, row);
    return sampleSkyTexel(scene, uvec2(skyCell(scene, columns, image.width, u.x), row), u);
}

RT_SHARED_END

#endif
