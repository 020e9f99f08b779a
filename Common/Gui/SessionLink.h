// Between the interface and the session that renders: what has come about there is shown, what was changed here is
// sent, each of it once.
#pragma once
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "Common/App/Interactive/SceneFileWatch.h"
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
    // Of a viewport: what has been taken of its state and sent of its wishes.
    struct Memory {
        std::size_t slot = 0; // of the presenter
        std::uint64_t sceneSerial = 0, pictureSerial = 0, errorSerial = 0, messageSerial = 0, focusSerial = 0;
        std::uint64_t engineFailures = 0;
        app::RenderRequest request;
        app::EngineChoice engine;
        bool rayTracing = true, held = false;
        std::uint32_t previewWidth = 0;
        std::shared_ptr<const scene::CompiledScene> scene;
        scene::CameraDesc camera;
        app::ViewRequest view;
        std::shared_ptr<const image::Image> shownHeld;
    };

    // The session has been given the settings as they are.
    SessionLink(const app::Options& options, Gui& gui, Presenter& presenter);

    // Of the viewport that the session addresses and the Gui shows. `hasFocus`: it is not only for the moment that it
    // does.
    void take(bool hasFocus); // the state of a frame, with what follows from it
    void send(bool hasFocus);
    Memory& memory() { return now_; } // of that viewport

  private:
    void takeErrors();
    void rememberScene();
    void showTitle();
    void followExposure();
    void followFile();
    void sendEnd();

    const app::Options& options_;
    Gui& gui_;
    Presenter& presenter_;
    Memory now_;
    app::SceneFileWatch watch_; // of the scene's files
    app::Stopwatch sinceLook_;
    std::string title_;     // of the window
    std::string reference_; // to be loaded when there is something to compare with; empty: none or done
    std::uint64_t sceneLoads_ = 0, sceneFailures_ = 0, sceneReads_ = 0;
    std::string rememberedSource_;
    std::optional<app::SaveRequest> sentEnd_; // none where the program was not asked for files
};

} // namespace rt::gui
