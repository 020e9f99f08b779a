// Means over the pixels of the image in a square around each.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_scalar_block_layout : require
#include "Denoise.glsl"

layout(local_size_x = kDenoiseColumns, local_size_y = kDenoiseRows) in;

void main() {
    bool ofErrors = launch.use == kMeansAsTheyAre || launch.use == kMeansPositive;
    int reach = ofErrors ? kDenoiseErrorReach : kDenoiseVarianceReach;
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (!isInside(pixel)) return;
    ivec2 first = max(pixel - reach, ivec2(0));
    ivec2 last = min(pixel + reach, ivec2(launch.width, launch.height) - 1);
    vec4 sum = vec4(0.0f), others = vec4(0.0f);
    int otherCount = 0;
    for (int y = first.y; y <= last.y; y++)
        for (int x = first.x; x <= last.x; x++) {
            vec4 value = launch.values.at[pixelIndex(ivec2(x, y))];
            sum += value;
            if (max(abs(x - pixel.x), abs(y - pixel.y)) <= kDenoiseOwnReach) continue;
            others += value;
            otherCount++;
        }
    ivec2 size = last - first + 1;
    vec4 mean = sum / float(size.x * size.y);
    if (launch.use == kMeansOfTones) {
        for (int half_ = 0; half_ < 2; half_++) launch.filtered.at[planeIndex(pixel, half_)].w = mean.x;
    } else if (launch.use == kMeansToGuides) {
        for (int half_ = 0; half_ < 2; half_++) launch.guides.at[planeIndex(pixel, half_)].w = mean.x;
    } else if (launch.use == kMeansToTones) {
        for (uint half_ = 0u; half_ < 2u; half_++)
            launch.guides.at[half_ * pixelCount() + pixelIndex(pixel)].w = mean.x;
    } else if (launch.use == kMeansOfHistory) {
        launch.means.at[pixelIndex(pixel)] = mean;
    } else if (launch.use == kMeansPositive) {
        launch.means.at[pixelIndex(pixel)] = max(mean, vec4(0.0f));
    } else { // of the candidates' errors
        for (int i = 0; i < 4 && otherCount > 0; i++)
            mean[i] = denoiseChoiceError(mean[i], others[i] / float(otherCount));
        mean[kRawCandidate] *= kDenoiseRawCaution;
        launch.means.at[pixelIndex(pixel)] = mean;
    }
}
