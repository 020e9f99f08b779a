// Between the interface and the session that renders: what has come about there is shown, what was changed here is
// sent, each of it once.
#pragma once
#include <atomic>
#include <cstdint>
#include <optional>
#include <string>

#include "Common/App/Options/Options.h"
#include "Common/Gui/App.h"
#include "Common/Gui/Gui.h"
#include "Common/Gui/Presenter.h"
#include "Common/Render/Stopwatch.h"

namespace rt::gui {

// What the session begins with. `isNews` becomes true when it has something new to show; it must outlive the session.
app::InteractiveSession::Setup sessionSetup(const app::Options& options, const WindowProgram& program,
                                            app::GuiSettings& settings, bool drawnBySoftware, app::RunHistory& history,
                                            std::atomic<bool>& isNews);

class SessionLink {
  public:
    // The session has been given the settings as they are.
    SessionLink(const app::Options& options, Gui& gui, Presenter& presenter);

    void take(); // the state of a frame, with what follows from it. Throws what is fatal to the session
    void send();

  private:
    void rememberScene();
    void showTitle();
    void followExposure();
    void followFile();

    const app::Options& options_;
    Gui& gui_;
    Presenter& presenter_;
    std::optional<app::FileFingerprint> seenMark_,
        askedMark_; // of the scene's file: at the last look; when it was read again
    app::Stopwatch sinceLook_;
    std::string title_;     // of the window
    std::string reference_; // to be loaded when there is something to compare with; empty: none or done

    std::uint64_t sceneSerial_ = 0, pictureSerial_ = 0, errorSerial_ = 0, messageSerial_ = 0, focusSerial_ = 0;
    std::uint64_t engineFailures_ = 0, sceneLoads_ = 0, sceneFailures_ = 0, sceneReads_ = 0;
    std::string rememberedSource_;

    app::RenderRequest sentRequest_;
    app::EngineChoice sentEngine_;
    bool sentRayTracing_, sentHeld_ = false;
    std::uint32_t sentPreviewWidth_ = 0;
    scene::CameraDesc sentCamera_;
    app::ViewRequest sentView_;
    const image::Image* shownHeld_ = nullptr;
    std::optional<app::SaveRequest> sentEnd_; // none where the program was not asked for files
};

} // namespace rt::gui
