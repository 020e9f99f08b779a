#include "Common/Gui/PinnedView.h"

#include <cstddef>
#include <string_view>
#include <utility>
#include <vector>

#include "Common/App/Interactive/RunHistory.h"
#include "Common/App/Interactive/ViewImage.h"
#include "Common/Image/Metrics.h"

namespace rt::gui {
namespace {

bool isOfSize(const image::Image* image, const image::Image& other) {
    return image != nullptr && image->width == other.width && image->height == other.height;
}

} // namespace

void PinnedView::pin(const app::Picture& picture, app::ViewMode mode, std::string title,
                     std::optional<app::RunRecord> work) {
    *this = {};
    pinned_ = shown_ = picture.image;
    radiance_ = picture.subject;
    isPinnedDisplay_ = isDisplay_ = picture.isDisplay;
    pinnedMode_ = picture.isDisplay ? mode : app::ViewMode::Picture;
    title_ = std::move(title);
    work_ = std::move(work);
}

void PinnedView::pin(std::shared_ptr<const image::Image> radiance, std::string title, app::RunRecord work) {
    *this = {};
    pinned_ = shown_ = radiance_ = std::move(radiance);
    title_ = std::move(title);
    work_ = std::move(work);
}

void PinnedView::measure(const app::SessionState& state) {
    relmse_.reset();
    reference_ = state.referenceFits ? state.referenceImage : nullptr;
    if (isOfSize(reference_.get(), *radiance_)) relmse_ = image::compare(*radiance_, *reference_).relmse;
}

void PinnedView::follow(const app::SessionState& state, const app::ViewRequest& view) {
    if (!radiance_) return;
    const auto& reference = state.referenceFits ? state.referenceImage : nullptr;
    if (isFollowed_ && view == view_ && reference == reference_) return;
    if (!isFollowed_ || reference != reference_) measure(state);
    isFollowed_ = true;
    view_ = view;
    isSameView_ = true;
    using app::ViewMode;
    if (view.mode == ViewMode::Picture || view.mode == ViewMode::HalfA || view.mode == ViewMode::HalfB) {
        shown_ = radiance_;
        isDisplay_ = false;
    } else if (view.mode == app::ViewMode::Error && isOfSize(reference_.get(), *radiance_)) {
        shown_ = std::make_shared<image::Image>(app::showError(*radiance_, *reference_, view.scale).image);
        isDisplay_ = true;
    } else if (view.mode == pinnedMode_) {
        shown_ = pinned_;
        isDisplay_ = isPinnedDisplay_;
    } else { // what the pinned film knew of it is gone
        isSameView_ = false;
        shown_ = radiance_;
        isDisplay_ = false;
    }
}

std::string sideTitle(const std::string& title, const std::optional<app::RunRecord>& work,
                      const std::optional<app::RunRecord>& other) {
    if (!work || !other) return title;
    const std::vector<app::WorkField> ours = app::workOf(*work), theirs = app::workOf(*other);
    std::string text = title;
    for (std::size_t i = 0; i < ours.size(); ++i)
        if (ours[i].isShort && ours[i].value != theirs[i].value && ours[i].title != std::string_view("SPP"))
            text += std::string(", ") + ours[i].title + " " + ours[i].value;
    return text;
}

} // namespace rt::gui
