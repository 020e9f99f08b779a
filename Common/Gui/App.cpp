#include "Common/Gui/App.h"

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <exception>
#include <iostream>
#include <memory>
#include <optional>
#include <utility>

#include "Common/App/Platform.h"
#include "Common/App/Session/Interrupt.h"
#include "Common/App/Session/Outputs.h"
#include "Common/Core/Log.h"
#include "Common/Gui/FrameTimer.h"
#include "Common/Gui/ImGuiLayer.h"
#include "Common/Gui/ObjectTools.h"
#include "Common/Gui/PanelImages.h"
#include "Common/Gui/Panels/Panels.h"
#include "Common/Gui/Panels/SavePaths.h"
#include "Common/Gui/PictureArea.h"
#include "Common/Gui/PresentThread.h"
#include "Common/Gui/Presenter.h"
#include "Common/Gui/SessionLink.h"
#include "Common/Gui/Shortcuts.h"
#include "Common/Gui/Snapshot.h"
#include "Common/Gui/TimelineBar.h"
#include "Common/Gui/UserFiles.h"
#include "Common/Gui/Viewports.h"
#include "Common/Render/Stopwatch.h"
#include "Common/Vulkan/Instance.h"

namespace rt::gui {
namespace {

constexpr double kIdleSeconds = 0.25; // between two frames when nothing happens
constexpr double kSoftSeconds = 1.2; // likewise where software draws, at rendering's cost: longer than between pictures
constexpr double kBusySeconds = 0.01;          // between two looks for something new of a session at work
constexpr double kSoftBusySeconds = 0.05;      // likewise where software draws; input is seen at once
constexpr double kSoftFrameSeconds = 1.0 / 30; // between quick frames where software draws
constexpr double kSoftNewsSeconds = 0.1; // between frames of what is new where software draws and nobody does anything
constexpr double kAwakeSeconds = 0.4, kSoftAwakeSeconds = 0.15; // of quick frames after the last input, likewise
constexpr double kReadingSeconds = 0.1;                         // of frames that only take input, before one is shown
constexpr int kAnsweringFrames = 4;  // after input that may bring the keyboard elsewhere, before more is read
constexpr int kSettlingFrames = 6;   // after the last input, likewise: windows and tables find their sizes in them
constexpr double kLongestStep = 0.1; // seconds of flight in one frame
constexpr double kPresentingSeconds = 0.002; // between two looks whether a frame under way has been presented

class App {
  public:
    App(const app::Options& options, const WindowProgram& program)
        : options_(options),
          kept_(options),
          window_(options.program, placeOf(settings_)),
          device_(window_, options.validation, options.device),
          presenter_(device_, window_),
          imgui_(window_, device_, presenter_.renderPass(), presenter_.imageCount(), layoutFile(options)),
          history_(historyFile(options)),
          session_(sessionSetup(options, program, settings_, device_.isSoftware(), history_, isNews_)),
          gui_{session_,
               settings_,
               camera_,
               history_,
               window_,
               images_.scenes,
               images_.materials,
               options.program == app::kGpuProgram,
               program.devices,
               other_,
               options.assetsBelow,
               editor_,
               probe_,
               paths_,
               images_.probe} {
        gui_.recovery.autosave = autosave_.get();
        gui_.showFirstSteps = !std::exchange(settings_.sawFirstSteps, true);
        window_.onDrop([this](const std::vector<std::string>& files) { dropped_ = files; });
    }

    ExitCode run(const std::atomic<bool>& isInterrupted);

  private:
    bool isAwake() const;
    bool isFrameDue();
    void wait();
    void waitForPresenting();
    void turn();
    void readInput();
    void save();
    bool mustPresent(const WindowFrame& frame);
    void drawFrame(bool isShown);
    void drawInterface();
    void drawOtherViewports(float scale);
    bool askBeforeClosing();
    void endAutosave(bool isInterrupted);
    void rescue();

