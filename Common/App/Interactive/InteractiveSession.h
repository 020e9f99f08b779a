// A render that a window watches and steers, in one viewport or several of one scene. The engines live on a thread of
// their own; the window posts what it wants and reads what there is, and neither waits for the other.
#pragma once
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "Common/App/Interactive/InteractiveState.h"
#include "Common/App/Interactive/Viewport.h"
#include "Common/App/Session/SceneLoader.h"

namespace rt::app {

class InteractiveSession {
  public:
    using Setup = SessionSetup;
    explicit InteractiveSession(Setup setup);
    ~InteractiveSession(); // as close()
    InteractiveSession(const InteractiveSession&) = delete;
    InteractiveSession& operator=(const InteractiveSession&) = delete;

    // Viewports, of which there is one at first. Requests, and state(), are of the one that is addressed, but for what
    // concerns the scene. They take turns, each for the same time; while the user changes what the one with the focus
    // shows, that one alone is rendered.
    ViewportId addressed() const { return addressed_; }
    void address(ViewportId viewport) { addressed_ = viewport; }
    void setFocus(ViewportId viewport) { board_.setFocus(viewport); }
    // Another one of the present scene, which is to be there and not on its way to be another.
    ViewportId openViewport(const RenderRequest& request, const EngineChoice& engine, const scene::CameraDesc& camera,
                            bool preview);
    void closeViewport(ViewportId viewport); // frees its engine and its film; not the last one, nor the addressed one

    // Requests. None of them waits; the last of a kind counts.
    void open(const std::string& source, std::optional<scene::Moment> moment = {}); // as SceneLoader has it
    // The scene at another moment of its motion, as SceneLoader has it; a picture that has been begun is shown first.
    // The camera stays where it is or, where it is one of the scene's, moves with it, and so do all settings. Returns
    // SessionState::scenePoses of the scene that is there then.
    std::uint64_t pose(const scene::Moment& moment, const scene::Shutter& shutter);
    // For a file that has changed: gives way to what is being loaded or prepared. Whether it was requested.
    bool reopen(const std::string& source);
    // From now on the present scene is edited: this is its description, and each edit changes it as the window's own.
    void startEditing(scene::SceneDesc scene) { loader_.startEditing(std::move(scene)); }
    void stopEditing() { loader_.stopEditing(); }
    // The camera stays where it is, and so do all settings; a scene that cannot be had leaves the one before in place.
    // Returns SessionState::sceneEdits of the scene that has them.
    std::uint64_t edit(std::vector<scene::SceneEdit> edits, bool isGesture);
    void nameEdited(const std::string& file); // which the edited scene has been saved to
    void change(const RenderRequest& request);
    void choose(const EngineChoice& engine) {
        post(Cancel::Build, [&](Requests& requests) { requests.engine = engine; });
    }
    void moveCamera(const scene::CameraDesc& camera,
                    std::uint64_t sceneSerial);               // ignored if the scene is another by now
    void render() { post(Cancel::Nothing, Command::Render); } // from the beginning when ended, else goes on
    // Likewise, but a film that has ended goes on where it has samples to go: those that a change has added to it.
    void goOn() { post(Cancel::Nothing, Command::GoOn); }
    void pause() { post(Cancel::Slice, Command::Pause); }
    // Ends the film, and gives up what is being loaded or prepared: the scene before stays.
    void stop();
    void reset() { post(Cancel::FirstPicture, Command::Reset); } // begins anew
    void save(SaveRequest request) {                             // where a picture is yet to come, once it is there
        post(Cancel::Nothing, [&](Requests& requests) { requests.saves.push_back(std::move(request)); });
    }
    void view(const ViewRequest& view) {
        post(Cancel::Slice, [&](Requests& requests) { requests.view = view; });
    }
    // Shows the preview instead of the film, where the engine has one; rays rest meanwhile, and the film goes on
    // afterwards unless something that concerns it has changed.
    void preview(bool on) {
        post(Cancel::FirstPicture, [on](Requests& requests) { requests.preview = on; });
    }
    // Pixels that a row of the preview is drawn with, so that it suits the window; 0: as many as the picture has. The
    // height follows. Files get the picture's size.
    void previewWidth(std::uint32_t width) {
        post(Cancel::Nothing, [width](Requests& requests) { requests.previewWidth = width; });
    }
    // The image that errors are taken against: rendered with the present scene, camera and size, or read from a linear
    // image file of the present size. Stop gives a render up, and what was the reference before stays.
    void renderReference(std::uint32_t spp) {
        post(Cancel::FirstPicture, [spp](Requests& requests) { requests.referenceSpp = spp; });
    }
    void loadReference(const std::string& file) {
        post(Cancel::Nothing, [&](Requests& requests) { requests.referenceFile = file; });
    }
    // Races the entrants in the present view, each for the same time; the film rests meanwhile. What changes the view
    // or goes on with the film ends it.
    void race(const RaceRequest& request) {
        post(Cancel::Slice, [&](Requests& requests) { requests.race = request; });
    }
    void stopRace() { endRace(Requests::RaceEnd::Stop); }   // what it has measured stays, and its picture is shown
    void leaveRace() { endRace(Requests::RaceEnd::Leave); } // the film comes back
    void showInRace(std::optional<std::size_t> entrant) {   // none: who leads
        post(Cancel::Slice, [entrant](Requests& requests) { requests.raceShown = entrant; });
    }
    // Finds the focus distance for what is seen in a pixel: the state tells.
    void pickFocus(std::uint32_t x, std::uint32_t y) {
        post(Cancel::Slice, [x, y](Requests& requests) { requests.focus = {x, y}; });
    }
    // Whether the user has hold of something that changes the film, as of the camera: films that end meanwhile are runs
    // of the history only if they are still seen when it is let go.
    void hold(bool isHeld) {
        if (addressed_ == board_.focus()) board_.setHeld(isHeld);
        post(Cancel::Nothing, [isHeld](Requests& requests) { requests.held = isHeld; });
    }
    // What is to be written once, when the first render of the first viewport ends by itself or by stop(), or before
    // that in closeViewport() or close().
    void writeAtEnd(const SaveRequest& request);
    // How the window has answered so far, for the statistics.
    void tell(const WindowFigures& figures);

