// The film that a window looks at: first a draft, or a pass over all pixels, then slices; another as soon as one is
// wanted.
#pragma once
#include <cstdint>
#include <optional>

#include "Common/App/Interactive/FilmPlan.h"
#include "Common/App/Interactive/FilmReference.h"
#include "Common/App/Interactive/Mailbox.h"
#include "Common/App/Interactive/PicturePublisher.h"
#include "Common/App/Interactive/PublishedState.h"
#include "Common/Render/FilmRun.h"

namespace rt::app {

// What is rendered, where and how.
struct FilmSubject {
    Engine& engine; // has the scene
    const scene::CompiledScene& scene;
    const scene::CameraDesc& camera;
    const RenderRequest& request;
};

// What a film of these settings has in common with its reference.
ReferenceKey keyOf(const FilmSubject& subject, const RenderSettings& film);

class SessionFilm {
  public:
    SessionFilm(const SessionSetup& setup, const Mailbox& mailbox, PublishedState& state);

    // Another film is wanted; the one there is can still be written.
    void change(); // of something else: what was to be the reference is not any more
    void beginAnew() { isStale_ = true; }
    void beginNext(); // with the next seed
    // The film goes on with another number of samples or other budgets, from the samples that it has. False: what is
    // asked for is another film.
    bool goOn(const FilmSubject& subject);
    void discard(); // which the engine does not hold any more

    bool isStale() const { return isStale_; } // another is wanted, or there is none
    bool hasSamples() const { return run_ && run_->status().samplesDone > 0; }
    bool isFinished() const { return run_ && run_->status().finished; } // it has all its samples
    bool hasFirstSamples() const;                                       // of all pixels, and is not stale
    const std::optional<FilmRun>& run() const { return run_; }
    bool hasHalves() const; // for a denoiser, or cannot have them; a stale one will have what is wanted

    // A film is not begun where its draft has been seen and the camera moves on; this does it.
    void beginPostponed(const FilmSubject& subject);
    // A little more of the film, begun where it is stale. Returns what has ended it, if anything has.
    std::optional<StopReason> slice(const FilmSubject& subject);
    void show(Haste haste = Haste::AtOnce); // unless it is stale
    void showIfDue(const RenderRequest& request);
    // What is shown is not what the denoiser makes of it at rest; filter() changes that, or is called off.
    bool isFiltering() const { return !isStale_ && publisher.isFiltering(*run_); }
    void filter() {
        if (isFiltering()) show(Haste::AtRest);
    }
    bool isRefining() const { return !isStale_ && publisher.isRefining(); } // what is shown
    void refine();

    // Of the view that the present film has; `how` it was had.
    void setReference(const image::Film& film, const std::string& how);
    void publishReference(const std::string& name);

    FilmReference reference;
    PicturePublisher publisher;

  private:
    RenderSettings settingsFor(const FilmSubject& subject) const;
    void start(const FilmSubject& subject);
    void renderDraft(const FilmSubject& subject, const RenderSettings& settings);
    void renderFirst(FilmRun& run, double sliceSeconds, double patience);
    void begin(const FilmSubject& subject, RenderSettings settings);
    void findReference();

    const SessionSetup& setup_;
    const Mailbox& mailbox_;
    PublishedState& state_;
    std::optional<FilmRun> run_;              // of the film that the engine holds
    bool isStale_ = true;                     // or there is none
    std::uint32_t round_ = 0;                 // films since the last change
    std::uint32_t drafts_ = 0;                // of all films
    std::optional<RenderSettings> postponed_; // not begun, since the camera moved on when its draft was shown
    RenderSpeed speed_;
};

} // namespace rt::app