    app::Options options_;
    KeptSettings kept_;
    app::GuiSettings& settings_ = kept_.settings;
    Window window_;
    GraphicsDevice device_;
    Presenter presenter_;
    ImGuiLayer imgui_;
    PanelImages images_{device_, presenter_.renderPass()};
    app::RunHistory history_;
    app::CameraController camera_;
    std::atomic<bool> isNews_{false}; // there is something new of the session
    app::InteractiveSession session_;
    std::unique_ptr<app::Autosave> autosave_ = autosaveOf(options_, [this] { isNews_ = true; });
    app::SceneEditor editor_{session_, options_.assetsBelow, autosave_.get()};
    app::OtherEngine other_{history_, [this] { isNews_ = true; }};
    probe::ProbeView probe_{[this] { isNews_ = true; }};
    probe::PathsView paths_{[this] { isNews_ = true; }};
    Gui gui_;
    PictureArea picture_{gui_};
    SessionLink link_{options_, gui_, presenter_};
    Viewports viewports_{gui_, link_, presenter_};
    std::vector<PicturePart> otherPictures_; // of viewports that have not the focus, in this frame

    std::vector<std::string> dropped_;
    std::vector<InputEvent> input_;            // of the frame
    std::optional<app::Stopwatch> sinceInput_; // none yet
    int framesSinceInput_ = 0;
    bool isExposed_ = false; // the window system may have forgotten what the window shows
    app::Stopwatch sinceFrame_;
    struct Sizes { // of what is shown and may have become larger
        std::uint64_t historySerial = 0;
        double messageTime = 0;
        std::size_t errors = 0;
        bool operator==(const Sizes&) const = default;
    };
    Sizes sizes_;
    FrameTimer meter_;
    bool flying_ = false;
    PresentThread presenting_{presenter_};             // behind all that a frame draws
    app::WindowLossGuard guard_{[this] { rescue(); }}; // last: nothing else is gone when it acts
};

ExitCode App::run(const std::atomic<bool>& isInterrupted) {
    while (!isInterrupted) {
        if (window_.shouldClose() && !askBeforeClosing()) break;
        wait();
        turn();
    }
    waitForPresenting();
    window_.hide(); // what follows may take a while
    endAutosave(isInterrupted);
    kept_.keep(window_);
    const app::EndFiles files = session_.close();
    // A signal before there is anything to write loses nothing.
    const bool losesNothing = isInterrupted && !files.hasFilm;
    if (!files.failures.empty() && !losesNothing) throw RenderError(files.failures.front());
    return isInterrupted ? ExitCode::Interrupted : ExitCode::Done;
}

// Whoever has closed the window has decided what becomes of edits; whoever has ended the program by a signal has not.
void App::endAutosave(bool isInterrupted) {
    if (autosave_ == nullptr) return;
    if (!isInterrupted) return autosave_->end();
    if (editor_.isDirty()) logWarning("edits of the scene are not saved: the next window offers them again");
}

// Whether the window stays open for that.
bool App::askBeforeClosing() {
    if (!gui_.editor.isDirty() || gui_.editing.isDiscarded) return false;
    window_.stayOpen();
    gui_.close();
    isNews_ = true;
    return true;
}

// Whether something may move by itself.
bool App::isAwake() const {
    const double seconds = device_.isSoftware() ? kSoftAwakeSeconds : kAwakeSeconds;
    return flying_ || gui_.timeline.isPassing() || ImGui::IsAnyMouseDown() || framesSinceInput_ < kSettlingFrames ||
           (sinceInput_ && sinceInput_->seconds() < seconds);
}

// Whether the next frame is to come at once: input does not wait, all else does where software draws.
bool App::isFrameDue() {
    const bool isInput = window_.takeInput();
    if (isInput) {
        sinceInput_.emplace();
        framesSinceInput_ = 0;
    }
    if (window_.takeChange()) isNews_ = isExposed_ = true;
    if (window_.hasEvents()) return true; // also those that the frame before has not come to
    const double minimum = !device_.isSoftware() ? 0 : isAwake() ? kSoftFrameSeconds : kSoftNewsSeconds;
    return isInput || ((isAwake() || isNews_) && sinceFrame_.seconds() >= minimum);
}

// For input, for something new of the session, or for the time of another frame. The session's threads leave the window
// system alone, which therefore ends the program, where it does, on this thread.
void App::wait() {
    const bool isBusy =
        gui_.state.activity == app::Activity::Rendering || !gui_.state.stage.empty() || gui_.areOthersBusy;
    // A stage tells how long it has taken, and a field of text has a cursor that blinks.
    const bool moves = !gui_.state.stage.empty() || ImGui::GetIO().WantTextInput;
    const bool blinks = gui_.pinned && gui_.compareBy == CompareBy::Blink;
    const double longest = device_.isSoftware() && !moves && !blinks ? kSoftSeconds : kIdleSeconds;
    const double restful = !isBusy ? kIdleSeconds : device_.isSoftware() ? kSoftBusySeconds : kBusySeconds;
    const app::Stopwatch watch;
    while (!isFrameDue() && watch.seconds() < longest)
        window_.waitEvents(isAwake() || isNews_ ? kBusySeconds : restful);
    waitForPresenting();
    window_.waitEvents(0);
    isNews_ = false;
}

// What the frame before shows stays as it is until it has been presented; the user is listened to meanwhile.
void App::waitForPresenting() {
    while (!presenting_.isIdle()) window_.waitEvents(kPresentingSeconds);
}

void App::turn() {
    const app::Stopwatch busy;
    viewports_.take();
    if (!dropped_.empty()) {
        beginDrop(gui_, dropped_.front());
        dropped_.clear();
    }
    const auto [width, height] = window_.framebufferSize();
    if (width <= 0 || height <= 0) { // minimised: nothing to draw, and nobody to draw for
        while (window_.hasEvents()) (void)window_.takeEvents(false);
        flying_ = false;
        sinceInput_.emplace();
        window_.waitEvents(kIdleSeconds);
        return;
    }
    presenter_.renew();
    gui_.followOther();
    gui_.followExport();
    readInput();
    // A table with new rows, and what is said, find their sizes in the frame after.
    const Sizes sizes{gui_.state.historySerial, gui_.messageTime, gui_.errors.unreadCount()};
    if (std::exchange(sizes_, sizes) != sizes || gui_.browser.isSettling()) isNews_ = true;
    const auto drawInterface = [this](VkCommandBuffer commands) {
        images_.setCommands(commands);
        imgui_.draw(commands);
    };
    if (gui_.partToSave) savePart(gui_, device_, presenter_.format(), drawInterface);
    const auto upload = [this](VkCommandBuffer commands, std::uint32_t frame) { images_.upload(commands, frame); };
    std::vector<PicturePart> pictures{{viewports_.slot(), picture_.constants()}};
    pictures.insert(pictures.end(), otherPictures_.begin(), otherPictures_.end());
    if (WindowFrame frame{{width, height}, std::move(pictures), upload, drawInterface}; mustPresent(frame))
        presenting_.present(std::move(frame));
    meter_.add(busy.seconds());
    gui_.figures = meter_.figures();
    session_.tell(gui_.figures.window);
    kept_.keepChanges(window_);
}

// A software driver draws at rendering's cost. A display paces the frames of others.
bool App::mustPresent(const WindowFrame& frame) {
    if (!device_.isSoftware()) return true;
    const bool isExposed = std::exchange(isExposed_, false), areImagesNew = images_.takeChange();
    return imgui_.takeChange() || isExposed || areImagesNew || !presenter_.isShowing(frame);
}

void App::save() {
    gui_.saveRequested = false;
    const std::string file = std::exchange(gui_.saveAs, {});
    if (!gui_.state.scene) return;
    app::SaveRequest request = filesOf(options_, gui_.exposure(), settings_.tonemap);
    request.stats.clear();
    request.what = gui_.savedPicture();
    if (!file.empty()) {
        request.files = {file};
        request.aovs.clear();
    } else if (request.files.empty()) {
        request.files = savePaths(settings_.saveFolder, gui_.state, request.what);
    }
    session_.save(std::move(request));
}

void App::drawFrame(bool isShown) {
    const double seconds = std::min(sinceFrame_.seconds(), kLongestStep);
    sinceFrame_ = {};
    framesSinceInput_ = std::min(framesSinceInput_ + 1, kSettlingFrames);
    imgui_.setStyle(
        {settings_.colorMode, settings_.uiScale * window_.monitorScale(), window_.pixelDensity(), settings_.font});
    imgui_.beginFrame(input_);
    images_.beginFrame();
    for (const InputEvent& event : input_)
        if (isKeyPress(event)) obeyKey(gui_, event);
    followTimeline(gui_);
    followEditing(gui_);
    followRecovery(gui_);
    followMaterials(gui_);
    followAddedFiles(gui_);
    followSampler(gui_);
    followNoisyPixel(gui_);
    drawInterface();
    flying_ = fly(gui_, input_, seconds);
    gui_.isHeld = flying_ || ImGui::IsAnyMouseDown() || gui_.editing.tool || gui_.timeline.isPlaying();
    isShown ? imgui_.endFrame() : imgui_.dropFrame();
    viewports_.send();
    if (gui_.saveRequested || !gui_.saveAs.empty()) save();
}

// All that has come from keyboard and mouse, in as many frames as that takes, of which the last one is shown: however
// slowly frames are shown, nothing of it is lost, and nothing waits for the next of them.
void App::readInput() {
    const app::Stopwatch watch;
    for (int answering = 0;;) {
        input_.clear();
        if (answering > 0)
            --answering;
        else
            input_ = window_.takeEvents(ImGui::GetIO().WantTextInput);
        if (InputQueue::mayChangeFocus(input_)) answering = kAnsweringFrames;
        const bool isLast = !window_.hasEvents() || watch.seconds() > kReadingSeconds;
        drawFrame(isLast);
        if (isLast) return;
    }
}

void App::drawInterface() {
    std::vector<Panel> panels;
    const std::string revealed = std::exchange(gui_.revealPanel, {});
    for (const PanelRow& row : panelTable()) {
        bool& isOpen = settings_.openPanels.try_emplace(row.id, row.opensAtFirst).first->second;
        panels.push_back({row.title, row.place, row.isShown(settings_), &isOpen, [this, &row] { row.draw(gui_); },
                          revealed == row.id});
    }
    panels.front().focus = std::exchange(gui_.focusPanels, false);
    const float scale = imgui_.scale();
    const Rect rest =
        layOut(panels, scale,
               {[this] { drawToolbar(gui_); }, [this] { drawProgress(gui_); }, [this] { drawStatusLine(gui_); }});
    viewports_.place(drawTimelineBar(gui_, rest), scale);
    viewports_.handlePointer();
    viewports_.drawFrames();
    drawOtherViewports(scale);
    const Rect area = viewports_.focusArea();
    picture_.place(area, innerArea(gui_, area, scale));
    gui_.previewWidth = picture_.previewWidth();
    picture_.handlePointer();
    drawSelection(gui_, picture_.imageRect(), area);
    drawTools(gui_, picture_.imageRect(), area);
    drawSampledPoint(gui_, picture_.imageRect(), area);
    drawNoisyPixel(gui_, picture_.imageRect(), area);
    drawViewLegend(gui_, area, scale);
    drawChips(gui_, area, picture_.imageRect(), scale);
    drawOverlay(gui_, area, scale);
    drawErrors(gui_);
    drawScenes(gui_);
    drawHelp(gui_);
    drawFirstSteps(gui_, area);
    drawUnsaved(gui_);
    drawRecovery(gui_);
    endDrops(gui_);
    if (gui_.browser.isOpen())
        if (const auto file = gui_.browser.draw(settings_.recent)) gui_.take(*file);
}

// What they are, and what is selected in them.
void App::drawOtherViewports(float scale) {
    otherPictures_.clear();
    viewports_.eachOther([&](const Rect& area, std::size_t slot) {
        picture_.place(area, innerArea(gui_, area, scale));
        gui_.previewWidth = picture_.previewWidth();
        const ImVec2 pixels = ImGui::GetIO().DisplayFramebufferScale;
        const VkRect2D part{
            {static_cast<std::int32_t>(area.x * pixels.x), static_cast<std::int32_t>(area.y * pixels.y)},
            {static_cast<std::uint32_t>(area.width * pixels.x), static_cast<std::uint32_t>(area.height * pixels.y)}};
        otherPictures_.push_back({slot, picture_.constants(), part});
        drawSelectionOfOther(gui_, picture_.imageRect(), area);
        drawViewLegend(gui_, area, scale);
        drawChips(gui_, area, picture_.imageRect(), scale);
    });
}

void App::rescue() {
    std::cerr << options_.program << ": the window system has taken the window away" << std::endl;
    autosave_.reset(); // writes what it has
    kept_.store();
    other_.close();
    session_.close();
}

} // namespace

ExitCode runWindow(const app::Options& options, const WindowProgram& program) {
    app::Interrupt interrupt; // longer than the window: a signal while it opens or closes is none that kills
    interrupt.finishFirst([&options] { app::checkOutputs(options); }); // before hours are spent
    ExitCode code;
    {
        App app(options, program);
        interrupt.defer(); // there may be something to write
        code = app.run(interrupt.requested());
    }
    if (const std::uint64_t messages = vulkan::Instance::allValidationMessages(); messages > 0)
        throw RenderError(std::to_string(messages) + " messages of Vulkan's validation");
    return code;
}

} // namespace rt::gui
