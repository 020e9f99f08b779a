// What the picture before has known of the points that this one shows: a weighted mean of the four pixels around the
// place where its camera saw them, of those that have shown the same surface.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_scalar_block_layout : require
#include "DenoiseHistory.glsl"

// Radiance and number of samples.
struct Found {
    vec4 halves[2];
};

Found findHistory(HistorySurface surface, vec2 place, float pixelWidth) {
    ivec2 size = ivec2(launch.lastWidth, launch.lastHeight);
    uint pixels = launch.lastWidth * launch.lastHeight;
    vec2 corner = place * vec2(size) - 0.5f;
    ivec2 first = ivec2(floor(corner));
    vec2 share = corner - vec2(first);
    vec4 sumA = vec4(0.0f), sumB = vec4(0.0f);
    vec2 counted = vec2(0.0f);
    vec2 darkest = vec2(kDenoiseMaxRadiance), brightest = vec2(0.0f);
    float weights = 0.0f;
    for (int i = 0; i < 4; i++) {
        ivec2 step = ivec2(i & 1, i >> 1);
        ivec2 other = first + step;
        if (any(lessThan(other, ivec2(0))) || any(greaterThanEqual(other, size))) continue;
        uint at = uint(other.y * size.x + other.x);
        vec4 a = launch.last.at[at];
        vec4 b = launch.last.at[pixels + at];
        vec2 sums = vec2(dot(a.rgb, vec3(1.0f)), dot(b.rgb, vec3(1.0f)));
        darkest = min(darkest, sums);
        brightest = max(brightest, sums);
        vec4 packed_ = launch.last.at[kHistoryPoints * pixels + at];
        HistorySurface last = unpackHistorySurface(packed_.xyz, floatBitsToUint(packed_.w));
        if (!isSameSurface(surface, last, pixelWidth)) continue;
        float weight = (step.x == 1 ? share.x : 1.0f - share.x) * (step.y == 1 ? share.y : 1.0f - share.y);
        weights += weight;
        // A half without samples there has nothing to say of radiance.
        vec2 own = weight * vec2(a.w > 0.0f ? 1.0f : 0.0f, b.w > 0.0f ? 1.0f : 0.0f);
        counted += own;
        sumA += own.x * a;
        sumB += own.y * b;
    }
    Found found;
    if (isHistoryEdge(darkest, brightest)) counted = vec2(0.0f);
    found.halves[0] = counted.x > 0.0f ? vec4(sumA.rgb / counted.x, sumA.w / weights) : vec4(0.0f);
    found.halves[1] = counted.y > 0.0f ? vec4(sumB.rgb / counted.y, sumB.w / weights) : vec4(0.0f);
    return found;
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (!isInside(pixel)) return;
    HistorySurface surface = seenSurface(pixel);
    Camera last = launch.views.at.last;
    // The sky is as far away for all cameras.
    if (surface.isHit) surface.point += launch.views.at.now.origin - last.origin;
    vec3 place = historyPlace(last, surface.point);
    Found found = Found(vec4[2](vec4(0.0f), vec4(0.0f)));
    if (place.z > 0.0f && all(greaterThanEqual(place.xy, vec2(0.0f))) && all(lessThanEqual(place.xy, vec2(1.0f))))
        found = findHistory(surface, place.xy, historyPixelWidth(last, place.z, float(launch.lastWidth)));
    vec2 differences = vec2(0.0f);
    for (uint half_ = 0u; half_ < 2u; half_++) {
        vec4 known = found.halves[half_];
        launch.found.at[half_ * pixelCount() + pixelIndex(pixel)] = known;
        if (known.w > 0.0f && hasOwnSamples(pixel, half_))
            differences[half_] = dot(ownRadiance(pixel, half_) - known.rgb, vec3(1.0f));
    }
    launch.differences.at[pixelIndex(pixel)] = vec4(differences, differences * differences);
}
