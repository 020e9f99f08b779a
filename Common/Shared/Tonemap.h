// From linear radiance to what a screen shows: exposure, tone curve, sRGB. Images on the screen and in PNG files go
// through here; files of linear radiance do not.
#ifndef RT_SHARED_TONEMAP_H
#define RT_SHARED_TONEMAP_H
#include "Common/Shared/Base/Shim.h"

RT_SHARED_BEGIN

const uint kTonemapNone = 0u;     // clamp
const uint kTonemapReinhard = 1u; // by luminance
const uint kTonemapAces = 2u;     // filmic curve

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

// Linear radiance to linear display intensity in [0,1], not yet sRGB-encoded. exposure is in stops.
RT_FN vec3 tonemap(vec3 radiance, float exposure, uint curve) {
    const vec3 scaled = min(max(radiance, vec3(0.0f)) * exp2(exposure), vec3(1.0e30f));
    if (curve == kTonemapReinhard) return clamp(tonemapReinhard(scaled), 0.0f, 1.0f);
    if (curve == kTonemapAces) return clamp(tonemapAces(scaled), 0.0f, 1.0f);
    return clamp(scaled, 0.0f, 1.0f);
}

RT_FN vec3 srgbEncode(vec3 linear) {
    return vec3(srgbEncode(linear.x), srgbEncode(linear.y), srgbEncode(linear.z));
}

RT_SHARED_END

#endif
