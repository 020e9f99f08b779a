// The filters of all bandwidths, first-order regression on features as in FilterTile.h, of the pixels of one work group
// and of one half: by weights from the other half, whose tones are the guide.
//     distances of pixels at some offsets  one column of pixels and one offset an invocation; sums of the columns of
//                                          patches, in shared memory
//     distances of patches, weights        one pixel an invocation, as is what follows
//     normal equations                     in registers, of all bandwidths
// Tiles with as many features as this shader is specialized for are filtered, others left alone. No invocation has an
// array: what is indexed by a loop that a driver does not unroll lies in memory, and takes ten times as long.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_control_flow_attributes : require
#include "Denoise.glsl"
#include "DenoiseDistances.glsl"

layout(local_size_x = kDenoiseColumns, local_size_y = kDenoiseRows) in;
layout(constant_id = 0) const int kFitFeatures = kDenoiseFeatures; // of this pipeline
const int kSurface = kFitFeatures - 3;                             // of these of the surface

// The normal equations of a bandwidth: sums of weights times the products of two of 1, the ways across and down from
// the pixel that is fitted, and the features of the surface; and of these times radiance.
struct Equations {
    vec3 position; // 1, across, across times across
    vec3 down;     // down times 1, across, down
    vec4 surface, surfaceAcross, surfaceDown;
    float products0; // of a feature of the surface with those up to it
    vec2 products1;
    vec3 products2;
    vec4 products3;
    vec3 radiance, radianceAcross, radianceDown;
    vec3 radiance0, radiance1, radiance2, radiance3;
};

void clear(out Equations sums) {
    sums.position = sums.down = vec3(0.0f);
    sums.surface = sums.surfaceAcross = sums.surfaceDown = vec4(0.0f);
    sums.products0 = 0.0f;
    sums.products1 = vec2(0.0f);
    sums.products2 = vec3(0.0f);
    sums.products3 = vec4(0.0f);
    sums.radiance = sums.radianceAcross = sums.radianceDown = vec3(0.0f);
    sums.radiance0 = sums.radiance1 = sums.radiance2 = sums.radiance3 = vec3(0.0f);
}

// Adds one that is in reach, but for products with the way down, which is the same for all of a row.
void add(inout Equations sums, float weight, float across, vec4 surface, vec3 radiance) {
    float weightAcross = weight * across;
    sums.position += vec3(weight, weightAcross, weightAcross * across);
    sums.radiance += weight * radiance;
    sums.radianceAcross += weightAcross * radiance;
    if (kSurface > 0) {
        float weighed = weight * surface.x;
        sums.surface.x += weighed;
        sums.surfaceAcross.x += weighed * across;
        sums.products0 += weighed * surface.x;
        sums.radiance0 += weighed * radiance;
    }
    if (kSurface > 1) {
        float weighed = weight * surface.y;
        sums.surface.y += weighed;
        sums.surfaceAcross.y += weighed * across;
        sums.products1 += weighed * surface.xy;
        sums.radiance1 += weighed * radiance;
    }
    if (kSurface > 2) {
        float weighed = weight * surface.z;
        sums.surface.z += weighed;
        sums.surfaceAcross.z += weighed * across;
        sums.products2 += weighed * surface.xyz;
        sums.radiance2 += weighed * radiance;
    }
    if (kSurface > 3) {
        float weighed = weight * surface.w;
        sums.surface.w += weighed;
        sums.surfaceAcross.w += weighed * across;
        sums.products3 += weighed * surface;
        sums.radiance3 += weighed * radiance;
    }
}

// Products with the way down follow from the others by Abel's summation. Let a(y) be the sum over the row y, from -R to
// R, and s(y) that over all rows up to y. Then the sum of y a(y) is R s(R) less the sum of s(y) over the rows but the
// last, and that of y^2 a(y) is R^2 s(R) less the sum of (2 y + 1) s(y). This is what the end of a row takes off.
void endRow(inout Equations sums, int y) {
    sums.down -= vec3(sums.position.xy, float(2 * y + 1) * sums.position.x);
    sums.surfaceDown -= sums.surface;
    sums.radianceDown -= sums.radiance;
}
void endRows(inout Equations sums) {
    const float kReach = float(kDenoiseReach);
    sums.down += kReach * vec3(sums.position.xy, kReach * sums.position.x);
    sums.down *= kDenoisePixel * vec3(1.0f, 1.0f, kDenoisePixel);
    sums.surfaceDown = kDenoisePixel * (sums.surfaceDown + kReach * sums.surface);
    sums.radianceDown = kDenoisePixel * (sums.radianceDown + kReach * sums.radiance);
}

