// What a live picture takes over from the one before it, which another camera has seen: the samples of the same points
// of surfaces, after Schied et al. 2017, "Spatiotemporal Variance-Guided Filtering". Each half of the samples has a
// history of its own, and how far it is to be trusted is decided by the other one: so both halves stay independent, and
// their difference goes on to be the noise by which the live filter weighs.
#ifndef RT_SHARED_DENOISE_HISTORY_H
#define RT_SHARED_DENOISE_HISTORY_H
#include "Common/Shared/Base/Elementary.h"
#include "Common/Shared/Base/Types.h"

RT_SHARED_BEGIN

// Samples of a half that a pixel remembers at most, and that a film may have for its picture to take any over: the
// more, the less noise there is, and the longer what is seen in mirrors lags behind.
const float kHistorySamples = 16.0f;
const float kHistoryMaxPlaneDistance = 2.0f; // in widths of a pixel there: a surface's points are as near to its plane
const float kHistoryMaxRelativeDistance = 0.01f; // in units of the depth, besides
const float kHistoryMinCosine = 0.9f;            // of the normals
const float kHistoryMaxAlbedo = 0.2f;            // length of the difference
// Share of the differences from the new samples that are the same all over a square of pixels: of noise it is about one
// over their number, and 1 where light has changed.
const float kHistoryTrustedShare = 0.15f;
const float kHistoryRefusedShare = 0.5f;
// Above this ratio of brightness, in tones' terms, neighbours are on both sides of an edge.
const float kHistoryMaxContrast = 4.0f;
const float kHistoryBorrowed = 0.5f; // of a sample: what a neighbour's counts for a half that has none of its own

// What a camera has seen in a pixel. Of the sky only the kind of surface is known.
struct HistorySurface {
    vec3 point; // from the middle of the camera's lens
    vec3 normal;
    vec3 albedo;
    bool isHit;
};

// The direction that the middle of the lens sees at that place of the image, of which the lower right corner is (1, 1).
RT_FN vec3 historyDirection(RT_IN(Camera) camera, vec2 place) {
    return normalize(camera.corner + camera.across * place.x + camera.down * place.y);
}

// The place in the image of a point, or of a direction, from the middle of the lens; z: what of it is along the view,
// in units of the distance of the plane of focus. Not above 0: it is not in front of the camera.
RT_FN vec3 historyPlace(RT_IN(Camera) camera, vec3 point) {
    vec3 view = cross(camera.across, camera.down);
    float along = dot(point, view) / dot(camera.corner, view);
    vec3 onPlane = point * (1.0f / (along > 0.0f ? along : 1.0f)) - camera.corner;
    return vec3(dot(onPlane, camera.across) / dot(camera.across, camera.across),
                dot(onPlane, camera.down) / dot(camera.down, camera.down), along);
}

// A pixel's width where the point is; `pixels`: those of a row of the image.
RT_FN float historyPixelWidth(RT_IN(Camera) camera, float along, float pixels) {
    return along * length(camera.across) / pixels;
}

// Whether a pixel of the last picture has seen the surface that is seen now. All points are from the middle of the last
// camera's lens; `pixelWidth`: there.
RT_FN bool isSameSurface(RT_IN(HistorySurface) now, RT_IN(HistorySurface) last, float pixelWidth) {
    if (!now.isHit || !last.isHit) return now.isHit == last.isHit;
    float allowed = kHistoryMaxPlaneDistance * pixelWidth + kHistoryMaxRelativeDistance * length(now.point);
    vec3 difference = now.albedo - last.albedo;
    return abs(dot(last.point - now.point, now.normal)) <= allowed &&
           dot(last.normal, now.normal) >= kHistoryMinCosine &&
           dot(difference, difference) <= kHistoryMaxAlbedo * kHistoryMaxAlbedo;
}

// Whether pixels of the last picture are too unlike for a mean of them to be what is between: one of a lamp and a wall
// would leave light beside the lamp from frame to frame. `darkest` and `brightest` of them, of each half, as sums of
// the channels. Noise that only one of the halves has is no edge.
RT_FN bool isHistoryEdge(vec2 darkest, vec2 brightest) {
    vec2 excess = 3.0f + 4.0f * brightest - kHistoryMaxContrast * (3.0f + 4.0f * darkest);
    return min(excess.x, excess.y) > 0.0f;
}

