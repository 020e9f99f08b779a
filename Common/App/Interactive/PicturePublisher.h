// What a window gets to see of films, drafts and previews: which picture, and when.
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include "Common/App/Interactive/FilmPlan.h"
#include "Common/App/Interactive/FilmReference.h"
#include "Common/App/Interactive/PictureFilter.h"
#include "Common/App/Interactive/PublishedState.h"
#include "Common/Render/FilmRun.h"

namespace rt::app {

class PicturePublisher {
  public:
    // `cancel` calls filters off.
    PicturePublisher(PublishedState& state, bool drawnBySoftware, const std::atomic<bool>& cancel)
        : state_(state), filter_(state, cancel), drawnBySoftware_(drawnBySoftware) {}

    // The latency is that from the first change that nothing is shown of to the first picture of it.
    void awaitPicture(const std::optional<Stopwatch>& changed);
    bool isAwaited() const { return awaited_.has_value(); }
    void forgetLatency() { awaited_.reset(); } // of what shows nothing new, or has told that something is being built

    bool setView(const ViewRequest& view); // false: it is as it was

    // A film's beginning: its drafts, if any, then begin(), then its pictures.
    void discardViews(); // views of the film before: features and cost
    void discardDraft() { draft_ = {}; }
    bool hasDraft() const { return !draft_.data.empty(); }
    void showDraft(const FilmRun& draft, const RenderSettings& film); // enlarged to the film's size
    void begin(Engine& engine);

    // The film so far, where it has no samples yet as the draft; without any, what was shown before stays.
    void show(const FilmRun& film, FilmReference& reference, const RenderSpeed& speed, Haste haste);
    // Of the denoiser: it could make a better picture of the film as it is; seconds that it takes for a pixel of a
    // draft, if it is on; the engine has begun the film anew; it begins something else; it goes, or gets another scene.
    bool isFiltering(const FilmRun& film) const { return isFiltered() && filter_.canImprove(film, wantsDetails()); }
    std::optional<double> denoiseSecondsPerPixel() const {
        return isFiltered() ? filter_.liveSecondsPerPixel() : std::nullopt;
    }
    void filterAnew(Engine& engine) { filter_.begin(engine); }
    void endFilter() { filter_.end(); }
    void forgetEngine() { filter_.forget(); }
    // A view of features is shown at once, with as many samples as there is time for, and then refined row by row until
    // it has as many as its file.
    bool isRefining() const { return fineRows_ < featureRows(); }
    void refine(const FilmRun& film);
    bool isDue(const FilmRun& film, const RenderRequest& request) const;
    double secondsUntilDue(const RenderRequest& request) const; // at most; no less than a slice should take

    // One of a race; `reference`: to show its error against, may be null.
    void showOfRace(Picture picture, const image::Image* reference);
    // Drawn with `width` pixels in a row.
    void showPreview(Engine& engine, const scene::CameraDesc& camera, const RenderSettings& size, std::uint32_t width);
    const Preview& preview() const { return preview_; } // shown last; no pixels: none
    void discardPreview() { preview_ = {}; }

  private:
    using ViewPointer = std::shared_ptr<const ViewImage>;

    double interval(const RenderRequest& request) const;
    bool isFiltered() const; // what the view shows
    bool wantsDetails() const { return showsDenoiser(view_.mode); }
    void showDraftAround(std::span<const std::uint64_t> tileSamples, image::Image& radiance, Picture& picture);
    void denoise(const FilmRun& film, Haste haste, Picture& picture);
    void publish(const FilmRun& film, const FilmReference& reference, Picture picture);
    // The features that it shows are left in `features`; what pixels cost is none of them.
    ViewImage featureView(Engine& engine, std::uint32_t spp, AovImages& features) const;
    std::uint32_t featureRows() const; // of features_; none where they are not shown
    ViewPointer viewOf(const FilmRun& film, const Picture& picture, const FilmReference& reference,
                       const RenderSpeed& speed);
    void recordLatency();

    PublishedState& state_;
    PictureFilter filter_;
    PictureFilter::Pointer denoised_; // of the film, or none
    bool drawnBySoftware_;
    std::optional<Stopwatch> awaited_;
    ViewRequest view_;
    ViewPointer featureView_;    // of the film, for modes that samples do not change
    bool featureIsFull_ = false; // in the film's resolution
    AovImages features_;         // that it shows then
    std::uint32_t fineRows_ = 0; // of them, that have as many samples as in files
    std::uint32_t rowsAtATime_ = 1;
    image::Image draft_;
    bool isDraftDenoised_ = false;
    std::optional<double> rawEstimate_, denoisedError_; // that were told last, and of what
    struct Told {
        PictureFilter::Pointer denoised;
        std::shared_ptr<const image::Image> reference;
        bool operator==(const Told&) const = default;
    };
    Told told_;
    Preview preview_;
    Stopwatch sinceBegin_;
    Stopwatch sinceShown_;
    double showSeconds_ = 0;         // that the last picture took
    std::uint64_t shownSamples_ = 0; // of the film, in the last picture
};

// The preview of an image of that size, with `width` pixels in a row. Throws what the engine does.
Preview drawPreview(Engine& engine, const scene::CameraDesc& camera, const RenderSettings& size, std::uint32_t width);

// Of the plane through what a preview or the first hits show in a pixel, from their depth; none for the sky.
std::optional<double> focusDistance(const image::Image& depth, std::uint32_t x, std::uint32_t y, double verticalFov);

} // namespace rt::app
