#include "Common/Bench/Analysis.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <span>

#include "Common/Image/Convergence.h"
#include "Common/Image/Summary.h"
#include "Common/Shared/Base/Types.h"

namespace rt::bench {
namespace {

using image::CurvePoint;
using image::Summary;

constexpr double kMinBusySeconds = 0.05; // for clocks of threads that tick a hundred times a second
constexpr double kMinDeviceSeconds = 1;  // for steps of a tenth of a second in a device's counter of energy
constexpr std::uint32_t kDependentSide = shared::kReuseSide; // pixels of images and references may share paths

std::size_t steps(const Measured& measured) {
    std::size_t maximum = 0;
    for (const Run& run : measured.runs) maximum = std::max(maximum, run.snapshots.size());
    return maximum;
}

// Of the repeats that came to this step. `get` takes the run and the snapshot.
template <class Function>
std::vector<double> values(const Measured& measured, std::size_t step, Function get) {
    std::vector<double> all;
    for (const Run& run : measured.runs)
        if (step < run.snapshots.size()) all.push_back(get(run, run.snapshots[step]));
    return all;
}

template <class Function>
double medianOf(const Measured& measured, std::size_t step, Function get) {
    return image::median(values(measured, step, get));
}

std::vector<double> knownOf(const Measured& measured, std::size_t step, FigureOf<Snapshot> figure) {
    std::vector<double> known;
    for (const Run& run : measured.runs)
        if (step < run.snapshots.size() && run.snapshots[step].*figure) known.push_back(*(run.snapshots[step].*figure));
    return known;
}

Figure medianOfKnown(const Measured& measured, std::size_t step, FigureOf<Snapshot> figure) {
    const std::vector<double> known = knownOf(measured, step, figure);
    return known.empty() ? std::nullopt : Figure(image::median(known));
}

Figure meanOfKnown(const Measured& measured, std::size_t step, FigureOf<Snapshot> figure) {
    const std::vector<double> known = knownOf(measured, step, figure);
    return known.empty() ? std::nullopt : Figure(image::summarise(known).mean);
}

double pixelsOf(const Config& config) {
    return static_cast<double>(config.settings.width) * config.settings.height;
}

double raysOf(const Snapshot& s) {
    return static_cast<double>(s.rays.all());
}

Figure ratio(const Figure& a, const Figure& b) {
    return a && b && *b > 0 ? Figure(*a / *b) : std::nullopt;
}

// All that is known of another program's picture, beside its errors.
Row importedRow(Row row, const Snapshot& snapshot) {
    row.repeats = 1;
    row.seconds = row.secondsMin = row.secondsMax = snapshot.seconds;
    return row;
}

Row makeRow(const Experiment& experiment, const Measured& measured, std::size_t step) {
    const auto median = [&](auto get) { return medianOf(measured, step, get); };
    const auto report = [&](auto member) {
        return median([member](const Run& run, const Snapshot&) { return run.report.*member; });
    };
    const app::EngineReport& last = measured.runs.front().report;
    Row row;
    row.experiment = experiment.name;
    row.config = measured.config;
    row.device = last.device;
    row.kernel = last.kernel;
    row.lightShapes = last.lightSampling;
    if (measured.config.imported) return importedRow(row, measured.runs.front().snapshots[step]);
    row.spp = median([](const Run&, const Snapshot& s) { return static_cast<double>(s.spp); });
    const Summary seconds =
        image::summarise(values(measured, step, [](const Run&, const Snapshot& s) { return s.seconds; }));
    row.repeats = static_cast<double>(seconds.count);
    row.seconds = seconds.median;
    row.secondsMin = seconds.min;
    row.secondsMax = seconds.max;
    const double sampling = median([](const Run&, const Snapshot& s) { return s.seconds - s.secondsDenoise; });
    if (last.threads > 0) {
        row.threadsUsed = last.threads;
        const double processor = median([](const Run&, const Snapshot& s) { return s.processorSeconds; });
        if (sampling >= kMinBusySeconds && processor > 0) row.busy = processor / (sampling * last.threads);
    }
    if (measured.config.denoise != Denoise::Off)
        row.secondsDenoise = median([](const Run&, const Snapshot& s) { return s.secondsDenoise; });
    row.secondsDevice = median([](const Run&, const Snapshot& s) { return s.deviceSeconds; });
    row.secondsLoad = measured.secondsLoad;
    row.secondsBuild = report(&app::EngineReport::accelBuildSeconds);
    row.secondsPipeline = report(&app::EngineReport::pipelineSeconds);
    const double rays = median([](const Run&, const Snapshot& s) { return raysOf(s); });
    const double samples = median([](const Run&, const Snapshot& s) { return static_cast<double>(s.samples); });
    row.samplesPerSecond = ratio(samples, sampling);
    row.raysPerSecond = ratio(rays, sampling);
    row.raysPerSample = ratio(rays, samples);
    row.nonfinite = report(&app::EngineReport::nonfiniteSamples);
    for (const Run& run : measured.runs)
        if (step < run.snapshots.size()) row.timeBudget = run.snapshots[step].timeBudget;
    row.estimatedRelmse = meanOfKnown(measured, step, &Snapshot::estimatedRelmse);
    row.joules = medianOfKnown(measured, step, &Snapshot::joules);
    if (row.seconds >= kMinDeviceSeconds) row.joulesGpu = medianOfKnown(measured, step, &Snapshot::joulesGpu);
    return row;
}

// Half of the 95 % confidence interval of a mean error: too few repeats cannot tell their spread, but tiles can.
double intervalOf(const Summary& error, const Summary& tileError) {
    return error.count > 2 ? error.halfWidth95 : 1.96 * tileError.mean / std::sqrt(error.count);
}

void addError(Row& row, const std::vector<image::ErrorAnalysis>& all) {
    const auto summary = [&](auto get) {
        std::vector<double> numbers;
        numbers.reserve(all.size());
        for (const image::ErrorAnalysis& one : all) numbers.push_back(get(one));
        return image::summarise(numbers);
    };
    using Error = const image::ErrorAnalysis&;
    const Summary mse = summary([](Error e) { return e.mse; }), relmse = summary([](Error e) { return e.relmse; });
    row.mse = mse.mean;
    row.mseCi = intervalOf(mse, summary([](Error e) { return e.mseError; }));
    row.relmse = relmse.mean;
    row.rmse = std::sqrt(std::max(mse.mean, 0.0));
    if (all.size() > 2) row.relmseCi = relmse.halfWidth95;
    // Filtered errors do not fall with the inverse of time, so that there is no efficiency, and the noise of their
    // pixels is not independent, so that there is no test of the mean.
    const bool isRaw = row.config.denoise == Denoise::Off;
    if (isRaw) row.efficiency = image::efficiency(*row.mse, *row.seconds);
    row.shareUpTo1 = all.front().upTo1.share; // the reference's
    if (*row.shareUpTo1 > 0) {
        const Summary upTo1 = summary([](Error e) { return e.upTo1.mse; });
        row.mseUpTo1 = upTo1.mean;
        row.mseUpTo1Ci = intervalOf(upTo1, summary([](Error e) { return e.upTo1.mseError; }));
        if (isRaw) row.efficiencyUpTo1 = image::efficiency(upTo1.mean, *row.seconds);
    }
    row.mae = summary([](Error e) { return e.mae; }).mean;
    row.psnr = summary([](Error e) { return e.psnr; }).mean;
    row.flip = summary([](Error e) { return e.flip; }).mean;
    row.fireflies = summary([](Error e) { return static_cast<double>(e.fireflies); }).mean;
    row.fireflyShare = summary([](Error e) { return e.fireflyShare; }).mean;
    row.referenceShare = ratio(all.front().referenceMse, row.mse);
    double worst = 0;
    for (const image::ErrorAnalysis& one : all)
        if (std::abs(one.biasZ) > std::abs(worst)) worst = one.biasZ;
    if (isRaw) row.biasZ = worst;
}

// The rows of one configuration with those values for the axes of the baseline.
std::string baselineKey(const Experiment& experiment, const Config& config) {
    Config base = config;
    for (const auto& [axis, value] : experiment.baseline) axis->set(base, value);
    return keyOf(base);
}

std::vector<CurvePoint> curve(const std::vector<const Row*>& rows, FigureOf<Row> x, FigureOf<Row> y) {
    std::vector<CurvePoint> points;
    for (const Row* row : rows)
        if (row->*x && row->*y) points.push_back({*(row->*x), *(row->*y)});
    return points;
}

Figure secondsTo(const std::vector<CurvePoint>& relmseOverSeconds, double target) {
    const auto when = image::whenBelow(relmseOverSeconds, target);
    return when ? Figure(when->value) : std::nullopt;
}

} // namespace

std::vector<Row> makeRows(const Experiment& experiment, const Measured& measured) {
    std::vector<Row> rows;
    for (std::size_t step = 0; step < steps(measured); ++step) rows.push_back(makeRow(experiment, measured, step));
    return rows;
}

void addErrors(std::vector<Row>& rows, const Measured& measured, const image::Reference& reference) {
    for (std::size_t step = 0; step < rows.size(); ++step) {
        std::vector<image::ErrorAnalysis> all;
        bool whole = true; // no pixel without a sample, as where time is too short
        for (const Run& run : measured.runs) {
            if (step >= run.snapshots.size()) continue;
            whole = whole && (measured.config.imported || run.snapshots[step].spp > 0);
            all.push_back(image::analyseError(run.snapshots[step].image, reference, kDependentSide));
        }
        if (whole) addError(rows[step], all);
    }
}

void addBaselines(const Experiment& experiment, std::vector<Row>& rows) {
    if (experiment.baseline.empty()) return;
    std::map<std::string, std::vector<const Row*>> byKey;
    for (const Row& row : rows) byKey[keyOf(row.config)].push_back(&row);
    for (Row& row : rows) {
        const auto found = byKey.find(baselineKey(experiment, row.config));
        if (found == byKey.end()) continue;
        const Row* base = found->second.back();
        for (const Row* candidate : found->second)
            if (row.timeBudget ? candidate->timeBudget == row.timeBudget : candidate->spp == row.spp) base = candidate;
        row.speedup = ratio(row.samplesPerSecond, base->samplesPerSecond);
        row.gain = ratio(row.efficiency, base->efficiency);
    }
}

std::vector<Series> makeSeries(const Experiment& experiment, const std::vector<Row>& rows) {
    std::vector<std::string> keys; // in the order of their first row
    std::map<std::string, std::vector<const Row*>> byKey;
    for (const Row& row : rows) {
        if (!row.mse) continue;
        auto& list = byKey[keyOf(row.config)];
        if (list.empty()) keys.push_back(keyOf(row.config));
        list.push_back(&row);
    }
    std::vector<Series> all;
    std::map<std::string, std::vector<CurvePoint>> overTime;
    double equalTime = 1e300, equalError = 0;
    for (const std::string& key : keys) {
        const std::vector<const Row*>& own = byKey[key];
        Series series;
        series.experiment = experiment.name;
        series.config = own.front()->config;
        const std::vector<CurvePoint> overSamples = curve(own, &Row::spp, &Row::mse);
        if (const auto fit = image::fitLogLog(overSamples)) {
            series.slope = fit->slope;
            series.slopeError = fit->slopeError;
            series.tailSlope = fit->slope;
            if (overSamples.size() > 2)
                if (const auto tail = image::fitLogLog(std::span(overSamples).last(2))) series.tailSlope = tail->slope;
        }
        const std::vector<CurvePoint>& relmse = overTime[key] = curve(own, &Row::seconds, &Row::relmse);
        series.secondsTo1e2 = secondsTo(relmse, 1e-2);
        series.secondsTo1e3 = secondsTo(relmse, 1e-3);
        series.secondsTo1e4 = secondsTo(relmse, 1e-4);
        double minimum = 1e300;
        for (const CurvePoint& point : relmse)
            if (point.y > 0) minimum = std::min(minimum, point.y);
        if (minimum < 1e300) {
            series.reached = minimum;
            equalTime = std::min(equalTime, relmse.back().x); // all come that far,
            equalError = std::max(equalError, minimum);       // and that low
        }
        all.push_back(series);
    }
    for (Series& series : all) {
        const std::vector<CurvePoint>& relmse = overTime[keyOf(series.config)];
        if (!series.reached) continue;
        series.equalTime = equalTime;
        series.equalError = equalError;
        if (const auto error = image::errorAt(relmse, equalTime)) series.relmseAtEqualTime = error->value;
        series.secondsAtEqualError = secondsTo(relmse, equalError);
    }
    if (experiment.baseline.empty()) return all;
    for (Series& series : all)
        for (const Series& base : all)
            if (keyOf(base.config) == baselineKey(experiment, series.config))
                series.gain = ratio(base.secondsAtEqualError, series.secondsAtEqualError);
    return all;
}

std::vector<SkipRow> compareFeatures(const Experiment& experiment, const std::vector<Measured>& measured) {
    std::vector<SkipRow> rows;
    const Axis& features = *findAxis("features");
    for (const Measured& exact : measured) {
        if (exact.config.settings.features) continue;
        Config other = exact.config;
        features.set(other, "all");
        const auto found = std::find_if(measured.begin(), measured.end(),
                                        [&](const Measured& m) { return keyOf(m.config) == keyOf(other); });
        if (found == measured.end()) continue;
        std::vector<double> saved, secondsExact, secondsAll;
        SkipRow row{experiment.name, exact.config, "", {}, {}, {}, {}, {}, {}, {}, {}};
        for (std::size_t r = 0; r < std::min(exact.runs.size(), found->runs.size()); ++r) {
            if (exact.runs[r].snapshots.empty() || found->runs[r].snapshots.empty()) continue;
            const Snapshot &a = exact.runs[r].snapshots.back(), &b = found->runs[r].snapshots.back();
            if (a.spp != b.spp) continue;
            row.kernel = exact.runs[r].report.kernel;
            row.spp = static_cast<double>(a.spp);
            secondsExact.push_back(a.seconds);
            secondsAll.push_back(b.seconds);
            saved.push_back(1 - a.seconds / b.seconds);
            double differing = 0, largest = 0;
            for (std::size_t i = 0; i < a.image.data.size(); i += 3) {
                double difference = 0;
                for (std::size_t c = 0; c < 3; ++c)
                    difference = std::max(difference, std::abs(double(a.image.data[i + c]) - b.image.data[i + c]));
                differing += difference > 0;
                largest = std::max(largest, difference);
            }
            row.differingPixels = std::max(row.differingPixels.value_or(0), differing / pixelsOf(exact.config));
            row.largestDifference = std::max(row.largestDifference.value_or(0), largest);
        }
        if (saved.empty()) continue;
        const Summary summary = image::summarise(saved);
        row.saved = summary.median;
        row.savedMin = summary.min;
        row.savedMax = summary.max;
        row.secondsExact = image::median(secondsExact);
        row.secondsAll = image::median(secondsAll);
        rows.push_back(row);
    }
    return rows;
}

} // namespace rt::bench
