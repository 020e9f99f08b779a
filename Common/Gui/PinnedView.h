// What is shown of the pinned picture beside the one that is rendered: the same view of both, where both have it.
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "Common/App/Interactive/InteractiveState.h"

namespace rt::gui {

// How the pinned picture A and the picture B share the window's part.
enum class CompareBy {
    Split,      // A at the left of a line, B at its right
    Blink,      // A and B in turn
    Difference, // B - A, about grey
};
constexpr app::Named<CompareBy> kCompareBys[] = {
    {"split", CompareBy::Split, "A/B split", "A at the left of a line, B at its right; drag the line"},
    {"blink", CompareBy::Blink, "Blink", "A and B in turn, twice a second"},
    {"difference", CompareBy::Difference, "Difference", "B - A of what is shown, about grey"}};

class PinnedView {
  public:
    // Of a picture, at the moment that it is pinned.
    void pin(const app::Picture& picture, app::ViewMode mode, std::string title, std::optional<app::RunRecord> work);
    // Of a render that was made elsewhere.
    void pin(std::shared_ptr<const image::Image> radiance, std::string title, app::RunRecord work);
    void clear() { *this = {}; }

    // Once a frame: what is shown follows the view of the picture, and the error the reference.
    void follow(const app::SessionState& state, const app::ViewRequest& view);

    explicit operator bool() const { return radiance_ != nullptr; }
    const std::shared_ptr<const image::Image>& shown() const { return shown_; }
    const std::shared_ptr<const image::Image>& radiance() const { return radiance_; }
    bool isDisplay() const { return isDisplay_; }   // of shown()
    bool isSameView() const { return isSameView_; } // as the picture's
    const std::string& title() const { return title_; }
    const std::optional<app::RunRecord>& work() const { return work_; }
    std::optional<double> relmse() const { return relmse_; } // against the reference, where that fits

  private:
    void measure(const app::SessionState& state);

    std::shared_ptr<const image::Image> radiance_, pinned_, shown_;
    app::ViewMode pinnedMode_ = app::ViewMode::Picture;
    bool isPinnedDisplay_ = false, isDisplay_ = false, isSameView_ = true;
    std::string title_;
    std::optional<app::RunRecord> work_;
    std::optional<double> relmse_;

    // What the shown image and the error are of.
    app::ViewRequest view_;
    std::shared_ptr<const image::Image> reference_;
    bool isFollowed_ = false;
};

// "CPU, 100 spp" and what else differs from the other: its short fields of work.
std::string sideTitle(const std::string& title, const std::optional<app::RunRecord>& work,
                      const std::optional<app::RunRecord>& other);

} // namespace rt::gui
