// Which of the denoiser's filters a pixel takes, and when it stays as it is: the one of least error over the pixels
// around it, which are averaged as far as they show the same surface. A quiet pixel beside an edge would take the edge
// for its own noise otherwise.
#ifndef RT_SHARED_DENOISE_CHOICE_H
#define RT_SHARED_DENOISE_CHOICE_H
#include "Common/Shared/Base/Elementary.h"
#include "Common/Shared/Base/Shim.h"

RT_SHARED_BEGIN

const int kDenoiseChoiceReach = 3;     // pixels in either direction, over which the error of a filter is averaged,
const int kDenoiseOwnReach = 2;        // once with the pixels so near and once without: see denoiseChoiceError()
const uint kDenoiseRawSamples = 4u;    // of each half, from which on a pixel may stay as it is,
const float kDenoiseRawCaution = 4.0f; // where its error is so many times less: halves that have missed the same look
                                       // free of noise
// Over so many pixels around it the choices of filters are averaged, and that of a pixel as it is, which is made where
// there are details.
const int kDenoiseBlendReach = 2;
const int kDenoiseRawBlendReach = 1;

// How much the error of one pixel tells of that of another in its row or column, by the squared difference of their
// shading normals and depths, scaled as for the fit (DenoiseFit.h); their albedo is left out, as a filter of a texture
// is right or wrong for its surface. Never 0: the least error of few pixels is chance.
RT_FN float denoiseLikeness(float squaredDifference) {
    const float kMinLikeness = 0.05f;
    const float kUnlike = 0.04f; // of normals a tenth apart, or depths a twentieth of the usual one
    return max(kMinLikeness, 1.0f - (1.0f - kMinLikeness) / kUnlike * squaredDifference);
}

// The error of a candidate by which a pixel chooses, by the mean of all around it and of those but the nearest. The
// least of several errors that chance has a part in is below what it stands for, the more so the more of it is the
// pixel's own; but a bright sample that a candidate keeps is seen in the pixel alone.
RT_FN float denoiseChoiceError(float meanOfAll, float meanOfOthers) {
    return max(meanOfAll, meanOfOthers);
}

// By what the filters' shares of choices change where the share of the pixel as it is was `raw` and becomes `newRaw`.
RT_FN float denoiseFilterScale(float raw, float newRaw) {
    return raw < 1.0f ? (1.0f - newRaw) / (1.0f - raw) : 0.0f;
}

RT_SHARED_END

#endif
