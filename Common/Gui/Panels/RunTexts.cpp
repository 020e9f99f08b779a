#include "Common/Gui/Panels/RunTexts.h"

#include <algorithm>
#include <iterator>

#include "Common/Core/Format.h"
#include "Common/Render/Names.h"

namespace rt::gui {

std::string engineText(const app::RunRecord& run) {
    std::string text = (isGpuRun(run) ? "GPU " : "CPU ") + run.engine;
    if (run.isSoftware) text += " (software)";
    if (run.threads > 1) text += ", " + std::to_string(run.threads) + " threads";
    return text;
}

std::string factorText(double factor) {
    return formatted("%.3g\u00d7", factor);
}

std::string ratioText(double ratio) {
    return factorText(ratio >= 1 ? ratio : 1 / ratio) + (ratio >= 1 ? " faster" : " slower");
}

std::string percentText(double share) {
    return formatted("%.2g %%", 100 * share);
}

std::string headlineOf(const app::RunPair& pair, const app::RepeatedComparison& repeats) {
    const std::string by = repeats.isByError ? " (time to equal error)" : " (samples/s)";
    const std::string first = engineText(*pair.first), second = engineText(*pair.second);
    const std::string counts = std::to_string(repeats.first.count) + " and " + std::to_string(repeats.second.count);
    if (!(repeats.ratio > 0)) return second + " against " + first + ": not known, for want of errors of one picture";
    if (!repeats.isKnown())
        return second + " is " + ratioText(repeats.ratio) + " than " + first + by + ": " + counts +
               " runs; three of each tell how far repeated runs differ";
    const std::string spread = "medians of " + counts + " runs, which spread over " +
                               percentText(repeats.first.spread()) + " and " + percentText(repeats.second.spread());
    if (!repeats.isToldApart()) return first + " and " + second + " are not told apart" + by + ": " + spread;
    return second + " is " + ratioText(repeats.ratio) + " than " + first + by + ": " + spread;
}

std::string whenText(const app::RunRecord& run) {
    std::string text = run.time.substr(0, run.time.find('Z'));
    std::replace(text.begin(), text.end(), 'T', ' ');
    return text;
}

std::string errorText(double value) {
    return value > 0 ? formatted("%.2e", value) : "-";
}

std::string errorKind(const app::RunRecord& run) {
    if (run.relmse <= 0) return {};
    return run.hasReference ? "measured" : "estimated";
}

std::string whatErrorKindMeans(const app::RunRecord& run) {
    if (run.relmse <= 0) return "The error is not known";
    if (!run.hasReference)
        return "The film's own estimate, from how its samples differ; with one replicate of Sobol or strata it is too "
               "high by factors";
    std::string text = "Measured against a reference";
    if (run.referenceError > 0) text += ", whose own relMSE is " + errorText(run.referenceError);
    if (app::isReferenceTooNoisy(run.relmse, run.referenceError))
        text += ": too noisy for this error. Render it with more samples";
    return text;
}

std::string runDetails(const app::RunRecord& run) {
    const std::string lacking = lackingIn(run);
    return (run.time.empty() ? "" : whenText(run) + " UTC, ") + run.device +
           (run.isSoftware ? " (a driver that works on the processor)" : "") +
           (lacking.empty() ? "" : "\nCompared with no other run: the record lacks " + lacking);
}

Mark markOf(const std::string& lightSampling) {
    constexpr Mark kMarks[] = {Mark::Circle, Mark::Square, Mark::Diamond, Mark::Triangle}; // of each row
    static_assert(std::size(kMarks) == std::size(app::kLightSamplings));
    for (std::size_t i = 0; i < std::size(kMarks); ++i)
        if (app::kLightSamplings[i].name == lightSampling) return kMarks[i];
    return Mark::Circle;
}

} // namespace rt::gui
