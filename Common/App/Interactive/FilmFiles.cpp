#include "Common/App/Interactive/FilmFiles.h"

#include <exception>

#include "Common/App/Interactive/CameraController.h"
#include "Common/App/Session/Outputs.h"
#include "Common/Core/Error.h"
#include "Common/Core/Hash.h"
#include "Common/Image/Display.h"
#include "Common/Image/ImageIo.h"
#include "Common/Render/FilmEstimate.h"
#include "Common/Render/RenderParams.h"

namespace rt::app {

std::vector<std::string> writeFilm(const SaveRequest& request, Options options, const LoadedScene& scene,
                                   const FilmRun& film, const FilmReference& reference, StopReason reason,
                                   PublishedState& state) {
    const Stopwatch watch;
    // No flag renders an edited scene again.
    options.scene = scene.request.source + (scene.request.edits > 0 ? " (edited)" : "");
    options.moment = scene.request.moment;
    options.shutter = scene.poses ? scene.request.shutter : scene::Shutter();
    options.settings = film.settings();
    options.outputs = request.files;
    options.aovs = request.aovs;
    options.denoisedOnly = request.what == SavedPicture::Denoised;
    if (request.what == SavedPicture::Both && !options.wants(Aov::Denoised)) options.aovs.push_back(Aov::Denoised);
    options.stats = request.stats;
    options.exposure = request.exposure;
    options.tonemap = request.tonemap;
    std::string lost;
    OutputResult outputs;
    try {
        const image::Film& kept = film.keptFilm(lost);
        outputs = writeOutputs(options, film.camera(), kept, film.engine());
        if (!options.stats.empty()) {
            Statistics statistics;
            statistics.stoppedBy = reason;
            statistics.seconds = {scene.seconds, film.seconds(), watch.seconds()};
            statistics.outputs = outputs.written;
            statistics.error = reference.compare(kept.resolve());
            statistics.window = state.windowFigures();
            writeText(options.stats, statistics.toJson(options, *scene.scene, film.report(), kept));
        }
    } catch (const std::exception& error) { // of an engine or a file, or want of memory
        outputs.failures.push_back(messageOf(error));
    }
    if (!lost.empty()) outputs.failures.insert(outputs.failures.begin(), lost);
    std::string saved;
    for (const std::string& file : outputs.written) saved += (saved.empty() ? "Saved " : ", ") + file;
    if (!saved.empty()) state.say(saved); // all of them at once: what is said is seen until something else is
    return outputs.failures;
}

void writePicture(const SaveRequest& request, const Picture& picture, PublishedState& state) {
    const std::string what = picture.isPreview ? "the preview" : "the race's picture";
    std::string saved;
    for (const std::string& file : request.files) {
        try {
            if (!picture.radiance || picture.radiance->data.empty())
                throw RenderError("nothing to save yet: " + what + " is being made");
            const auto curve = static_cast<std::uint32_t>(request.tonemap);
            const image::ImageRows rows = *picture.radiance;
            image::writeImage(file,
                              image::isDisplayReferred(file) ? image::toDisplay(rows, request.exposure, curve) : rows);
            saved += (saved.empty() ? "Saved " + what + " as " : ", ") + file;
        } catch (...) {
            state.fail(std::current_exception(), ErrorSource::Save);
        }
    }
    if (!saved.empty()) state.say(saved);
}

RunRecord makeRecord(const std::string& program, const LoadedScene& scene, const FilmRun& film,
                     const FilmReference& reference) {
    const EngineReport report = film.report();
    RunRecord record = recordOfWork(*scene.scene, scene.request.oneSidedLights, film.camera(), film.settings());
    record.time = utcNow();
    record.app = program;
    record.engine = report.engine;
    record.device = report.device;
    record.isSoftware = report.isSoftware;
    record.threads = report.threads;
    record.spp = film.engine().film().samplesPerPixel();
    record.loadSeconds = scene.seconds;
    record.buildSeconds = report.accelBuildSeconds;
    record.pipelineSeconds = report.pipelineSeconds;
    record.renderSeconds = film.seconds();
    if (film.seconds() > 0) {
        const double rays = static_cast<double>(report.rays.all());
        record.samplesPerSecond = static_cast<double>(film.status().samplesDone) / film.seconds();
        record.raysPerSecond = rays / film.seconds();
    }
    record.hasReference = !reference.curve().empty();
    if (record.hasReference) {
        record.relmse = reference.curve().back().relmse;
        record.referenceError = reference.error();
    } else if (const auto estimated = estimateRelMse(film.engine().film(), dependentSide(report.features))) {
        record.relmse = estimated->value;
    }
    for (const ErrorPoint& point : reference.curve()) record.curve.push_back({point.seconds, point.relmse});
    return record;
}

RunRecord recordOfWork(const scene::CompiledScene& scene, bool oneSidedLights, const scene::CameraDesc& camera,
                       const RenderSettings& settings) {
    RunRecord record;
    record.scene = scene.id;
    record.sceneHash = hexText(scene.hash);
    record.camera = CameraController::toText(camera);
    record.lightSampling = nameOf(kLightSamplings, settings.lightSampling);
    record.sampler = nameOf(kSamplers, settings.sampler);
    record.lightSelection = nameOf(kLightSelections, settings.lightSelection);
    record.sphereLight = nameOf(kSphereLights, settings.sphereLight);
    record.quadLight = nameOf(kFlatLights, settings.quadLight);
    record.triangleLight = nameOf(kFlatLights, settings.triangleLight);
    record.specularConnections = nameOf(kSpecularConnections, settings.specularConnections);
    record.edgeRays = nameOf(kEdgeRays, settings.edgeRays);
    record.pathReuse = nameOf(kPathReuse, settings.pathReuse);
    record.russianRoulette = nameOf(kOnOff, settings.russianRoulette);
    record.oneSidedLights = nameOf(kOnOff, oneSidedLights);
    record.adaptive = nameOf(kAdaptive, settings.adaptive);
    record.replicates = std::to_string(settings.replicates);
    record.width = settings.width;
    record.height = settings.height;
    record.maxDepth = settings.maxDepth;
    record.spp = settings.spp;
    return record;
}

} // namespace rt::app
