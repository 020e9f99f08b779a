// The worker's side of InteractiveSession: what is written of a film, and what it is compared with.
#include <algorithm>
#include <utility>

#include "Common/App/Interactive/InteractiveSession.h"
#include "Common/App/Session/Outputs.h"
#include "Common/App/Session/Reference.h"
#include "Common/Core/Error.h"
#include "Common/Image/Metrics.h"

namespace rt::app {

// ---- files -----------------------------------------------------------------------------------------------------------

// What the film's statistics and files are told by: the program's options with what the window has changed since.
Options InteractiveSession::optionsOf(const SaveRequest& request) const {
    Options options = setup_.options;
    options.scene = source_;
    options.settings = settings_;
    options.oneSidedLights = request_.oneSidedLights;
    options.timeLimit = request_.timeLimit;
    options.policy = choice_.policy;
    options.outputs = request.files;
    options.aovs = request.aovs;
    options.stats = request.stats;
    options.exposure = request.exposure;
    options.tonemap = request.tonemap;
    return options;
}

bool InteractiveSession::hasFirstSamples() const {
    const std::uint64_t pixels = std::uint64_t{settings_.width} * settings_.height;
    return !filmIsStale_ && status_.samplesDone >= pixels * std::min(settings_.spp, image::Film::kBlock);
}

void InteractiveSession::writeWaiting() {
    const bool isComing = !isReady()       ? activity_ != Activity::Failed
                          : isPreviewing() ? previewIsStale_
                                           : isActive() && !hasFirstSamples();
    if (isComing) return;
    for (const SaveRequest& save : std::exchange(waiting_, {})) write(save);
}

void InteractiveSession::write(const SaveRequest& request) {
    if (isPreviewing()) return writePreview(request);
    for (const std::string& failure : writeFiles(request, StopReason::Interrupted))
        fail(std::make_exception_ptr(RenderError(failure)), false);
}

// Everything that can be written is; returns what cannot, one line each.
std::vector<std::string> InteractiveSession::writeFiles(const SaveRequest& request, StopReason reason) {
    if (!engine_ || !scene_ || filmIsStale_) return {"nothing to save yet: the picture is being prepared"};
    const Stopwatch watch;
    const Options options = optionsOf(request);
    OutputResult outputs;
    try {
        const image::Film& film = engine_->film();
        outputs = writeOutputs(options, camera_, film, *engine_);
        if (!options.stats.empty()) {
            Statistics statistics;
            statistics.stoppedBy = reason;
            statistics.seconds = {loadSeconds_, renderSeconds_, watch.seconds()};
            statistics.outputs = outputs.written;
            if (referenceFits()) statistics.error = image::compare(film.resolve(), *reference_);
            statistics.window = windowFigures();
            writeText(options.stats, statistics.toJson(options, *scene_, engine_->report(), film));
        }
    } catch (const Error& error) {
        outputs.failures.emplace_back(error.what());
    }
    for (const std::string& file : outputs.written) {
        update([&](SessionState& state) {
            state.message = "Saved " + file;
            ++state.messageSerial;
        });
    }
    return outputs.failures;
}

// What the program was started to write, once: when the first render ends, or when the window closes before that.
void InteractiveSession::writeEnd(StopReason reason) {
    std::optional<SaveRequest> request;
    {
        const std::scoped_lock lock(mutex_);
        if (endIsWritten_) return;
        request = atEnd_;
        endIsWritten_ = request.has_value();
    }
    if (!request) return;
    const bool isEmpty = !engine_ || !scene_ || filmIsStale_;
    endFailures_ =
        isEmpty ? std::vector<std::string>{"nothing was rendered that could be written"} : writeFiles(*request, reason);
    for (const std::string& failure : endFailures_) fail(std::make_exception_ptr(RenderError(failure)), false);
}

WindowFigures InteractiveSession::windowFigures() const {
    const std::scoped_lock lock(mutex_);
    WindowFigures figures = window_;
    figures.slowestAnswer = state_.slowestAnswer;
    return figures;
}

// ---- the reference ---------------------------------------------------------------------------------------------------

InteractiveSession::FilmKey InteractiveSession::filmKey() const {
    return {scene_->hash, camera_, settings_.width, settings_.height, settings_.maxDepth};
}

bool InteractiveSession::referenceFits() const {
    return reference_ && !referenceSpp_ && referenceKey_ == filmKey();
}

void InteractiveSession::adoptReference(image::Image image, const std::string& name) {
    reference_ = std::make_shared<image::Image>(std::move(image));
    referenceKey_ = filmKey();
    referenceName_ = name;
    curve_.clear();
    update([&](SessionState& state) {
        state.reference = name;
        state.referenceFits = referenceFits();
    });
}

void InteractiveSession::readReferenceFile(const std::string& file) {
    try {
        if (!scene_ || filmIsStale_) throw InputError(file + ": nothing to compare with yet");
        adoptReference(readReference(file, settings_.width, settings_.height), file);
        publish();
    } catch (...) {
        fail(std::current_exception(), false);
    }
}

// The error so far, at times that grow by a tenth.
void InteractiveSession::followError(const image::Image& picture, bool last) {
    if (!referenceFits()) return;
    if (!curve_.empty() && !last && renderSeconds_ < 1.1 * curve_.back().seconds) return;
    if (!curve_.empty() && renderSeconds_ <= curve_.back().seconds) return;
    const double pixels = static_cast<double>(settings_.width) * settings_.height;
    const double samples = static_cast<double>(status_.samplesDone) / pixels;
    curve_.push_back({renderSeconds_, samples, image::compare(picture, *reference_).relmse});
}

} // namespace rt::app
