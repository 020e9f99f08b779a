#include "Common/Gui/App.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <deque>
#include <filesystem>
#include <optional>

#include <GLFW/glfw3.h>

#include "Common/App/Platform.h"
#include "Common/App/Stopwatch.h"
#include "Common/Core/Log.h"
#include "Common/Gui/ImGuiLayer.h"
#include "Common/Gui/Panels.h"
#include "Common/Gui/Presenter.h"
#include "Common/Gui/SavePaths.h"
#include "Common/Gui/Theme.h"
#include "Common/Gui/Widgets.h"
#include "Common/Scene/BuiltinScenes.h"

namespace rt::gui {

void Gui::openScene(const std::string& source) {
    const std::filesystem::path path(source);
    std::error_code none;
    if (std::filesystem::exists(path, none)) {
        const std::string absolute = std::filesystem::absolute(path, none).string();
        settings.addRecent(absolute);
        session.open(absolute);
        return;
    }
    session.open(source);
}

void Gui::hold() {
    held = held ? nullptr : state.picture.image;
    heldIsDisplay = state.picture.isDisplay;
    split = 0.5f;
}

void Gui::say(const std::string& text, bool isError) {
    toast = text;
    toastTime = ImGui::GetTime();
    toastIsError = isError;
}

namespace {

constexpr double kIdleSeconds = 0.25; // between two looks when nothing happens
constexpr double kAwakeSeconds = 0.4; // of quick frames after the last input, for what moves by itself
constexpr double kStallSeconds = 10;  // that the longest turn is looked for in
constexpr double kToastSeconds = 5;
constexpr double kRadiansPerPixel = 0.004;
constexpr double kFast = 5, kSlow = 0.2;

std::filesystem::path settingsFile(const std::string& program) {
    const std::filesystem::path folder = app::userConfigDirectory();
    return folder.empty() ? folder : folder / (program + ".json");
}
std::filesystem::path layoutFile(const std::string& program) {
    const std::filesystem::path folder = app::userConfigDirectory();
    return folder.empty() ? folder : folder / (program + ".layout.ini");
}

app::GuiSettings startSettings(const app::Options& options) {
    app::GuiSettings settings = app::loadGuiSettings(settingsFile(options.program));
    override(settings, options);
    return settings;
}

WindowPlace placeOf(const app::GuiSettings& settings) {
    return {settings.windowX,      settings.windowY,      settings.windowWidth,
            settings.windowHeight, settings.windowPlaced, settings.windowMaximised};
}

app::InteractiveSession::Setup sessionSetup(const app::Options& options, const WindowProgram& program,
                                            const app::GuiSettings& settings, app::RunHistory& history) {
    app::InteractiveSession::Setup setup;
    setup.program = options.program;
    setup.makeEngine = program.makeEngine;
    setup.engine = settings.engine;
    setup.request = settings.request;
    setup.scene = {settings.scene, settings.request.oneSidedLights};
    setup.sliceSeconds = options.program == app::kGpuProgram ? 0.008 : 0.03;
    setup.history = &history;
    setup.onChange = [] { Window::wake(); };
    return setup;
}

class App {
  public:
    App(const app::Options& options, const WindowProgram& program)
        : options_(options),
          settings_(startSettings(options)),
          stored_(settings_),
          window_(options.program, placeOf(settings_)),
          device_(window_, options.validation, options.device),
          presenter_(device_, window_),
          imgui_(window_, device_, presenter_.renderPass(), presenter_.imageCount(), layoutFile(options.program)),
          history_(app::RunHistory::userFile()),
          sentRequest_(settings_.request),
          sentEngine_(settings_.engine),
          session_(sessionSetup(options, program, settings_, history_)),
          gui_{session_, settings_, camera_, history_, window_, options.program == app::kGpuProgram, program.devices} {
        window_.onDrop([this](const std::vector<std::string>& files) { dropped_ = files; });
    }

