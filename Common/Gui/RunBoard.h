// Which runs of the history the comparison shows, and what the user has marked among them.
#pragma once
#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "Common/App/Interactive/RunGroups.h"
#include "Common/App/Interactive/RunHistory.h"

namespace rt::gui {

class RunBoard {
  public:
    static constexpr std::size_t kMaxRuns = 200; // the newest

    // The work of what is in view: of the picture, and of a pinned one beside it where both are shown.
    struct InView {
        std::optional<app::RunRecord> picture, pinned;
        bool operator==(const InView&) const = default;
    };

    // Once a frame, before all else: the runs of one scene, or of all where it is empty, but for the hidden ones.
    void update(app::RunHistory& history, const std::string& scene, const InView& inView);
    // Valid until the next update.
    const app::RunGroups& groups() const { return groups_; }
    // What is compared: two runs that are selected, or of several the newest of equal work; else those of the picture
    // and of the pinned one; else the newest of both programs for the picture's work.
    const app::RunPair& pair() const { return pair_; }
    const app::RunRecord* cpuRun() const { return cpu_; } // the newest of the picture's work; null: none
    const app::RunRecord* gpuRun() const { return gpu_; }

    bool isSelected(const app::RunRecord& run) const { return selected_.count(keyOf(run)) > 0; }
    void select(const app::RunRecord& run, bool isAdded); // in place of the others, or also; a selected one no more
    std::vector<app::RunRecord> selected() const;         // of those that are shown
    std::vector<app::RunRecord> shown() const;
    void clearSelection();
    void hideSelected();
    void showHidden();
    std::size_t hiddenCount() const { return hidden_.size(); }

    // What the pointer is at, in the table or the chart: of the frame before.
    bool isHovered(const app::RunRecord& run) const { return !hovered_.empty() && keyOf(run) == hovered_; }
    void hover(const app::RunRecord& run) { hoveredNext_ = keyOf(run); }

  private:
    static std::string keyOf(const app::RunRecord& run);
    void rebuild(const std::vector<app::RunRecord>& records);
    void choosePair(const std::vector<const app::RunRecord*>& runs, const std::vector<const app::RunRecord*>& marked);

    std::string scene_;
    std::uint64_t serial_ = ~std::uint64_t{0}; // of the history
    bool isStale_ = true;
    app::RunGroups groups_;
    InView inView_;
    app::RunPair pair_;
    const app::RunRecord *cpu_ = nullptr, *gpu_ = nullptr;
    std::set<std::string> selected_, hidden_;
    std::string hovered_, hoveredNext_;
};

} // namespace rt::gui
