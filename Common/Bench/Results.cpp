#include "Common/Bench/Results.h"

namespace rt::bench {
namespace {

constexpr FigureColumn<Row> kRowColumns[] = {
    {"spp", &Row::spp},
    {"time_budget", &Row::timeBudget},
    {"repeats", &Row::repeats},
    {"threads_used", &Row::threadsUsed},
    {"seconds", &Row::seconds},
    {"seconds_min", &Row::secondsMin},
    {"seconds_max", &Row::secondsMax},
    {"seconds_device", &Row::secondsDevice},
    {"seconds_load", &Row::secondsLoad},
    {"seconds_accel_build", &Row::secondsBuild},
    {"seconds_pipeline", &Row::secondsPipeline},
    {"seconds_denoise", &Row::secondsDenoise},
    {"threads_busy", &Row::busy},
    {"samples_per_second", &Row::samplesPerSecond},
    {"rays_per_second", &Row::raysPerSecond},
    {"rays_per_sample", &Row::raysPerSample},
    {"mse", &Row::mse},
    {"mse_ci95", &Row::mseCi},
    {"mse_up_to_1", &Row::mseUpTo1},
    {"mse_up_to_1_ci95", &Row::mseUpTo1Ci},
    {"share_up_to_1", &Row::shareUpTo1},
    {"rmse", &Row::rmse},
    {"relmse", &Row::relmse},
    {"relmse_ci95", &Row::relmseCi},
    {"estimated_relmse", &Row::estimatedRelmse},
    {"mae", &Row::mae},
    {"psnr", &Row::psnr},
    {"flip", &Row::flip},
    {"reference_share", &Row::referenceShare},
    {"bias_z", &Row::biasZ},
    {"fireflies", &Row::fireflies},
    {"firefly_share", &Row::fireflyShare},
    {"nonfinite_samples", &Row::nonfinite},
    {"efficiency", &Row::efficiency},
    {"efficiency_up_to_1", &Row::efficiencyUpTo1},
    {"speedup", &Row::speedup},
    {"gain", &Row::gain},
    {"joules", &Row::joules},
    {"joules_gpu", &Row::joulesGpu},
    {"ceiling", &Row::ceiling},
};

constexpr FigureColumn<Series> kSeriesColumns[] = {
    {"slope", &Series::slope},
    {"slope_error", &Series::slopeError},
    {"tail_slope", &Series::tailSlope},
    {"seconds_to_relmse_1e-2", &Series::secondsTo1e2},
    {"seconds_to_relmse_1e-3", &Series::secondsTo1e3},
    {"seconds_to_relmse_1e-4", &Series::secondsTo1e4},
    {"reached_relmse", &Series::reached},
    {"equal_time", &Series::equalTime},
    {"relmse_at_equal_time", &Series::relmseAtEqualTime},
    {"equal_relmse", &Series::equalError},
    {"seconds_at_equal_relmse", &Series::secondsAtEqualError},
    {"gain", &Series::gain},
};

constexpr FigureColumn<SkipRow> kSkipColumns[] = {
    {"spp", &SkipRow::spp},
    {"seconds_exact", &SkipRow::secondsExact},
    {"seconds_all", &SkipRow::secondsAll},
    {"saved", &SkipRow::saved},
    {"saved_min", &SkipRow::savedMin},
    {"saved_max", &SkipRow::savedMax},
    {"differing_pixels", &SkipRow::differingPixels},
    {"largest_difference", &SkipRow::largestDifference},
};

} // namespace

std::span<const FigureColumn<Row>> rowColumns() {
    return kRowColumns;
}

std::span<const FigureColumn<Series>> seriesColumns() {
    return kSeriesColumns;
}

std::span<const FigureColumn<SkipRow>> skipColumns() {
    return kSkipColumns;
}

} // namespace rt::bench
