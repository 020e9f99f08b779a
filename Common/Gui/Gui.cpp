#include "Common/Gui/Gui.h"

#include <iterator>
#include <utility>

#include <glm/geometric.hpp>
#include <imgui.h>

#include "Common/App/Interactive/FilmFiles.h"
#include "Common/App/Session/SceneOutput.h"
#include "Common/Core/AtomicFile.h"
#include "Common/Core/Error.h"
#include "Common/Core/Paths.h"
#include "Common/Core/Printable.h"
#include "Common/Gui/Panels/ImageSize.h"
#include "Common/Gui/Panels/SavePaths.h"
#include "Common/Gui/Widgets.h"
#include "Common/Scene/Builtin/BuiltinScenes.h"
#include "Common/Scene/ModelFile.h"

namespace rt::gui {

void Gui::openScene(const std::string& source) {
    std::error_code none;
    const bool isFile = std::filesystem::exists(source, none);
    const std::string whole = isFile ? std::filesystem::absolute(source, none).string() : source;
    onceSaved(*this, [this, whole] { session.open(whole); });
}

void Gui::close() {
    onceSaved(*this, [this] {
        editing.isDiscarded = editor.isDirty(); // or the window would ask once more
        window.close();
    });
}

void Gui::stepScene(int step) {
    const auto scenes = scene::builtinScenes();
    const std::string id = state.source.substr(0, state.source.find(':'));
    const auto count = static_cast<int>(scenes.size());
    const auto at = std::find_if(scenes.begin(), scenes.end(), [&](const auto& scene) { return scene.id == id; });
    int index = at != scenes.end() ? static_cast<int>(at - scenes.begin()) + step : 0;
    index = (index + count) % count;
    openScene(std::string(scenes[static_cast<std::size_t>(index)].id));
}

void Gui::hold() {
    split = 0.5f;
    if (!pinned) return pinned.pin(state.picture, viewRequest.mode, pictureTitle(), workInView());
    pinned.clear();
    runs.clearSelection(); // nothing is compared any more
}

// A film that was stopped early is of the samples that it has.
std::optional<app::RunRecord> Gui::workInView() const {
    if (!state.scene || state.picture.isPreview || state.picture.isOfRace) return std::nullopt;
    app::RunRecord work =
        app::recordOfWork(*state.scene, settings.request.oneSidedLights, camera.camera(), state.settings);
    work.app = isGpu ? app::kGpuProgram : app::kCpuProgram;
    const bool hasEnded = state.activity == app::Activity::Stopped || state.activity == app::Activity::Finished;
    if (hasEnded && state.picture.spp > 0) work.spp = state.picture.spp;
    return work;
}

std::string Gui::whyNotOther() const {
    if (!state.scene) return "There is no scene yet";
    if (state.sceneEdits > 0) return "The scene has been edited here: save it and open the file first";
    if (state.picture.isPreview) return "Ray tracing is off here";
    if (state.poses) return "The shutter is open here: pictures of one instant are compared";
    if (!settings.request.accumulate) return "Frames of their own are no render to compare with";
    if (settings.request.settings.features) return "The features are forced by --features, which is for one program";
    return {};
}

void Gui::followOther() {
    using app::Activity;
    const bool hasEnded = state.activity == Activity::Finished || state.activity == Activity::Stopped;
    const bool rests = hasEnded && !areOthersBusy; // what is compared shares the device with nobody
    if (otherIsWanted && rests && state.stage.empty() && whyNotOther().empty()) {
        otherIsWanted = false;
        app::OtherJob job;
        job.program = isGpu ? app::kCpuProgram : app::kGpuProgram;
        job.scene = {state.source, settings.request.oneSidedLights, "", assetsBelow, state.moment};
        job.compiled = state.scene;
        job.camera = camera.camera();
        job.settings = state.settings;
        // As many as this film has, where it ended before all that were asked for.
        if (state.picture.spp > 0 && !state.status.finished)
            job.settings.spp = static_cast<std::uint32_t>(state.picture.spp);
        job.settings.replicates = std::min(job.settings.replicates, job.settings.spp);
        if (state.referenceFits) {
            job.reference = state.referenceImage;
            job.referenceError = state.referenceError;
        }
        other.start(job);
    }
    const app::OtherState done = other.state();
    if (done.serial == otherSerial) return;
    otherSerial = done.serial;
    const std::string title = (isGpu ? "CPU, " : "GPU, ") + std::to_string(done.record.spp) + " spp";
    pinned.pin(done.image, title, done.record);
    split = 0.5f;
    say(title + " in " + shortDuration(done.record.renderSeconds));
}

void Gui::cancelOther() {
    otherIsWanted = false;
    other.cancel();
}

void Gui::frameAll() {
    if (!state.scene) return;
    const glm::dvec3 &lower = state.scene->lower, &upper = state.scene->upper;
    const double aspect = static_cast<double>(state.settings.width) / std::max(1u, state.settings.height);
    camera.frame(0.5 * (lower + upper), 0.5 * glm::length(upper - lower), aspect);
}

void Gui::exportScene() {
    if (state.scene) browse(BrowseFor::Export);
}

// With what has been edited; a scene file is what is edited from then on. Else as --export-scene does, which reads the
// scene once more: what is rendered is no text any more.
void Gui::exportTo(const std::string& file) {
    if (!app::isSceneOutput(file)) return fail(file + ": must be " + app::kSceneOutputs, app::ErrorSource::Save);
    if (editor.document() == nullptr) return exporting.start(state.source, state.moment, assetsBelow, file);
    if (!scene::isGltfFile(file)) return editor.save(file);
    exporting.start(editor.document()->scene(), state.source, assetsBelow, file);
}

void Gui::followExport() {
    try {
        const auto result = exporting.takeResult();
        if (!result) return;
        const std::vector<std::string>& notices = result->notices;
        const std::string rest = notices.size() > 1 ? ", and " + std::to_string(notices.size() - 1) + " more" : "";
        say("Saved " + result->file + (notices.empty() ? "" : "; " + notices.front() + rest));
    } catch (const std::exception& error) {
        fail(messageOf(error), app::ErrorSource::Save);
    }
}

void Gui::copyPose() {
    window.setClipboard(app::CameraController::toText(camera.camera()));
    say("Pose copied");
}

void Gui::pastePose() {
    if (const auto pose = app::CameraController::fromText(window.clipboard(), camera.camera())) {
        camera.set(*pose);
    } else {
        fail("The clipboard holds no camera pose", app::ErrorSource::Camera);
    }
}

void Gui::toggleComparison() {
    settings.showComparison = !settings.showComparison;
    if (settings.showComparison) settings.showRace = false;
}

void Gui::toggleRace() {
    settings.showRace = !settings.showRace;
    if (settings.showRace) settings.showComparison = false;
}

void Gui::saveText(const std::filesystem::path& file, const std::string& text) {
    try {
        AtomicFile target(file);
        target.stream() << text;
        target.commit();
        say("Saved " + file.string());
    } catch (const Error& error) {
        fail(error.what(), app::ErrorSource::Save);
    }
}

// Off, rays, time where that is known, off.
void Gui::toggleHeatMap() {
    if (!state.canShowCost) return;
    const bool isOn = viewRequest.mode == app::ViewMode::Heat;
    const bool hasNext = isOn && viewRequest.cost == app::Cost::Rays && state.canShowTime;
    viewRequest.mode = isOn && !hasNext ? app::ViewMode::Picture : app::ViewMode::Heat;
    viewRequest.cost = hasNext ? app::Cost::Time : app::Cost::Rays;
}

app::SavedPicture Gui::savedPicture() const {
    using app::SaveChoice;
    using app::SavedPicture;
    const bool hasHalves = !state.picture.isPreview && state.settings.replicates % 2 == 0;
    switch (settings.saveChoice) {
        case SaveChoice::Seen:
            return state.picture.isDenoised ? SavedPicture::Denoised : SavedPicture::Raw;
        case SaveChoice::Denoised:
            return hasHalves ? SavedPicture::Denoised : SavedPicture::Raw;
        case SaveChoice::Both:
            return hasHalves ? SavedPicture::Both : SavedPicture::Raw;
        case SaveChoice::Raw:
            break;
    }
    return SavedPicture::Raw;
}

void Gui::toggleStatistics() {
    bool& isOpen = settings.openPanels["statistics"];
    settings.showStatistics = !(settings.showPanels && settings.showStatistics && isOpen);
    if (settings.showStatistics) {
        settings.showPanels = isOpen = true;
        revealPanel = "statistics";
    }
}

void Gui::stepViewports() {
    const std::size_t now = viewportCount();
    wishViewports(*this, now == 1 ? 2 : now == 2 ? 4 : 1);
}

void Gui::setRayTracing(bool on) {
    settings.rayTracing = on || !state.canPreview;
}

void Gui::scaleInterface(float change) {
    settings.uiScale = std::clamp(settings.uiScale + change, app::kMinUiScale, app::kMaxUiScale);
}

std::string Gui::pictureTitle() const {
    if (state.picture.isPreview) return "preview";
    if (state.picture.isOfRace && state.race)
        return state.race->lanes[state.race->shown].name + ", " + std::to_string(state.picture.spp) + " spp";
    std::string title = (isGpu ? "GPU, " : "CPU, ") + std::to_string(state.picture.spp) + " spp";
    const bool isOfPicture = !state.picture.isDisplay || viewRequest.mode == app::ViewMode::Error;
    if (state.picture.isDenoised && isOfPicture) title += ", denoised";
    if (viewRequest.mode == app::ViewMode::HalfA) title += ", half A";
    if (viewRequest.mode == app::ViewMode::HalfB) title += ", half B";
    return title;
}

void Gui::browse(BrowseFor what) {
    namespace fs = std::filesystem;
    browseFor = what;
    showScenes = false; // one list to choose from at a time
    const auto folderOf = [](const std::string& file) { return fs::path(file).parent_path(); };
    FileBrowser::Request request;
    std::error_code none;
    switch (what) {
        case BrowseFor::Scene:
        case BrowseFor::Model:
            request = {what == BrowseFor::Scene ? "Open a scene" : "Add a model",
                       what == BrowseFor::Scene ? "Open" : "Add",
                       {".json", ".obj", ".gltf", ".glb", ".pbrt", ".gz"},
                       {},
                       ""};
            if (fs::is_regular_file(state.source, none)) {
                request.folder = folderOf(state.source);
            } else if (!settings.recent.empty() && fs::is_regular_file(settings.recent.front(), none)) {
                request.folder = folderOf(settings.recent.front());
            } else if (const auto assets = assetFolders(); !assets.empty()) {
                request.folder = assets.front() / "examples";
            }
            break;
        case BrowseFor::Image:
            request = {"Choose an image", "Choose", {std::begin(kImageKinds), std::end(kImageKinds)}, {}, ""};
            break;
        case BrowseFor::Reference:
            request = {"Load a reference", "Load", {".exr", ".hdr", ".pfm"}, saveFolder(settings.saveFolder), ""};
            break;
        case BrowseFor::Picture:
            if (!state.scene) return;
            request = {"Save the picture",
                       "Save",
                       {".png", ".exr", ".hdr", ".pfm"},
                       saveFolder(settings.saveFolder),
                       fs::path(savePaths(settings.saveFolder, state, savedPicture()).front()).filename().string(),
                       true};
            break;
        case BrowseFor::Export:
            request = {"Export the scene", "Export", {".json", ".glb", ".gltf"}, saveFolder(settings.saveFolder),
                       "scene.json",       true};
            break;
        case BrowseFor::SaveScene:
            request = {"Save the scene", "Save", {".json"}, saveFolder(settings.saveFolder), "scene.json", true};
            break;
        case BrowseFor::OpenMaterial:
            request = {"Open materials", "Open", {".mtlx"}, {}, ""};
            break;
        case BrowseFor::SaveMaterial:
            request = {"Save the material", "Save", {".mtlx"}, saveFolder(settings.saveFolder), "material.mtlx", true};
            break;
    }
    browser.open(std::move(request));
}

void Gui::take(const std::filesystem::path& file) {
    switch (browseFor) {
        case BrowseFor::Scene:
            return openScene(file.string());
        case BrowseFor::Model:
            return addModel(*this, file.string());
        case BrowseFor::Image:
            if (editor.document() != nullptr) std::exchange(added.takeImage, {})(*this, file.string());
            return;
        case BrowseFor::Reference:
            return session.loadReference(file.string());
        case BrowseFor::Picture:
            saveAs = file.string();
            if (std::error_code none; std::filesystem::is_directory(file.parent_path(), none))
                settings.saveFolder = file.parent_path().string();
            return;
        case BrowseFor::Export:
        case BrowseFor::SaveScene:
            return exportTo(file.string());
        case BrowseFor::OpenMaterial:
            return openMaterials(*this, file.string());
        case BrowseFor::SaveMaterial:
            saveMaterial(*this, file.string());
    }
}

void Gui::say(const std::string& text, bool isError) {
    if (isError) return fail(text, app::ErrorSource::Other);
    message = printable(text); // names of files, too
    messageTime = ImGui::GetTime();
}

void Gui::fail(const std::string& text, app::ErrorSource source) {
    errors.add(printable(text), source);
}

} // namespace rt::gui
