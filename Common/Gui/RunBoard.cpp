#include "Common/Gui/RunBoard.h"

#include <algorithm>
#include <utility>

#include "Common/App/Options/Options.h"

namespace rt::gui {

namespace {

// The newest run of a program that did this work; null: none.
const app::RunRecord* newestRun(const std::vector<const app::RunRecord*>& newestFirst, const app::RunRecord& work,
                                const std::string& program) {
    const auto at = std::find_if(newestFirst.begin(), newestFirst.end(), [&](const app::RunRecord* run) {
        return run->app == program && app::isSameWork(work, *run);
    });
    return at != newestFirst.end() ? *at : nullptr;
}

} // namespace

// A program ends no two renders at once.
std::string RunBoard::keyOf(const app::RunRecord& run) {
    return run.time + '|' + run.app + '|' + run.scene + '|' + std::to_string(run.spp) + '|' +
           std::to_string(run.renderSeconds);
}

void RunBoard::update(app::RunHistory& history, const std::string& scene, const InView& inView) {
    hovered_ = std::exchange(hoveredNext_, {});
    const std::vector<app::RunRecord>& records = history.records();
    if (!isStale_ && scene == scene_ && history.serial() == serial_ && inView == inView_) return;
    inView_ = inView;
    scene_ = scene;
    serial_ = history.serial();
    rebuild(records);
}

void RunBoard::rebuild(const std::vector<app::RunRecord>& records) {
    isStale_ = false;
    std::vector<const app::RunRecord*> runs, marked; // the newest first
    for (auto record = records.rbegin(); record != records.rend() && runs.size() < kMaxRuns; ++record) {
        if ((!scene_.empty() && record->scene != scene_) || hidden_.count(keyOf(*record)) > 0) continue;
        runs.push_back(&*record);
        if (isSelected(*record)) marked.push_back(&*record);
    }
    groups_ = app::groupByWork(runs);
    choosePair(runs, marked);
}

void RunBoard::choosePair(const std::vector<const app::RunRecord*>& runs,
                          const std::vector<const app::RunRecord*>& marked) {
    pair_ = {};
    cpu_ = gpu_ = nullptr;
    if (inView_.picture) {
        cpu_ = newestRun(runs, *inView_.picture, app::kCpuProgram);
        gpu_ = newestRun(runs, *inView_.picture, app::kGpuProgram);
    }
    if (marked.size() == 2) {
        pair_ = app::pairOf(*marked[0], *marked[1]);
        return;
    }
    if (const app::EnginePair both = app::newestOfEqualWork(marked); both.cpu != nullptr) {
        pair_ = {both.cpu, both.gpu};
        return;
    }
    if (inView_.picture && inView_.pinned) {
        const app::RunRecord* shown = newestRun(runs, *inView_.picture, inView_.picture->app);
        const app::RunRecord* pinned = newestRun(runs, *inView_.pinned, inView_.pinned->app);
        if (shown != nullptr && pinned != nullptr && shown != pinned) {
            pair_ = app::pairOf(*pinned, *shown);
            return;
        }
    }
    if (cpu_ != nullptr && gpu_ != nullptr) pair_ = {cpu_, gpu_};
}

void RunBoard::clearSelection() {
    selected_.clear();
    isStale_ = true;
}

void RunBoard::select(const app::RunRecord& run, bool isAdded) {
    const std::string key = keyOf(run);
    const bool wasSelected = selected_.count(key) > 0;
    if (!isAdded) selected_.clear();
    if (wasSelected) {
        selected_.erase(key);
    } else {
        selected_.insert(key);
    }
    isStale_ = true;
}

std::vector<app::RunRecord> RunBoard::selected() const {
    std::vector<app::RunRecord> runs;
    for (const app::RunRow& row : groups_.rows)
        if (isSelected(*row.record)) runs.push_back(*row.record);
    return runs;
}

std::vector<app::RunRecord> RunBoard::shown() const {
    std::vector<app::RunRecord> runs;
    for (const app::RunRow& row : groups_.rows) runs.push_back(*row.record);
    return runs;
}

void RunBoard::hideSelected() {
    hidden_.insert(selected_.begin(), selected_.end());
    selected_.clear();
    isStale_ = true;
}

void RunBoard::showHidden() {
    hidden_.clear();
    isStale_ = true;
}

} // namespace rt::gui
