// The session's thread: files that were asked for.
#include <exception>
#include <string>
#include <utility>
#include <vector>

#include "Common/App/Interactive/FilmFiles.h"
#include "Common/App/Interactive/SessionThread.h"
#include "Common/Core/Error.h"

namespace rt::app {

void SessionThread::writeWaiting() {
    const bool isComing = !isReady()       ? activity_ != Activity::Failed
                          : isPreviewing() ? previewIsStale_
                                           : isActive() && !film_.hasFirstSamples();
    if (isComing) return;
    for (const SaveRequest& save : std::exchange(waiting_, {})) write(save);
}

void SessionThread::write(const SaveRequest& request) {
    if (isRaceShown_) return writePicture(request, state_.copy().picture, state_);
    if (isPreviewing()) {
        const RenderSettings size = sizedSettings(request_, *loaded_.scene);
        const Preview& shown = film_.publisher.preview();
        const bool isOfThatSize = shown.picture.width == size.width && shown.picture.height == size.height;
        Picture picture;
        picture.isPreview = true;
        picture.radiance = std::make_shared<const image::Image>(
            isOfThatSize ? shown.picture : drawPreview(*engine_, camera_, size, size.width).picture);
        return writePicture(request, picture, state_);
    }
    if (!film_.hasSamples()) {
        state_.fail(std::make_exception_ptr(RenderError("nothing to save yet: the picture is being prepared")),
                    ErrorSource::Save);
        return;
    }
    for (const std::string& failure : writeFiles(request, StopReason::Interrupted))
        state_.fail(std::make_exception_ptr(RenderError(failure)), ErrorSource::Save);
}

// Of the film; returns what cannot be written, one line each.
std::vector<std::string> SessionThread::writeFiles(const SaveRequest& request, StopReason reason) {
    Options options = setup_.options;
    options.oneSidedLights = request_.oneSidedLights;
    options.timeLimit = request_.timeLimit;
    options.targetError = request_.targetError;
    options.policy = choice_.policy;
    return writeFilm(request, options, loaded_, *film_.run(), film_.reference, reason, state_);
}

// What the program was started to write, once: when the first render ends, or when the window closes before that.
void SessionThread::writeEnd(StopReason reason) {
    if (!atEnd_ || endIsWritten_) return;
    endIsWritten_ = true;
    // A film without samples is written, too: whoever waits for the files is told so by their notes and statistics.
    endFiles_.hasFilm = film_.run().has_value();
    endFiles_.failures = endFiles_.hasFilm ? writeFiles(*atEnd_, reason)
                                           : std::vector<std::string>{"nothing was rendered that could be written"};
    for (const std::string& failure : endFiles_.failures)
        state_.fail(std::make_exception_ptr(RenderError(failure)), ErrorSource::Save);
}

} // namespace rt::app
