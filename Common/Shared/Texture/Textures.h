// Procedural and image textures.
#ifndef RT_SHARED_TEXTURES_H
#define RT_SHARED_TEXTURES_H
#include "Common/Shared/Base/Features.h"
#include "Common/Shared/Base/Sampling.h"
#include "Common/Shared/Base/SceneAccess.h"
#include "Common/Shared/Texture/Checker.h"

RT_SHARED_BEGIN

// ---- coordinates ---------------------------------------------------------------------------------------------------

// Texture coordinates of a sphere's outward unit normal: u around +y from -x, v from the south pole.
RT_FN vec2 sphereUv(vec3 n) {
    float u = (arcTan(-n.z, n.x) + kPi) * (0.5f * kInvPi);
    float v = arcTan(sqrt(n.x * n.x + n.z * n.z), -n.y) * kInvPi;
    return clamp(vec2(u, v), vec2(0.0f), vec2(1.0f));
}

// ---- Perlin noise --------------------------------------------------------------------------------------------------

// Contribution of the lattice point `cell` + `corner`, corner in {0,1}^3, to the noise at `cell` + `f`.
RT_FN float perlinCorner(SceneRef scene, uint table, ivec3 cell, vec3 f, vec3 smoothed, ivec3 corner) {
    uint base = table * (3u * kPerlinSize);
    uint x = loadPerlinPermutation(scene, base + uint((cell.x + corner.x) & 255));
    uint y = loadPerlinPermutation(scene, base + kPerlinSize + uint((cell.y + corner.y) & 255));
    uint z = loadPerlinPermutation(scene, base + 2u * kPerlinSize + uint((cell.z + corner.z) & 255));
    vec3 c = vec3(corner);
    vec3 weight = c * smoothed + (vec3(1.0f) - c) * (vec3(1.0f) - smoothed);
    return weight.x * weight.y * weight.z * dot(loadPerlinGradient(scene, table * kPerlinSize + (x ^ y ^ z)), f - c);
}

// Gradient noise in about [-1, 1], 0 at lattice points, of period 256.
RT_FN float perlinNoise(SceneRef scene, uint table, vec3 p) {
    vec3 whole = floor(p);
    vec3 f = p - whole;
    // Reduced while still a float: far coordinates would overflow an integer.
    ivec3 cell = ivec3(whole - floor(whole * (1.0f / 256.0f)) * 256.0f);
    vec3 smoothed = f * f * (3.0f - 2.0f * f);
    float sum = 0.0f;
    for (int i = 0; i < 8; ++i) {
        sum += perlinCorner(scene, table, cell, f, smoothed, ivec3(i & 1, i >> 1 & 1, i >> 2));
    }
    return sum;
}

const int kTurbulenceOctaves = 7;

RT_FN float perlinTurbulence(SceneRef scene, uint table, vec3 p) {
    float sum = 0.0f;
    float weight = 1.0f;
    for (int octave = 0; octave < kTurbulenceOctaves; ++octave) {
        sum += weight * perlinNoise(scene, table, p);
        weight *= 0.5f;
        p = p * 2.0f;
    }
    return abs(sum);
}

RT_FN bool isNoise(uint kind) {
    return kind >= kTextureMarble && kind <= kTextureNoise;
}

// Brightness of the noise kinds.
RT_FN float noiseValue(SceneRef scene, RT_IN(Texture) t, vec3 point) {
    vec3 p = point * t.scale;
    if (t.kind == kTextureNoise) return 0.5f * (1.0f + perlinNoise(scene, t.first, p));
    float turbulence = perlinTurbulence(scene, t.first, p);
    if (t.kind == kTextureTurbulence) return turbulence;
    float turns = (t.frequency * point.z + 10.0f * turbulence) * (0.5f * kInvPi);
    return 0.5f * (1.0f + sinCos2Pi(turns - floor(turns)).x);
}

// ---- images --------------------------------------------------------------------------------------------------------

// The four texels of a bilinear lookup and the weights of the second column and row. Texel centres lie at (i + 1/2) /
// size.
struct Footprint {
    uvec2 low;
    uvec2 high;
    vec2 weight;
};

// (texel before, texel after, weight of the latter) at p, in [0, size] along one side of an image.
RT_FN vec3 texelsAround(float p, float size, uint wrap) {
    float limit = size - 1.0f;
    float at = p - 0.5f;
    if (wrap == kWrapRepeat) {
        float low = floor(at);
        float after = low + 1.0f;
        return vec3(low < 0.0f ? limit : low, after > limit ? 0.0f : after, at - low);
    }
    at = clamp(at, 0.0f, limit);
    float low = min(floor(at), limit);
    return vec3(low, min(low + 1.0f, limit), at - low);
}

// A place in [0,1], taken there as wrapping says.
RT_FN float wrapped(float x, uint wrap) {
    if (wrap == kWrapClamp) return clamp(x, 0.0f, 1.0f);
    float turn = wrap == kWrapRepeat ? x - floor(x) : abs(x - 2.0f * floor(0.5f * x + 0.5f));
    return isFinite(turn) ? clamp(turn, 0.0f, 1.0f) : 0.0f;
}

// uv with v upwards from the last row of the image.
RT_FN Footprint imageFootprint(RT_IN(Texture) t, RT_IN(Image) image, vec2 uv) {
    float width = float(image.width);
    float height = float(image.height);
    vec3 place = vec3(uv.x, uv.y, 1.0f);
    vec3 across = texelsAround(wrapped(dot(t.uRow, place), t.wrapU) * width, width, t.wrapU);
    vec3 down = texelsAround((1.0f - wrapped(dot(t.vRow, place), t.wrapV)) * height, height, t.wrapV);
    Footprint f;
    f.low = uvec2(uint(across.x), uint(down.x));
    f.high = uvec2(uint(across.y), uint(down.y));
    f.weight = vec2(across.z, down.z);
    return f;
}

RT_FN vec4 imageColor(SceneRef scene, RT_IN(Texture) t, vec2 uv) {
    RT_IN(Image) image = loadImage(scene, t.first);
    Footprint f = imageFootprint(t, image, uv);
    vec4 upper = mix(loadTexel(scene, image, f.low.x, f.low.y), loadTexel(scene, image, f.high.x, f.low.y), f.weight.x);
    vec4 lower =
        mix(loadTexel(scene, image, f.low.x, f.high.y), loadTexel(scene, image, f.high.x, f.high.y), f.weight.x);
    return mix(upper, lower, f.weight.y);
}

// ---- any texture ---------------------------------------------------------------------------------------------------

// Colour and opacity. `point` in authored world coordinates (SceneGlobals::origin added back), `uv` and `uv2` the
// surface's texture coordinates.
RT_FN vec4 evalTexture(Features features, SceneRef scene, uint texture, vec3 point, vec2 uv, vec2 uv2) {
    Texture t = loadTexture(scene, texture);
    if (has(features, kFeatureChecker)) {
        for (int depth = 0; depth < kMaxCheckerDepth && t.kind == kTextureChecker; ++depth) {
            t = loadTexture(scene, isEvenCell(point, t.scale) ? t.first : t.second);
        }
    }
    vec4 color = vec4(t.color, 1.0f);
    if (has(features, kFeatureImages) && t.kind == kTextureImage) {
        color = color * imageColor(scene, t, has(features, kFeatureVertexAttributes) && t.uvSet != 0u ? uv2 : uv);
    } else if (has(features, kFeatureNoise) && isNoise(t.kind)) {
        color = vec4(t.color * noiseValue(scene, t, point), 1.0f);
    }
    return color;
}

RT_SHARED_END

#endif
