#include "Common/Bench/Live.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <optional>
#include <utility>

#include <glm/glm.hpp>

#include "Common/App/Session/SceneSource.h"
#include "Common/Bench/Cells.h"
#include "Common/Image/ErrorAnalysis.h"
#include "Common/Image/Summary.h"
#include "Common/Render/FilmRun.h"
#include "Common/Render/PictureDenoiser.h"
#include "Common/Shared/Base/Types.h"

namespace rt::bench {
namespace {

using image::Image;

// A frame with its pictures, until there is a reference for all of its camera.
struct Shown {
    LiveFrame figures;
    Image raw, live; // without pixels: there is none
};

// Rodrigues' formula.
glm::dvec3 turned(glm::dvec3 v, glm::dvec3 axis, double angle) {
    return v * std::cos(angle) + glm::cross(axis, v) * std::sin(angle) +
           axis * glm::dot(axis, v) * (1 - std::cos(angle));
}

class LiveRun {
  public:
    LiveRun(Engines& engines, ReferenceStore& references, const LiveRequest& request, const std::atomic<bool>& stop,
            const std::function<void(const std::string&)>& say)
        : references_(references), request_(request), stop_(stop), say_(say) {
        config_.scene = request.scene;
        config_.engine = request.engine;
        scene_ = app::compile(app::loadScene(request.scene), true, true);
        config_.settings.width = request.width;
        config_.settings.height =
            std::max(1u, static_cast<std::uint32_t>(std::lround(request.width / scene_->defaults.aspect)));
        engine_ = engines.prepare(config_, scene_, stop);
    }

    std::vector<LiveFrame> run() {
        std::vector<Shown> shown;
        if (engine_ == nullptr) return {};
        for (const std::uint32_t spp : request_.spp) {
            if (!engine_->setScene(scene_, &stop_)) break; // which forgets the pictures before, of another number
            for (std::uint32_t frame = 0; frame < request_.frames + request_.framesAfter && !stop_; ++frame)
                if (auto picture = show(frame, spp)) shown.push_back(std::move(*picture));
        }
        compare(shown);
        std::vector<LiveFrame> frames;
        frames.reserve(shown.size());
        for (const Shown& one : shown) frames.push_back(one.figures);
        return frames;
    }

  private:
    std::optional<Shown> show(std::uint32_t frame, std::uint32_t spp) {
        app::RenderSettings settings = config_.settings;
        settings.spp = spp;
        settings.seed = frame;
        settings.replicates = std::min(spp, 2u); // the halves that the filter of the processor needs
        app::FilmRun film(*engine_, cameraOf(frame), settings);
        if (film.untilStopped(stop_) == app::StopReason::Interrupted) return std::nullopt;
        Shown shown;
        shown.figures.frame = frame;
        shown.figures.spp = spp;
        shown.figures.seconds = film.seconds();
        shown.raw = engine_->film().resolve();
        if (auto live = engine_->makeDenoiser()->denoise({app::DenoiseQuality::Live, false, 1}, stop_)) { // as windows
            shown.live = std::move(live->images.picture);
            shown.figures.secondsFilter = live->seconds;
        }
        return shown;
    }

    scene::CameraDesc cameraOf(std::uint32_t frame) const { return cameraOfFrame(scene_->camera, request_, frame); }

    // With the reference of each camera of the path.
    void compare(std::vector<Shown>& shown) {
        for (std::uint32_t place = 0; place < request_.frames && !stop_; ++place) {
            std::vector<Shown*> own;
            std::vector<const Image*> images;
            for (Shown& one : shown)
                if (one.figures.frame % request_.frames == place) {
                    own.push_back(&one);
                    for (const Image* image : {&one.raw, &one.live})
                        if (!image->data.empty()) images.push_back(image);
                }
            const scene::CameraDesc camera = cameraOf(place);
            ReferenceRequest wanted;
            wanted.scene = scene_.get();
            wanted.camera = &camera;
            wanted.width = config_.settings.width;
            wanted.height = config_.settings.height;
            wanted.maxDepth = config_.settings.maxDepth;
            wanted.maxSeconds = request_.referenceSeconds;
            const auto made = references_.provide(wanted, images, *engine_, stop_);
            if (say_) say_("reference of frame " + std::to_string(place));
            if (!made) continue;
            for (Shown* one : own) {
                analyse(one->raw, made->reference, one->figures.relmse, one->figures.flip);
                analyse(one->live, made->reference, one->figures.relmseLive, one->figures.flipLive);
            }
        }
    }

