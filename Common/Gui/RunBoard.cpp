#include "Common/Gui/RunBoard.h"

#include <utility>

namespace rt::gui {

// A program ends no two renders at once.
std::string RunBoard::keyOf(const app::RunRecord& run) {
    return run.time + '|' + run.app + '|' + run.scene + '|' + std::to_string(run.spp) + '|' +
           std::to_string(run.renderSeconds);
}

void RunBoard::update(app::RunHistory& history, const std::string& scene) {
    hovered_ = std::exchange(hoveredNext_, {});
    const std::vector<app::RunRecord>& records = history.records();
    if (!isStale_ && scene == scene_ && history.serial() == serial_) return;
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
    pair_ = app::newestOfEqualWork(marked);
    if (pair_.cpu == nullptr) pair_ = app::newestOfEqualWork(runs);
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