// What is fitted at a pixel is this times the sums of radiance.
struct Fit {
    vec3 position; // 1, across, down
    vec4 surface;
};

float pivot(float diagonal) {
    return 1.0f / max(diagonal, 1.0e-7f); // rounding must not make it negative
}

// The inverse of the products times the features of the pixel itself, by L D L^T.
Fit solve(Equations sums, vec4 own) {
    float weights = sums.position.x + kDenoiseTiny;
    float ridge = kDenoiseRidge * weights + kDenoiseTiny;
    float one = pivot(weights);
    float across1 = one * sums.position.y;
    float down1 = one * sums.down.x;
    vec4 surface1 = one * sums.surface;
    float across = pivot(sums.position.z + ridge - across1 * sums.position.y);
    float downAcross = sums.down.y - across1 * sums.down.x;
    vec4 surfaceAcross = sums.surfaceAcross - across1 * sums.surface;
    float down2 = across * downAcross;
    vec4 surface2 = across * surfaceAcross;
    float down = pivot(sums.down.z + ridge - down1 * sums.down.x - down2 * downAcross);
    vec4 surfaceDown = sums.surfaceDown - down1 * sums.surface - down2 * surfaceAcross;
    vec4 surface3 = down * surfaceDown;
    vec3 b = vec3(1.0f, -across1, across1 * down2 - down1);
    Fit fit;
    fit.surface = vec4(0.0f);
    if (kSurface > 0) {
        vec4 column0 = vec4(sums.products0, sums.products1.x, sums.products2.x, sums.products3.x);
        vec4 column1 = vec4(0.0f, sums.products1.y, sums.products2.y, sums.products3.y);
        vec4 column2 = vec4(0.0f, 0.0f, sums.products2.z, sums.products3.z);
        vec4 column3 = vec4(0.0f, 0.0f, 0.0f, sums.products3.w);
        column0 -= sums.surface.x * surface1 + surfaceAcross.x * surface2 + surfaceDown.x * surface3;
        column1 -= sums.surface.y * surface1 + surfaceAcross.y * surface2 + surfaceDown.y * surface3;
        column2 -= sums.surface.z * surface1 + surfaceAcross.z * surface2 + surfaceDown.z * surface3;
        column3 -= sums.surface.w * surface1 + surfaceAcross.w * surface2 + surfaceDown.w * surface3;
        vec4 inverse;
        inverse.x = pivot(column0.x + ridge);
        vec4 l0 = inverse.x * column0;
        column1 -= column0.y * l0;
        column2 -= column0.z * l0;
        column3 -= column0.w * l0;
        inverse.y = pivot(column1.y + ridge);
        vec4 l1 = inverse.y * column1;
        column2 -= column1.z * l1;
        column3 -= column1.w * l1;
        inverse.z = pivot(column2.z + ridge);
        vec4 l2 = inverse.z * column2;
        column3 -= column2.w * l2;
        inverse.w = pivot(column3.w + ridge);
        vec4 c = own - b.x * surface1 - b.y * surface2 - b.z * surface3;
        c.yzw -= c.x * l0.yzw;
        c.zw -= c.y * l1.zw;
        c.w -= c.z * l2.w;
        c *= inverse;
        c.z -= c.w * l2.w;
        c.y -= dot(c.zw, l1.zw);
        c.x -= dot(c.yzw, l0.yzw);
        fit.surface = c;
    }
    fit.position.z = down * b.z - dot(surface3, fit.surface);
    fit.position.y = across * b.y - down2 * fit.position.z - dot(surface2, fit.surface);
    fit.position.x = one - across1 * fit.position.y - down1 * fit.position.z - dot(surface1, fit.surface);
    return fit;
}

vec3 valueOf(Fit fit, Equations sums) {
    return fit.position.x * sums.radiance + fit.position.y * sums.radianceAcross + fit.position.z * sums.radianceDown +
           fit.surface.x * sums.radiance0 + fit.surface.y * sums.radiance1 + fit.surface.z * sums.radiance2 +
           fit.surface.w * sums.radiance3;
}

// Where an invocation's pixel is.
struct Place {
    ivec2 group; // its first pixel
    ivec2 pixel;
    int half_;
    int plane;   // in bordered planes
    int feature; // in the features of its tile
    uint tile;
};
Place placeOf(uvec3 group, ivec2 inGroup) {
    Place place;
    place.group = ivec2(group.x, group.y + launch.firstRow) * ivec2(kDenoiseColumns, kDenoiseRows);
    place.pixel = place.group + inGroup;
    place.half_ = int(group.z);
    place.plane = planeIndex(place.pixel, place.half_);
    ivec2 tile = place.group / kDenoiseTile;
    ivec2 inReach = place.pixel - tile * kDenoiseTile + kDenoiseReach;
    uint tileColumns = (launch.width + uint(kDenoiseTile) - 1u) / uint(kDenoiseTile);
    place.tile = uint(tile.y) * tileColumns + uint(tile.x);
    place.feature = (int(place.tile) * kDenoiseTileReach + inReach.y) * kDenoiseTileReach + inReach.x;
    return place;
}

