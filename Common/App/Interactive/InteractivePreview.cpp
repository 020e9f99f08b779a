// The worker's side of InteractiveSession while ray tracing is off.
#include <algorithm>
#include <utility>

#include "Common/App/Interactive/Draft.h"
#include "Common/App/Interactive/InteractiveSession.h"
#include "Common/Core/Error.h"
#include "Common/Image/Display.h"
#include "Common/Image/ImageIo.h"

namespace rt::app {
namespace {

constexpr std::uint32_t kMostPreviewSide = 4096; // pixels that every device draws; larger images are enlarged

} // namespace

void InteractiveSession::switchPreview(bool on) {
    if (on == previewIsWanted_) return;
    previewIsWanted_ = on;
    if (on || !isReady()) return;
    preview_ = {};
    if (filmIsStale_) return setActivity(Activity::Rendering);
    publish();
}

void InteractiveSession::renderPreview() {
    previewIsStale_ = false;
    setStage("Drawing the preview of " + scene_->title);
    const RenderSettings settings = sizedSettings();
    const std::uint32_t largest = std::max(settings.width, settings.height);
    const double scale = std::min(1.0, static_cast<double>(kMostPreviewSide) / largest);
    const auto scaled = [scale](std::uint32_t side) { return std::max(1u, static_cast<std::uint32_t>(side * scale)); };
    preview_ = engine_->renderPreview(camera_, scaled(settings.width), scaled(settings.height));
    if (scale < 1) {
        preview_.picture = enlarge(preview_.picture, settings.width, settings.height);
        preview_.depth = enlarge(preview_.depth, settings.width, settings.height);
    }
    Picture picture;
    picture.image = picture.radiance = std::make_shared<image::Image>(preview_.picture);
    picture.isPreview = true;
    const EngineReport report = engine_->report();
    update([&](SessionState& state) {
        state.stage.clear();
        picture.serial = state.picture.serial + 1;
        state.picture = std::move(picture);
        state.report = report;
        if (filmIsStale_) {
            state.settings = settings;
            state.status = {};
        }
    });
    noteAnswer();
    writeWaiting();
}

// What is seen, and nothing that only a film has.
void InteractiveSession::writePreview(const SaveRequest& request) {
    for (const std::string& file : request.files) {
        try {
            if (previewIsStale_) throw RenderError("nothing to save yet: the preview is being drawn");
            const auto curve = static_cast<std::uint32_t>(request.tonemap);
            const bool isDisplay = image::isDisplayReferred(file);
            const image::ImageRows picture = preview_.picture;
            image::writeImage(file, isDisplay ? image::toDisplay(picture, request.exposure, curve) : picture);
            update([&](SessionState& state) {
                state.message = "Saved the preview as " + file;
                ++state.messageSerial;
            });
        } catch (...) {
            fail(std::current_exception(), false);
        }
    }
}

} // namespace rt::app