    ExitCode run() {
        while (!window_.shouldClose()) {
            window_.waitEvents(awake() ? 0 : kIdleSeconds);
            turn();
        }
        window_.hide(); // a scene that is being loaded may take a while to give up
        remember();
        return ExitCode::Done;
    }
    std::uint64_t validationMessages() const { return device_.validationMessages(); }

  private:
    bool awake();
    void turn();
    void takeState();
    void handleKey(const Window::KeyPress& press);
    void stepScene(int step);
    void handlePointer(const Rect& area);
    std::optional<std::array<std::uint32_t, 2>> pixelUnderPointer(const Rect& area) const;
    void inspect(const std::optional<std::array<std::uint32_t, 2>>& pixel);
    void fly(double seconds);
    void sendChanges();
    void save();
    void drawInterface();
    void drawOverlay(const Rect& area);
    PresentConstants placePicture(const Rect& area) const;
    float fitScale(const Rect& area) const;
    void measure(double busySeconds);
    void remember();

    app::Options options_;
    app::GuiSettings settings_;
    app::GuiSettings stored_; // as in the file
    Window window_;
    GraphicsDevice device_;
    Presenter presenter_;
    ImGuiLayer imgui_;
    app::RunHistory history_;
    app::CameraController camera_;
    app::RenderRequest sentRequest_;
    app::EngineChoice sentEngine_;
    scene::CameraDesc sentCamera_;
    app::ViewRequest sentView_;
    const image::Image* shownHeld_ = nullptr;
    app::InteractiveSession session_;
    Gui gui_;

