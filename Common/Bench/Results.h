// What a run of the benchmark found: plain rows of texts and numbers, the same in JSON, CSV and the report.
#pragma once
#include <cstdint>
#include <exception>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "Common/Bench/Config.h"
#include "Common/Image/Image.h"

namespace rt::bench {

using Figure = std::optional<double>; // nothing: not known, or of no meaning here

// One configuration at one number of samples, over all its repeats.
struct Row {
    std::string experiment;
    Config config;
    std::string device, kernel, lightShapes;

    Figure spp, timeBudget, repeats, threadsUsed;
    Figure seconds, secondsMin, secondsMax;                           // median, least and most over the repeats
    Figure secondsDevice, secondsLoad, secondsBuild, secondsPipeline; // medians
    Figure secondsDenoise;                                            // of `seconds`: features and filter; median
    Figure busy;                                                      // processor seconds / (seconds threads)
    Figure samplesPerSecond, raysPerSecond, raysPerSample;
    Figure mse, mseCi, rmse, relmse, relmseCi, mae, psnr, flip; // means; Ci: half of the 95 % confidence interval
    Figure mseUpTo1, mseUpTo1Ci, shareUpTo1;                    // of the pixels that the reference has at 1 or less
    Figure estimatedRelmse;                                     // what the denoiser says of its picture; mean
    Figure referenceShare;                                      // variance of the reference / mse
    Figure biasZ, fireflies, fireflyShare;                      // of the worst repeat; means
    Figure nonfinite;                                           // samples
    Figure efficiency, efficiencyUpTo1;                         // 1 / (mse seconds)
    Figure speedup;                                             // samples/s over those of the baseline
    Figure gain;                                                // efficiency over that of the baseline
    Figure joules, joulesGpu;                                   // of the processor package; of the GPU that rendered
    Figure ceiling;                                             // rays/s over what the hardware does with rays alone
};

// One configuration over all its numbers of samples.
struct Series {
    std::string experiment;
    Config config;
    Figure slope, slopeError, tailSlope;             // of log mse over log spp: all points, the last two
    Figure secondsTo1e2, secondsTo1e3, secondsTo1e4; // until relmse is 1e-2, 1e-3, 1e-4
    Figure reached;                                  // the least relmse measured: seconds below it are extrapolated
    Figure equalTime, relmseAtEqualTime;             // seconds; one for all series of a scene
    Figure equalError, secondsAtEqualError;          // relmse; one for all series of a scene
    Figure gain;                                     // seconds to the equal error: the baseline's over ours
};

// The exact feature mask against the kernel that can do everything.
struct SkipRow {
    std::string experiment;
    Config config; // with the exact mask
    std::string kernel;
    Figure spp, secondsExact, secondsAll, saved; // saved: 1 - exact / all, median over repeats
    Figure savedMin, savedMax;
    Figure differingPixels; // share of the pixels with any difference
    Figure largestDifference;
};

struct ReferenceRow {
    std::string scene;
    std::uint32_t width = 0, height = 0, maxDepth = 0;
    std::string engine;
    Figure spp, seconds, rmse; // rmse: its standard error
    bool cached = false, sufficient = false;
    std::string verifiedBy; // an engine of another kind whose rows were compared with it
    Figure verifiedZ;       // the largest |z| of these rows' tests of the mean
};

// For the report's picture grids; display-referred.
struct Picture {
    std::string caption;
    image::Image image;
};
struct PictureGrid {
    std::string experiment;
    std::string title;
    std::vector<Picture> pictures;
};

struct Fact {
    std::string name, value;
};

struct Results {
    std::string suite, title;
    std::vector<Fact> facts; // machine and versions
    std::vector<std::string> notices;
    bool complete = true;       // false: interrupted
    std::exception_ptr failure; // the first; the notices tell them all. Not part of the JSON
    std::vector<Row> rows;
    std::vector<Series> series;
    std::vector<SkipRow> skips;
    std::vector<ReferenceRow> references;
    std::vector<PictureGrid> grids; // not part of the JSON
};

// ---- rows as columns -----------------------------------------------------------------------------------------------

template <class T>
using FigureOf = Figure T::*;

template <class T>
struct FigureColumn {
    std::string_view name;
    FigureOf<T> value;
};
std::span<const FigureColumn<Row>> rowColumns();
std::span<const FigureColumn<Series>> seriesColumns();
std::span<const FigureColumn<SkipRow>> skipColumns();

} // namespace rt::bench
