#include "Common/App/Interactive/RunGroups.h"

#include <algorithm>
#include <utility>

#include "Common/App/Options/Options.h"

namespace rt::app {
namespace {

using Works = std::vector<std::vector<WorkField>>; // of the runs

// Of each run, in one column of the table.
std::vector<std::string> cellsOf(const Works& works, std::size_t field) {
    std::vector<std::string> cells, seen;
    for (const std::vector<WorkField>& work : works) {
        const WorkField& f = work[field];
        if (f.isShort || f.value.empty()) {
            cells.push_back(f.value.empty() ? "?" : f.value);
            continue;
        }
        const auto at = std::find(seen.begin(), seen.end(), f.value);
        cells.push_back(std::to_string(at - seen.begin() + 1));
        if (at == seen.end()) seen.push_back(f.value);
    }
    return cells;
}

// Of each run. What a record lacks is taken for equal here: its cells say so, and no speed-up is taken of it.
std::vector<std::size_t> groupsOf(const Works& works, std::size_t& groups) {
    const auto isEqual = [](const WorkField& x, const WorkField& y) { return x.value == y.value; };
    std::vector<std::size_t> firsts, result;
    for (const std::vector<WorkField>& work : works) {
        const auto isSame = [&](std::size_t first) {
            return std::equal(work.begin(), work.end(), works[first].begin(), isEqual);
        };
        const auto at = std::find_if(firsts.begin(), firsts.end(), isSame);
        result.push_back(static_cast<std::size_t>(at - firsts.begin()));
        if (at == firsts.end()) firsts.push_back(result.size() - 1);
    }
    groups = firsts.size();
    return result;
}

} // namespace

RunGroups groupByWork(const std::vector<const RunRecord*>& runs) {
    RunGroups result;
    if (runs.empty()) return result;
    Works works;
    for (const RunRecord* run : runs) works.push_back(workOf(*run));
    const std::vector<std::size_t> groups = groupsOf(works, result.groups);
    for (std::size_t i = 0; i < runs.size(); ++i) result.rows.push_back({runs[i], groups[i], {}});
    for (std::size_t field = 0; field < works.front().size(); ++field) {
        const WorkField& first = works.front()[field];
        const auto isFirsts = [&](const std::vector<WorkField>& work) { return work[field].value == first.value; };
        if (std::all_of(works.begin(), works.end(), isFirsts)) {
            result.common.push_back(first);
            continue;
        }
        result.columns.push_back(first.title);
        std::vector<std::string> cells = cellsOf(works, field);
        for (std::size_t i = 0; i < runs.size(); ++i) result.rows[i].cells.push_back(std::move(cells[i]));
    }
    std::stable_sort(result.rows.begin(), result.rows.end(),
                     [](const RunRow& a, const RunRow& b) { return a.group < b.group; });
    return result;
}

Comparison compareRuns(const RunRecord& first, const RunRecord& second) {
    Comparison result;
    if (first.samplesPerSecond > 0) result.samplesPerSecond = second.samplesPerSecond / first.samplesPerSecond;
    if (first.hasReference != second.hasReference || first.efficiency() <= 0 || !isSamePicture(first, second))
        return result;
    result.timeToEqualError = second.efficiency() / first.efficiency();
    result.isMeasured = first.hasReference;
    return result;
}

RunPair pairOf(const RunRecord& a, const RunRecord& b) {
    const bool isSwapped = a.app != b.app ? a.app == kGpuProgram : b.time < a.time;
    return isSwapped ? RunPair{&b, &a} : RunPair{&a, &b};
}

RepeatedComparison compareRepeats(const RunPair& pair, const std::vector<RunRow>& rows) {
    RepeatedComparison result;
    result.isByError = !isSameWork(*pair.first, *pair.second);
    const auto repeatsOf = [&](const RunRecord& run) {
        std::vector<double> figures;
        for (const RunRow& row : rows) {
            const RunRecord& r = *row.record;
            const bool isRepeat = &r == &run || (r.app == run.app && r.engine == run.engine && r.device == run.device &&
                                                 r.threads == run.threads && isSameWork(r, run));
            const double figure = result.isByError ? r.efficiency() : r.samplesPerSecond;
            if (isRepeat && figure > 0 && (!result.isByError || r.hasReference == run.hasReference))
                figures.push_back(figure);
        }
        Repeats repeats;
        if (figures.empty()) return repeats;
        std::sort(figures.begin(), figures.end());
        const std::size_t count = figures.size();
        return Repeats{count, 0.5 * (figures[(count - 1) / 2] + figures[count / 2]), figures.front(), figures.back()};
    };
    result.first = repeatsOf(*pair.first);
    result.second = repeatsOf(*pair.second);
    const bool isComparable = !result.isByError || compareRuns(*pair.first, *pair.second).timeToEqualError > 0;
    if (isComparable && result.first.median > 0) result.ratio = result.second.median / result.first.median;
    return result;
}

bool isReferenceTooNoisy(double relmse, double referenceError) {
    return relmse > 0 && 9 * referenceError > relmse;
}

} // namespace rt::app