vec4 radianceAt(Place place, ivec2 offset) {
    return launch.radiance.at[place.plane + offset.y * denoisePitch(launch.width) + offset.x];
}

vec4 surfaceAt(Place place, ivec2 offset) {
    if (kSurface == 0) return vec4(0.0f);
    return launch.features.at[place.feature + offset.y * kDenoiseTileReach + offset.x];
}

// The normal equations of all bandwidths. That offsets have no weight is no reason not to add them: loads would have to
// wait until that is known.
void sumUp(Place place, out Equations first, out Equations second, out Equations third) {
    clear(first);
    clear(second);
    clear(third);
    for (int down = -kDenoiseReach; down <= kDenoiseReach; down++) {
        for (int from = -kDenoiseReach; from <= kDenoiseReach; from += kAtOnce) {
            sumColumns(place.group, ivec2(from, down), kAtOnce, place.half_);
            for (int i = 0; i < min(kAtOnce, kDenoiseReach + 1 - from); i++) {
                ivec2 offset = ivec2(from + i, down);
                vec4 radiance = radianceAt(place, offset);
                vec4 surface = surfaceAt(place, offset);
                vec3 weights = radiance.w * weigh(i);
                float across = kDenoisePixel * float(offset.x);
                add(first, weights.x, across, surface, radiance.rgb);
                add(second, weights.y, across, surface, radiance.rgb);
                add(third, weights.z, across, surface, radiance.rgb);
            }
        }
        if (down == kDenoiseReach) break;
        endRow(first, down);
        endRow(second, down);
        endRow(third, down);
    }
    endRows(first);
    endRows(second);
    endRows(third);
}

bool isPartner(ivec2 offset, ivec2 pixel) {
    return offset != ivec2(0) && (offset.x == 0 || offset.x == denoisePartner(1, pixel.x)) &&
           (offset.y == 0 || offset.y == denoisePartner(1, pixel.y));
}

float fitted(Fit fit, vec2 way, vec4 surface) {
    return dot(fit.position, vec3(1.0f, way)) + dot(fit.surface, surface);
}

// By which the other pixels of a square of 2x2 enter what is fitted, for each bandwidth.
vec3 partnerFactors(Place place, Fit first, Fit second, Fit third) {
    const int kSide = 3;
    sumColumns(place.group, ivec2(-1), kSide, place.half_);
    vec3 factors = vec3(0.0f);
    for (int i = 0; i < kSide * kSide; i++) {
        ivec2 offset = ivec2(i % kSide, i / kSide) - 1;
        if (!isPartner(offset, place.pixel)) continue;
        vec2 way = kDenoisePixel * vec2(offset);
        vec4 surface = surfaceAt(place, offset);
        vec3 values = vec3(fitted(first, way, surface), fitted(second, way, surface), fitted(third, way, surface));
        factors += radianceAt(place, offset).w * weigh(i) * values;
    }
    return factors;
}

void store(Place place, uint candidate, Fit fit, Equations sums, vec4 own, float partnerFactor) {
    uint at = (candidate * 2u + uint(place.half_)) * pixelCount() + pixelIndex(place.pixel);
    vec2 factors = vec2(fitted(fit, vec2(0.0f), own), partnerFactor); // the pixel's own weight is 1
    launch.filtered.at[at] = vec4(max(valueOf(fit, sums), vec3(0.0f)), uintBitsToFloat(packHalf2x16(factors)));
}

void main() {
    Place place = placeOf(gl_WorkGroupID, ivec2(gl_LocalInvocationID.xy));
    if (launch.axes.at[place.tile] != uint(kSurface)) return;
    Equations first, second, third;
    sumUp(place, first, second, third);
    vec4 own = surfaceAt(place, ivec2(0));
    Fit firstFit = solve(first, own);
    Fit secondFit = solve(second, own);
    Fit thirdFit = solve(third, own);
    vec3 partners = vec3(0.0f);
    if (launch.dependentSide != 1u) partners = partnerFactors(place, firstFit, secondFit, thirdFit);
    if (!isInside(place.pixel)) return;
    store(place, 0u, firstFit, first, own, partners.x);
    store(place, 1u, secondFit, second, own, partners.y);
    store(place, 2u, thirdFit, third, own, partners.z);
}