    Rect area_; // of the picture, in the window's units
    std::uint64_t sceneSerial_ = 0, pictureSerial_ = 0, errorSerial_ = 0, messageSerial_ = 0, focusSerial_ = 0;
    std::vector<std::string> dropped_;
    app::Stopwatch sinceInput_, sinceFrame_, sinceStored_;
    std::deque<std::pair<double, double>> turns_; // when it ended, and how long it took; seconds
    app::Stopwatch clock_;
    bool moving_ = false; // the camera flies
};

// Whether the next frame is to come at once.
bool App::awake() {
    if (window_.takeInput()) sinceInput_ = {};
    return moving_ || sinceInput_.seconds() < kAwakeSeconds;
}

void App::turn() {
    const app::Stopwatch busy;
    takeState();
    if (!dropped_.empty()) {
        gui_.openScene(dropped_.front());
        dropped_.clear();
    }
    const auto [width, height] = window_.framebufferSize();
    if (width <= 0 || height <= 0) { // minimised: nothing to draw, and nobody to draw for
        (void)window_.takeKeys();
        moving_ = false;
        sinceInput_ = {};
        window_.waitEvents(kIdleSeconds);
        return;
    }
    const double seconds = std::min(sinceFrame_.seconds(), 0.1);
    sinceFrame_ = {};
    imgui_.setStyle({settings_.colorMode, settings_.uiScale * window_.contentScale(), settings_.font});
    const std::vector<Window::KeyPress> presses = window_.takeKeys();
    std::vector<int> keys;
    for (const Window::KeyPress& press : presses) keys.push_back(press.key);
    imgui_.beginFrame(keys);
    for (const Window::KeyPress& press : presses) handleKey(press);
    drawInterface();
    fly(seconds);
    imgui_.endFrame();
    sendChanges();
    if (gui_.saveRequested) save();
    presenter_.present(placePicture(area_), [this](VkCommandBuffer commands) { imgui_.draw(commands); });
    measure(busy.seconds());
    if (settings_ != stored_ && sinceStored_.seconds() > 2) remember();
}

void App::takeState() {
    gui_.state = session_.state();
    const app::SessionState& state = gui_.state;
    if (state.fatal) std::rethrow_exception(state.fatal);
    if (state.sceneSerial != sceneSerial_) {
        sceneSerial_ = state.sceneSerial;
        camera_.setHome(state.scene->camera);
        sentCamera_ = state.scene->camera;
        window_.setTitle(state.scene->title + " - " + options_.program);
    }
    if (!state.source.empty()) settings_.scene = state.source;
    if (state.focusSerial != focusSerial_) {
        focusSerial_ = state.focusSerial;
        camera_.focusAt(state.focusDistance, 1);
    }
    if (gui_.viewRequest.mode == app::ViewMode::Error && !state.referenceFits && !state.isReferenceRender) {
        gui_.viewRequest.mode = app::ViewMode::Picture; // there is nothing to compare with any more
    }
    if (state.picture.image && state.picture.serial != pictureSerial_) {
        pictureSerial_ = state.picture.serial;
        presenter_.setPicture(state.picture.image);
    }
    if (!options_.reference.empty() && state.picture.spp > 0) { // there is something to compare with
        session_.loadReference(options_.reference);
        options_.reference.clear();
    }
    if (state.errorSerial != errorSerial_) {
        errorSerial_ = state.errorSerial;
        gui_.say(state.error, true);
    }
    if (state.messageSerial != messageSerial_) {
        messageSerial_ = state.messageSerial;
        gui_.say(state.message, false);
    }
}

// ---- keyboard and mouse ----------------------------------------------------------------------------------------------

void App::handleKey(const Window::KeyPress& press) {
    const bool control = (press.modifiers & GLFW_MOD_CONTROL) != 0;
    const bool shift = (press.modifiers & GLFW_MOD_SHIFT) != 0;
    switch (press.key) { // these work while text is typed, too
        case GLFW_KEY_F1:
            gui_.showHelp = !gui_.showHelp;
            return;
        case GLFW_KEY_F3:
            settings_.showComparison = !settings_.showComparison;
            return;
        case GLFW_KEY_F2:
            settings_.showStatistics = !settings_.showStatistics;
            return;
        case GLFW_KEY_F4:
            settings_.showPanels = !settings_.showPanels;
            return;
        case GLFW_KEY_F11:
            window_.toggleFullScreen();
            return;
        case GLFW_KEY_F12:
            gui_.saveRequested = true;
            return;
        default:
            break;
    }
    if (control) {
        const app::Activity activity = gui_.state.activity;
        switch (press.key) {
            case GLFW_KEY_S:
                gui_.saveRequested = true;
                return;
            case GLFW_KEY_Q:
                window_.close();
                return;
            case GLFW_KEY_O:
                settings_.showPanels = true;
                gui_.focusOpen = true;
                gui_.path.clear();
                return;
            case GLFW_KEY_R:
                session_.reset();
                return;
            case GLFW_KEY_EQUAL:
            case GLFW_KEY_KP_ADD:
                settings_.uiScale = std::min(app::kMostUiScale, settings_.uiScale + 0.25f);
                return;
            case GLFW_KEY_MINUS:
            case GLFW_KEY_KP_SUBTRACT:
                settings_.uiScale = std::max(app::kLeastUiScale, settings_.uiScale - 0.25f);
                return;
            case GLFW_KEY_C:
                if (!shift) return;
                window_.setClipboard(app::CameraController::toText(camera_.camera()));
                gui_.say("Pose copied", false);
                return;
            case GLFW_KEY_V:
                if (!shift) return;
                if (const auto pose = app::CameraController::fromText(window_.clipboard(), camera_.camera())) {
                    camera_.set(*pose);
                } else {
                    gui_.say("The clipboard holds no camera pose", true);
                }
                return;
            default:
                break;
        }
        (void)activity;
        return;
    }
    if (ImGui::GetIO().WantTextInput) return;
    switch (press.key) {
        case GLFW_KEY_SPACE:
            if (ImGui::GetIO().NavVisible) return; // it presses the control that the keyboard is at
            gui_.state.activity == app::Activity::Rendering ? session_.pause() : session_.render();
            return;
        case GLFW_KEY_R:
            camera_.reset();
            return;
        case GLFW_KEY_F:
            gui_.view = {};
            return;
        case GLFW_KEY_B:
            if (gui_.held || gui_.state.picture.image) gui_.hold();
            return;
        case GLFW_KEY_H: {
            const bool isOn = gui_.viewRequest.mode == app::ViewMode::Heat;
            if (gui_.state.canShowCost) gui_.viewRequest.mode = isOn ? app::ViewMode::Picture : app::ViewMode::Heat;
            return;
        }
        case GLFW_KEY_PAGE_UP:
            stepScene(-1);
            return;
        case GLFW_KEY_PAGE_DOWN:
            stepScene(1);
            return;
        default:
            break;
    }
    if (press.key >= GLFW_KEY_1 && press.key <= GLFW_KEY_9) {
        const auto index = static_cast<std::size_t>(press.key - GLFW_KEY_1);
        if (index < scene::builtinScenes().size()) gui_.openScene(std::string(scene::builtinScenes()[index].id));
    }
}

void App::stepScene(int step) {
    const auto scenes = scene::builtinScenes();
    const std::string id = gui_.state.source.substr(0, gui_.state.source.find(':'));
    const auto count = static_cast<int>(scenes.size());
    const auto at = std::find_if(scenes.begin(), scenes.end(), [&](const auto& scene) { return scene.id == id; });
    int index = at != scenes.end() ? static_cast<int>(at - scenes.begin()) + step : 0;
    index = (index + count) % count;
    gui_.openScene(std::string(scenes[static_cast<std::size_t>(index)].id));
}

std::optional<std::array<std::uint32_t, 2>> App::pixelUnderPointer(const Rect& area) const {
    const image::Image* image = gui_.state.picture.image.get();
    if (image == nullptr) return std::nullopt;
    const ImVec2 mouse = ImGui::GetIO().MousePos, pixels = ImGui::GetIO().DisplayFramebufferScale;
    const PresentConstants place = placePicture(area);
    const float x = std::floor((mouse.x * pixels.x - place.originX) / place.scale);
    const float y = std::floor((mouse.y * pixels.y - place.originY) / place.scale);
    if (!(x >= 0 && y >= 0 && x < static_cast<float>(image->width) && y < static_cast<float>(image->height))) {
        return std::nullopt;
    }
    return {{static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y)}};
}

// The inspector's text for a pixel.
void App::inspect(const std::optional<std::array<std::uint32_t, 2>>& pixel) {
    gui_.inspected.clear();
    const app::Picture& picture = gui_.state.picture;
    if (!gui_.viewRequest.inspect || !pixel || !picture.radiance) return;
    const auto [x, y] = *pixel;
    const auto has = [&](const std::shared_ptr<const image::Image>& image) {
        return image && x < image->width && y < image->height;
    };
    if (!has(picture.radiance)) return;
    const float* rgb = picture.radiance->pixel(x, y);
    char text[160];
    std::snprintf(text, sizeof text, "Pixel (%u, %u)\nradiance %.4g  %.4g  %.4g", x, y, rgb[0], rgb[1], rgb[2]);
    gui_.inspected = text;
    if (has(picture.variance)) {
        const float* variance = picture.variance->pixel(x, y);
        std::snprintf(text, sizeof text, "\nvariance %.3g  %.3g  %.3g", variance[0], variance[1], variance[2]);
        gui_.inspected += text;
    }
    if (has(picture.samples)) {
        std::snprintf(text, sizeof text, "\nsamples %.0f", *picture.samples->pixel(x, y));
        gui_.inspected += text;
    }
}

void App::handlePointer(const Rect& area) {
    const ImGuiIO& io = ImGui::GetIO();
    const bool inside = area.contains(io.MousePos.x, io.MousePos.y) && !io.WantCaptureMouse;
    static bool dragging = false; // a drag that began in the picture goes on outside of it
    if (inside && (io.MouseClicked[0] || io.MouseClicked[1] || io.MouseClicked[2])) {
        dragging = true;
        ImGui::SetWindowFocus(nullptr);
    }
    if (!io.MouseDown[0] && !io.MouseDown[1] && !io.MouseDown[2]) dragging = false;
    const std::optional<std::array<std::uint32_t, 2>> pixel = inside ? pixelUnderPointer(area) : std::nullopt;
    inspect(pixel);
    if (inside && io.MouseClicked[0] && gui_.pickFocus) {
        gui_.pickFocus = false;
        if (pixel) session_.pickFocus((*pixel)[0], (*pixel)[1]);
    } else if (dragging && io.MouseDown[0] && gui_.held && !io.KeyAlt) {
        gui_.split = std::clamp((io.MousePos.x - area.x) / std::max(1.0f, area.width), 0.0f, 1.0f);
    }
    const double dx = io.MouseDelta.x, dy = io.MouseDelta.y;
    if (dragging && (dx != 0 || dy != 0)) {
        const float height =
            static_cast<float>(gui_.state.settings.height) * (gui_.view.zoom > 0 ? gui_.view.zoom : fitScale(area));
        if (io.MouseDown[1] && io.KeyCtrl) {
            gui_.view.panX += io.MouseDelta.x;
            gui_.view.panY += io.MouseDelta.y;
            if (gui_.view.zoom == 0) gui_.view.zoom = fitScale(area);
        } else if (io.MouseDown[1]) {
            camera_.look(-kRadiansPerPixel * dx, -kRadiansPerPixel * dy);
        } else if (io.MouseDown[0] && io.KeyAlt) {
            camera_.orbit(-kRadiansPerPixel * dx, -kRadiansPerPixel * dy);
        } else if (io.MouseDown[2] && height > 0) {
            camera_.pan(-dx / height, dy / height);
        }
    }
    if (inside && io.MouseWheel != 0) {
        if (io.KeyCtrl) { // about the pointer
            const float before = gui_.view.zoom > 0 ? gui_.view.zoom : fitScale(area);
            const float after = std::clamp(before * std::pow(1.2f, io.MouseWheel), 0.02f, 64.0f);
            const float x = io.MousePos.x - area.x - 0.5f * area.width, y = io.MousePos.y - area.y - 0.5f * area.height;
            gui_.view.panX = x - (x - gui_.view.panX) * after / before;
            gui_.view.panY = y - (y - gui_.view.panY) * after / before;
            gui_.view.zoom = after;
        } else if (io.KeyShift) {
            camera_.dolly(io.MouseWheel);
        } else {
            camera_.changeSpeed(io.MouseWheel);
            char text[64];
            std::snprintf(text, sizeof text, "Flying speed %.3g", camera_.speed());
            gui_.say(text, false);
        }
    }
}

void App::fly(double seconds) {
    moving_ = false;
    if (ImGui::GetIO().WantTextInput || !gui_.state.scene) return;
    const bool control = window_.isDown(GLFW_KEY_LEFT_CONTROL) || window_.isDown(GLFW_KEY_RIGHT_CONTROL);
    const bool shift = window_.isDown(GLFW_KEY_LEFT_SHIFT) || window_.isDown(GLFW_KEY_RIGHT_SHIFT);
    const auto axis = [this](int positive, int negative) {
        return (window_.isDown(positive) ? 1.0 : 0.0) - (window_.isDown(negative) ? 1.0 : 0.0);
    };
    double right = axis(GLFW_KEY_D, GLFW_KEY_A);
    const double up = axis(GLFW_KEY_E, GLFW_KEY_Q);
    double forward = axis(GLFW_KEY_W, GLFW_KEY_S);
    if (control && (window_.isDown(GLFW_KEY_S) || window_.isDown(GLFW_KEY_Q))) return; // save, quit
    if (right == 0 && up == 0 && forward == 0) return;
    const double pace = shift ? kFast : control ? kSlow : 1;
    camera_.fly(pace * right, pace * up, pace * forward, seconds);
    moving_ = true;
}

// ---- what has changed ------------------------------------------------------------------------------------------------

void App::sendChanges() {
    if (settings_.request != sentRequest_) {
        sentRequest_ = settings_.request;
        session_.change(sentRequest_);
    }
    if (settings_.engine != sentEngine_) {
        sentEngine_ = settings_.engine;
        session_.choose(sentEngine_);
    }
    if (gui_.viewRequest != sentView_) {
        sentView_ = gui_.viewRequest;
        session_.view(sentView_);
    }
    if (gui_.held.get() != shownHeld_) {
        shownHeld_ = gui_.held.get();
        if (gui_.held) presenter_.setHeld(gui_.held);
    }
    if (sceneSerial_ > 0 && camera_.camera() != sentCamera_) {
        sentCamera_ = camera_.camera();
        session_.moveCamera(sentCamera_, sceneSerial_);
    }
}

void App::save() {
    gui_.saveRequested = false;
    if (!gui_.state.scene) return;
    app::SaveRequest request;
    request.files = options_.outputs;
    if (request.files.empty()) request.files = savePaths(settings_.saveFolder, gui_.state);
    request.exposure = settings_.exposure;
    request.tonemap = settings_.tonemap;
    session_.save(std::move(request));
}

void App::remember() {
    const WindowPlace place = window_.place();
    settings_.windowMaximised = place.maximised;
    if (!place.maximised) {
        settings_.windowX = place.x;
        settings_.windowY = place.y;
        settings_.windowWidth = place.width;
        settings_.windowHeight = place.height;
        settings_.windowPlaced = place.hasPosition;
    }
    stored_ = settings_;
    sinceStored_ = {};
    const std::filesystem::path file = settingsFile(options_.program);
    if (file.empty()) return;
    try {
        saveGuiSettings(file, settings_);
    } catch (const Error& error) {
        logWarning(error.what()); // a home that cannot be written is no reason to stop
    }
}

// ---- drawing ---------------------------------------------------------------------------------------------------------

void App::drawInterface() {
    std::vector<Panel> panels;
    if (settings_.showPanels) {
        using Place = Panel::Place;
        panels = {{"Scene", Place::Side, true, [this] { drawScenePanel(gui_); }},
                  {"Rendering", Place::Side, true, [this] { drawRenderPanel(gui_); }},
                  {"Camera", Place::Side, false, [this] { drawCameraPanel(gui_); }},
                  {"View", Place::Side, false, [this] { drawViewPanel(gui_); }}};
        if (settings_.showStatistics) {
            panels.push_back({"Statistics", Place::Side, false, [this] { drawStatisticsPanel(gui_); }});
        }
    }
    if (settings_.showComparison) {
        panels.push_back({"Comparison", Panel::Place::Bottom, true, [this] { drawComparisonPanel(gui_); }});
    }
    area_ = imgui_.layOut(
        panels, [this] { drawRenderControl(gui_); }, [this] { drawStatusLine(gui_); });
    handlePointer(area_);
    drawOverlay(area_);
    drawHelp(gui_);
}

// What keeps the user waiting, and what has just happened, over the picture.
void App::drawOverlay(const Rect& area) {
    const bool waiting = !gui_.state.stage.empty() && gui_.state.stageSeconds > 0.3;
    const bool talking = ImGui::GetTime() - gui_.toastTime < kToastSeconds && !gui_.toast.empty();
    if (!gui_.inspected.empty()) {
        ImGui::BeginTooltip();
        ImGui::TextUnformatted(gui_.inspected.c_str());
        ImGui::EndTooltip();
    }
    if (!waiting && !talking) return;
    constexpr ImGuiWindowFlags kFlags = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_AlwaysAutoResize |
                                        ImGuiWindowFlags_NoInputs | ImGuiWindowFlags_NoSavedSettings |
                                        ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoNav;
    const float margin = 12 * imgui_.scale();
    const auto box = [&](const char* name, float y, float pivot, const std::string& text, bool isError) {
        ImGui::SetNextWindowPos({area.x + 0.5f * area.width, y}, ImGuiCond_Always, {0.5f, pivot});
        ImGui::SetNextWindowBgAlpha(0.92f);
        ImGui::Begin(name, nullptr, kFlags);
        ImGui::PushTextWrapPos(std::max(80.0f, 0.8f * area.width));
        if (isError) ImGui::PushStyleColor(ImGuiCol_Text, ImVec4{0.95f, 0.38f, 0.33f, 1});
        ImGui::TextUnformatted(text.c_str());
        if (isError) ImGui::PopStyleColor();
        ImGui::PopTextWrapPos();
        ImGui::End();
    };
    if (waiting) {
        box("##stage", area.y + margin, 0, gui_.state.stage + " ... " + shortDuration(gui_.state.stageSeconds), false);
    }
    if (talking) box("##toast", area.y + area.height - margin, 1, gui_.toast, gui_.toastIsError);
}

float App::fitScale(const Rect& area) const {
    const image::Image* image = gui_.state.picture.image.get();
    if (image == nullptr || image->width == 0 || image->height == 0) return 1;
    return std::max(1e-3f, std::min(area.width / static_cast<float>(image->width),
                                    area.height / static_cast<float>(image->height)));
}

PresentConstants App::placePicture(const Rect& area) const {
    const ImVec2 pixels = ImGui::GetIO().DisplayFramebufferScale;
    PresentConstants constants;
    if (const image::Image* image = gui_.state.picture.image.get()) {
        const float scale = gui_.view.zoom > 0 ? gui_.view.zoom : fitScale(area);
        const float left = area.x + 0.5f * (area.width - scale * static_cast<float>(image->width)) + gui_.view.panX;
        const float top = area.y + 0.5f * (area.height - scale * static_cast<float>(image->height)) + gui_.view.panY;
        // Whole pixels of the window: an image at 1:1 stays sharp.
        constants.originX = std::round(left * pixels.x);
        constants.originY = std::round(top * pixels.y);
        constants.scale = scale * pixels.x;
    }
    constants.plain = (gui_.state.picture.isDisplay ? 1u : 0u) | (gui_.heldIsDisplay ? 2u : 0u);
    if (gui_.held) constants.split = (area.x + gui_.split * area.width) * pixels.x;
    constants.exposure = settings_.exposure;
    constants.curve = static_cast<std::uint32_t>(settings_.tonemap);
    const Rgb surround = surroundColor(settings_.colorMode);
    constants.surround[0] = surround.r;
    constants.surround[1] = surround.g;
    constants.surround[2] = surround.b;
    return constants;
}

void App::measure(double busySeconds) {
    const double now = clock_.seconds();
    turns_.emplace_back(now, busySeconds);
    while (!turns_.empty() && turns_.front().first < now - kStallSeconds) turns_.pop_front();
    gui_.figures.longestStall = 0;
    int lastSecond = 0;
    for (const auto& [end, seconds] : turns_) {
        gui_.figures.longestStall = std::max(gui_.figures.longestStall, seconds);
        lastSecond += end > now - 1;
    }
    gui_.figures.framesPerSecond = lastSecond;
}

} // namespace

ExitCode runWindow(const app::Options& options, const WindowProgram& program) {
    App app(options, program);
    const ExitCode code = app.run();
    if (app.validationMessages() > 0) {
        throw RenderError(std::to_string(app.validationMessages()) + " messages of Vulkan's validation");
    }
    return code;
}

} // namespace rt::gui
