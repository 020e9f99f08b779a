// The denoised pictures of a film that a window looks at: when one is made, and of which quality. Its time is none of
// sampling, and whatever is wanted next calls it off.
#pragma once
#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>

#include "Common/App/Interactive/PublishedState.h"
#include "Common/Render/FilmRun.h"
#include "Common/Render/PictureDenoiser.h"
#include "Common/Render/Stopwatch.h"

namespace rt::app {

enum class Haste {
    AtOnce,     // somebody waits for the picture
    Converging, // the film goes on after it
    AtRest      // there is nothing else to do
};

class PictureFilter {
  public:
    using Pointer = std::shared_ptr<const DenoisedPicture>;

    PictureFilter(PublishedState& state, const std::atomic<bool>& cancel) : state_(state), cancel_(cancel) {}

    void begin(Engine& engine); // a film
    void end();                 // before the engine begins something else
    void forget();              // before it goes, or gets another scene
    // Of a draft, whose film the engine holds; nothing calls it off, as a camera in motion would never show one.
    Pointer filterDraft(const FilmRun& draft);

    // The newest of the film, made now where one is due; null: there is none yet, or the film has no halves.
    Pointer update(const FilmRun& film, Haste haste, bool wantsDetails);
    const Pointer& last() const { return last_; }
    // Whether update() at rest would make a better one.
    bool canImprove(const FilmRun& film, bool wantsDetails) const;

    // Whether the last update() has made a final one, which is not to delay the pictures after it.
    bool hasMadeFinal() const { return hasMadeFinal_; }
    // That a live picture takes; learnt as it goes. None: there will be none.
    std::optional<double> liveSecondsPerPixel() const {
        return isQuick_ ? std::optional(liveSecondsPerPixel_) : std::nullopt;
    }

  private:
    bool hasWhatLiveNeeds(const FilmRun& film) const; // needs denoiser_
    bool canFilter(const FilmRun& film) const;        // whether it has what is needed, as far as is known
    bool isFinal() const { return last_ && last_->quality == DenoiseQuality::Final; }
    bool isLiveQuick(const FilmRun& film) const;
    bool isFinalDue(const FilmRun& film, Haste haste, bool wantsDetails) const;
    void make(const FilmRun& film, DenoiseQuality quality, bool wantsDetails, const std::atomic<bool>& cancel);

    PublishedState& state_;
    const std::atomic<bool>& cancel_;
    std::unique_ptr<PictureDenoiser> denoiser_;
    bool hasFailed_ = false; // with this engine and scene, which is said once
    bool isQuick_ = true;    // as the denoiser before says, as far as there was one
    Pointer last_;
    bool hasDetails_ = false;                     // of the last one
    std::uint64_t samples_ = 0;                   // of the film, in the last one
    std::optional<std::uint64_t> refusedSamples_; // of which none can be made
    bool hasMadeFinal_ = false;
    Stopwatch sinceBegin_, sinceFinal_;
    double liveSecondsPerPixel_ = 3e-7; // a cautious guess at first
};

} // namespace rt::app