// How far the history of a half is to be trusted, by the other half's difference of new samples from its own history:
// its mean over a square of pixels, and that of its square. Noise cancels in the first, what moves with the camera,
// as in mirrors, does not. Where all samples have missed the light, as noise may, that half loses its history but
// none of its energy, since its own samples have had no say.
RT_FN float historyTrust(float mean, float meanSquare) {
    float share = meanSquare > 0.0f ? mean * mean / meanSquare : 0.0f;
    return clamp((kHistoryRefusedShare - share) * (1.0f / (kHistoryRefusedShare - kHistoryTrustedShare)), 0.0f, 1.0f);
}

// Radiance and, last, the number of samples that it is the mean of: of a history, and with new samples. No samples: 0.
RT_FN vec4 withNewSamples(vec4 history, vec3 fresh, float samples) {
    float count = history.w + samples;
    vec3 kept = vec3(history);
    float share = count > 0.0f ? samples / count : 1.0f;
    // Not a weighted sum: what is the same in both stays what it is.
    vec3 mean = history.w > 0.0f ? kept + share * (fresh - kept) : fresh;
    return vec4(mean, min(count, kHistorySamples));
}

// A unit vector as two numbers from -1 to 1, by the octahedron: Meyer et al. 2010, "On Floating-Point Normal Vectors".
RT_FN vec2 octahedral(vec3 v) {
    float size = abs(v.x) + abs(v.y) + abs(v.z);
    float x = v.x / max(size, 1.0e-37f);
    float y = v.y / max(size, 1.0e-37f);
    float foldedX = (1.0f - abs(y)) * (x < 0.0f ? -1.0f : 1.0f);
    float foldedY = (1.0f - abs(x)) * (y < 0.0f ? -1.0f : 1.0f);
    return v.z < 0.0f ? vec2(foldedX, foldedY) : vec2(x, y);
}
RT_FN vec3 fromOctahedral(vec2 o) {
    float z = 1.0f - abs(o.x) - abs(o.y);
    float fold = max(-z, 0.0f);
    return normalize(vec3(o.x + (o.x < 0.0f ? fold : -fold), o.y + (o.y < 0.0f ? fold : -fold), z));
}

RT_FN uint historyBits(float value, float minimum, float maximum, uint steps) {
    float share = (clamp(value, minimum, maximum) - minimum) / (maximum - minimum);
    return uint(share * float(steps) + 0.5f);
}
RT_FN float fromHistoryBits(uint bits, float minimum, float maximum, uint steps) {
    return minimum + (maximum - minimum) * float(bits & steps) / float(steps);
}

// All but the point, as far as it takes to tell surfaces apart: 8 bits of each number of the normal, 5 of each of the
// albedo, and one that is set where there is a surface.
RT_FN uint packHistorySurface(RT_IN(HistorySurface) surface) {
    vec2 normal = octahedral(surface.normal);
    uint bits = historyBits(normal.x, -1.0f, 1.0f, 254u) | (historyBits(normal.y, -1.0f, 1.0f, 254u) << 8u);
    bits |= historyBits(surface.albedo.x, 0.0f, 1.0f, 31u) << 16u;
    bits |= historyBits(surface.albedo.y, 0.0f, 1.0f, 31u) << 21u;
    bits |= historyBits(surface.albedo.z, 0.0f, 1.0f, 31u) << 26u;
    return surface.isHit ? bits | 0x80000000u : 0u;
}
RT_FN HistorySurface unpackHistorySurface(vec3 point, uint bits) {
    HistorySurface surface;
    surface.point = point;
    surface.normal = fromOctahedral(vec2(float(bits & 255u), float((bits >> 8u) & 255u)) * (1.0f / 127.0f) - 1.0f);
    surface.albedo = vec3(fromHistoryBits(bits >> 16u, 0.0f, 1.0f, 31u), fromHistoryBits(bits >> 21u, 0.0f, 1.0f, 31u),
                          fromHistoryBits(bits >> 26u, 0.0f, 1.0f, 31u));
    surface.isHit = bits != 0u;
    return surface;
}

RT_SHARED_END

#endif
