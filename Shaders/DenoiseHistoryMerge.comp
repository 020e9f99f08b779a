// Both halves of a live picture with what is known from the one before, which is what the next one will know.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_scalar_block_layout : require
#include "DenoiseHistory.glsl"

// Of a picture that is one, for the half whose samples the pixels around have: their mean, of those that show the same
// surface. The pixel's own sample would make both halves alike, as if there were no noise. So it does where none is the
// same, and its last component, the number of samples that the next picture may rely on, is 0 then.
vec4 borrowedRadiance(ivec2 pixel, HistorySurface surface, float pixelWidth) {
    vec3 sum = vec3(0.0f);
    int count = 0;
    for (int i = 0; i < 4; i++) {
        int step = 2 * (i & 1) - 1;
        ivec2 other = pixel + (i < 2 ? ivec2(step, 0) : ivec2(0, step));
        if (!isInside(other) || !isSameSurface(surface, seenSurface(other), pixelWidth)) continue;
        sum += ownRadiance(other, 0u);
        count++;
    }
    return count > 0 ? vec4(sum / float(count), kHistoryBorrowed * launch.samples) : vec4(ownRadiance(pixel, 0u), 0.0f);
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (!isInside(pixel)) return;
    uint at = pixelIndex(pixel);
    HistorySurface surface = seenSurface(pixel);
    vec4 means = launch.lastWidth > 0u ? launch.means.at[at] : vec4(0.0f);
    for (uint half_ = 0u; half_ < 2u; half_++) {
        vec4 history = vec4(0.0f);
        if (launch.lastWidth > 0u) history = launch.found.at[half_ * pixelCount() + at];
        history.w *= historyTrust(means[1u - half_], means[3u - half_]);
        vec4 merged = history;
        if (hasOwnSamples(pixel, half_)) {
            merged = withNewSamples(history, ownRadiance(pixel, half_), launch.samples);
        } else if (history.w <= 0.0f) {
            float along = historyPlace(launch.views.at.now, surface.point).z;
            merged = borrowedRadiance(pixel, surface,
                                      historyPixelWidth(launch.views.at.now, along, float(launch.width)));
        }
        launch.merged.at[half_ * pixelCount() + at] = merged.rgb;
        launch.next.at[half_ * pixelCount() + at] = merged;
    }
    launch.next.at[kHistoryPoints * pixelCount() + at] =
        vec4(surface.point, uintBitsToFloat(packHistorySurface(surface)));
}