    static void analyse(const Image& picture, const image::Reference& reference, Figure& relmse, Figure& flip) {
        if (picture.data.empty()) return;
        const image::ErrorAnalysis error = image::analyseError(picture, reference, shared::kReuseSide);
        relmse = error.relmse;
        flip = error.flip;
    }

    ReferenceStore& references_;
    const LiveRequest& request_;
    const std::atomic<bool>& stop_;
    const std::function<void(const std::string&)>& say_;
    Config config_;
    std::shared_ptr<const scene::CompiledScene> scene_;
    app::Engine* engine_ = nullptr;
};

Figure medianOf(const std::vector<LiveFrame>& frames, std::uint32_t spp, FigureOf<LiveFrame> figure) {
    std::vector<double> values;
    for (const LiveFrame& frame : frames)
        if (frame.spp == spp && frame.*figure) values.push_back(*(frame.*figure));
    return values.empty() ? std::nullopt : Figure(image::median(std::move(values)));
}

std::string milliseconds(const Figure& seconds) {
    return threeDigits(seconds ? Figure(1000 * *seconds) : std::nullopt);
}

Table summary(const LiveRequest& request, const std::vector<LiveFrame>& frames) {
    Table table{{"spp", "ms, samples", "ms, filter", "relMSE", "live", "FLIP", "live", "ghosting"}, {}};
    for (const std::uint32_t spp : request.spp) {
        std::vector<double> seconds;
        for (const LiveFrame& frame : frames)
            if (frame.spp == spp) seconds.push_back(frame.seconds);
        if (seconds.empty()) continue;
        const auto median = [&](FigureOf<LiveFrame> figure) { return medianOf(frames, spp, figure); };
        table.rows.push_back({std::to_string(spp), milliseconds(image::median(seconds)),
                              milliseconds(median(&LiveFrame::secondsFilter)), threeDigits(median(&LiveFrame::relmse)),
                              threeDigits(median(&LiveFrame::relmseLive)), threeDigits(median(&LiveFrame::flip)),
                              threeDigits(median(&LiveFrame::flipLive)), threeDigits(ghosting(request, frames, spp))});
    }
    return table;
}

} // namespace

scene::CameraDesc cameraOfFrame(const scene::CameraDesc& first, const LiveRequest& request, std::uint32_t frame) {
    scene::CameraDesc camera = first;
    const double angle = request.degrees * (frame % request.frames) * std::numbers::pi / 180;
    camera.lookFrom = first.lookAt + turned(first.lookFrom - first.lookAt, glm::normalize(first.up), angle);
    return camera;
}

std::vector<LiveFrame> measureLive(Engines& engines, ReferenceStore& references, const LiveRequest& request,
                                   const std::atomic<bool>& stop, const std::function<void(const std::string&)>& say) {
    return LiveRun(engines, references, request, stop, say).run();
}

Figure ghosting(const LiveRequest& request, const std::vector<LiveFrame>& frames, std::uint32_t spp) {
    Figure before, after;
    for (const LiveFrame& frame : frames) {
        if (frame.spp != spp) continue;
        if (frame.frame == 0) before = frame.relmseLive;
        if (frame.frame == request.frames) after = frame.relmseLive;
    }
    return before && after && *before > 0 ? Figure(*after / *before) : std::nullopt;
}

Document describeLive(const LiveRequest& request, const std::vector<LiveFrame>& frames) {
    Table all{{"spp", "frame", "ms, samples", "ms, filter", "relMSE", "live", "FLIP", "live"}, {}};
    for (const LiveFrame& frame : frames)
        all.rows.push_back({std::to_string(frame.spp),
                            std::to_string(frame.frame) + (frame.frame == request.frames ? ", cut" : ""),
                            milliseconds(frame.seconds), milliseconds(frame.secondsFilter), threeDigits(frame.relmse),
                            threeDigits(frame.relmseLive), threeDigits(frame.flip), threeDigits(frame.flipLive)});
    return {Heading{2, request.scene + ", " + request.engine + ", width " + std::to_string(request.width) +
                           ": a camera that moves by " + threeDigits(request.degrees) + "° a frame"},
            Paragraph{"Medians over the frames. Ghosting: relMSE of the live picture right after a cut, over that of "
                      "the same camera before which there was no picture."},
            summary(request, frames), all};
}

} // namespace rt::bench
