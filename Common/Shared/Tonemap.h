// From linear radiance to what a screen shows: exposure, tone curve, sRGB. Images on the screen and in PNG files go
// through here; files of linear radiance do not.
#ifndef RT_SHARED_TONEMAP_H
#define RT_SHARED_TONEMAP_H
#include "Common/Shared/Base/Shim.h"

RT_SHARED_BEGIN

const uint kTonemapNone = 0u;     // clamp
const uint kTonemapReinhard = 1u; // by luminance
const uint kTonemapAces = 2u;     // filmic curve
const uint kTonemapAgx = 3u;      // filmic curve that keeps bright colours apart from white for longer
const uint kTonemapNeutral = 4u;  // the identity but for what nears white

// Relative luminance of linear RGB with Rec. 709 primaries (ITU-R BT.709).
RT_FN float displayLuminance(vec3 color) {
    return dot(color, vec3(0.2126f, 0.7152f, 0.0722f));
}

// sRGB transfer functions, IEC 61966-2-1; linear and encoded are both in [0,1].
RT_FN float srgbEncode(float linear) {
    return linear <= 0.0031308f ? 12.92f * linear : 1.055f * pow(linear, 1.0f / 2.4f) - 0.055f;
}
RT_FN float srgbDecode(float encoded) {
    return encoded <= 0.04045f ? encoded / 12.92f : pow((encoded + 0.055f) / 1.055f, 2.4f);
}

// Reinhard et al. 2002, "Photographic Tone Reproduction for Digital Images", eq. 3, on luminance, so that hue stays.
RT_FN vec3 tonemapReinhard(vec3 color) {
    return color / (1.0f + displayLuminance(color));
}

// Narkowicz 2015, "ACES Filmic Tone Mapping Curve": a rational fit to the ACES reference, a channel at a time, with the
// input scaled by the 0.6 that aligns its exposure with the reference.
RT_FN vec3 tonemapAces(vec3 color) {
    // Beyond this the curve is flat, and its squares would overflow.
    const vec3 x = 0.6f * min(color, vec3(1.0e6f));
    return (x * (2.51f * x + 0.03f)) / (x * (2.43f * x + 0.59f) + 0.14f);
}

// A side of AgX's curve, for distances from the pivot that are relative to those of its ends: `slope` at 0, 1 at 1,
// by a hyperbola of that power in between.
RT_FN float agxSide(float x, float slope, float power) {
    const float scale = slope * pow(pow(slope, power) - 1.0f, -1.0f / power);
    const float t = slope * x / scale;
    return scale * t * pow(1.0f + pow(t, power), -1.0f / power);
}

// AgX's encoding of a channel: a sigmoid over the logarithm, from 10 stops below middle grey to 6.5 above.
RT_FN float agxCurve(float value) {
    const float kBelow = 10.0f, kAbove = 6.5f, kMiddleGrey = 0.18f;
    const float kPivot = kBelow / (kBelow + kAbove), kSlope = 2.0f, kToe = 3.0f, kShoulder = 3.25f;
    const float stops = log2(max(value, 1.0e-10f) / kMiddleGrey);
    const float x = clamp((stops + kBelow) / (kBelow + kAbove), 0.0f, 1.0f);
    if (x <= 0.0f || x >= 1.0f) return x; // exactly black and white
    if (x < kPivot) return 0.5f - 0.5f * agxSide((kPivot - x) / kPivot, 2.0f * kSlope * kPivot, kToe);
    return 0.5f + 0.5f * agxSide((x - kPivot) / (1.0f - kPivot), 2.0f * kSlope * (1.0f - kPivot), kShoulder);
}

// Sobotka 2022, "AgX": the curve on channels that a matrix has moved towards grey, so that a bright light fades to
// white and keeps its hue on the way; the matrix is undone afterwards. For Rec. 709 primaries, as in Wrensch 2023,
// "Minimal AgX Implementation". What comes out is for a display of power 2.2.
RT_FN vec3 tonemapAgx(vec3 color) {
    const vec3 inset = vec3(0.842479062f, 0.042328242f, 0.042375655f) * color.x +
                       vec3(0.078433600f, 0.878468636f, 0.078433600f) * color.y +
                       vec3(0.079223745f, 0.079166127f, 0.879142974f) * color.z;
    const vec3 curved = vec3(agxCurve(inset.x), agxCurve(inset.y), agxCurve(inset.z));
    const vec3 outset = vec3(1.196879005f, -0.052896852f, -0.052971636f) * curved.x +
                        vec3(-0.098020881f, 1.151903130f, -0.098043450f) * curved.y +
                        vec3(-0.099029744f, -0.098961177f, 1.151073673f) * curved.z;
    return vec3(pow(max(outset.x, 0.0f), 2.2f), pow(max(outset.y, 0.0f), 2.2f), pow(max(outset.z, 0.0f), 2.2f));
}

// Khronos 2024, "PBR Neutral Tone Mapper Specification": colours below 0.8 are shown as they are, less the share that a
// dielectric's reflection adds to its darkest channel (4 %, fading in from black); what is brighter keeps its hue,
// nears 1 as a hyperbola and fades to white on the way.
RT_FN vec3 tonemapNeutral(vec3 color) {
    const float kF90Share = 0.04f, kStart = 0.8f - 0.04f, kFade = 0.15f;
    const float minimum = min(color.x, min(color.y, color.z));
    const float offset = minimum < 2.0f * kF90Share ? minimum - minimum * minimum / (4.0f * kF90Share) : kF90Share;
    const vec3 base = color - vec3(offset);
    const float peak = max(base.x, max(base.y, base.z));
    if (peak < kStart) return base;
    const float room = 1.0f - kStart;
    const float shown = 1.0f - room * room / (peak + room - kStart);
    const float white = 1.0f - 1.0f / (kFade * (peak - shown) + 1.0f);
    return base * ((shown / peak) * (1.0f - white)) + vec3(shown * white);
}

// Linear radiance to linear display intensity in [0,1], not yet sRGB-encoded. exposure is in stops.
RT_FN vec3 tonemap(vec3 radiance, float exposure, uint curve) {
    const vec3 scaled = min(max(radiance, vec3(0.0f)) * exp2(exposure), vec3(1.0e30f));
    if (curve == kTonemapReinhard) return clamp(tonemapReinhard(scaled), 0.0f, 1.0f);
    if (curve == kTonemapAces) return clamp(tonemapAces(scaled), 0.0f, 1.0f);
    if (curve == kTonemapNeutral) return clamp(tonemapNeutral(scaled), 0.0f, 1.0f);
    if (curve == kTonemapAgx) return clamp(tonemapAgx(scaled), 0.0f, 1.0f);
    return clamp(scaled, 0.0f, 1.0f);
}

RT_FN vec3 srgbEncode(vec3 linear) {
    return vec3(srgbEncode(linear.x), srgbEncode(linear.y), srgbEncode(linear.z));
}

RT_SHARED_END

#endif