    // Ends the render and its thread, within 100 ms but for what the engine is building. Returns how it went with
    // the files of writeAtEnd(). Nothing but state() may be called any more.
    EndFiles close();

    SessionState state() const;

  private:
    void dropScenes();
    void endRace(Requests::RaceEnd end) {
        post(Cancel::Build, [end](Requests& requests) { requests.raceEnd = end; });
    }
    using Command = Requests::Command;
    void post(Cancel cancel, Command command) {
        post(cancel, [command](Requests& requests) { requests.command = command; });
    }
    void post(Cancel cancel, const std::function<void(Requests&)>& change);
    void postToAll(Cancel cancel, const std::function<void(Requests&)>& change);
    void hand(LoadedScene loaded);
    void noteMotion();
    ViewportId add(Setup setup);
    std::vector<std::shared_ptr<Viewport>> viewports() const;
    std::shared_ptr<Viewport> viewport(ViewportId id) const;
    Viewport& at() const { return *viewport(addressed_); }

    Setup setup_;
    mutable std::mutex mutex_; // guards the list: the loader's thread reads it
    std::vector<std::shared_ptr<Viewport>> viewports_;
    ViewportId lastId_ = 0, addressed_ = 0;
    std::map<ViewportId, SizeRequest> sentSizes_;
    ViewportBoard board_;
    std::uint64_t reads_ = 0; // of scenes from their sources; of the loader's thread
    SceneLoader loader_;      // its thread posts to mailboxes
    EndFiles endFiles_;
    std::thread thread_;
};

} // namespace rt::app
