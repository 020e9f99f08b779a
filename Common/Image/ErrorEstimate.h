// The relMSE of a picture, told from its own noise.
#pragma once
#include "Common/Image/ImageRows.h"

namespace rt::image {

// Of the relMSE of Metrics.h: what it is expected to be over all seeds, given what one seed has shown.
struct RelMseEstimate {
    double value = 0;
    // Of `value`: what it would be if the noise of every pixel were one rare event (Campbell's theorem: the variance of
    // a sum of rare events is the sum of their squares), the same one for all pixels that depend on each other, which is
    // right for fireflies and too large for noise that many samples share; and 5 % for what the formula below takes for
    // granted. What no sample has met is in neither.
    double standardError = 0;

    // Ends of the 95 % confidence interval.
    double low() const;
    double high() const;
};

// `mean` and `variance` of that mean, as Film gives them: equal sizes and channels. Both are read once, row by row.
// The noise of pixels of a square of `dependentSide` may be alike; the first square begins at the first pixel.
//
// relMSE is the mean of variance / (expected^2 + 0.01), where `expected` is what a pixel converges to. A pixel's own
// mean will not do for it: the bright sample that makes the variance large makes the mean large as well, and hides
// itself. Nor will the mean of the pixels around alone, which says nothing about an edge. As in Lee's filter (1980,
// "Digital image enhancement and noise filtering by use of local statistics", eq. 8), `expected` lies between the two:
//
//   expected = trust own + (1 - trust) around,  trust = signal / (signal + variance),
//
// where `signal` is by how much the means of the 5x5 pixels around vary more than their noise explains. Neither end is
// taken at its word:
//
//   own^2    = max(mean^2 - variance, variance): free of the variance's bias; a mean that is all noise, as that of a
//              single event, is one of many that are as likely, from almost 0 on;
//   around^2 = (mean of the pixels around that do not depend on it)^2 + variance / n^2: a single event among n pixels
//              says no less of their mean than an n-th of it.
RelMseEstimate estimateRelMse(const ImageRows& mean, const ImageRows& variance, std::uint32_t dependentSide);

} // namespace rt::image
