// The viewports of a window: pictures of one scene beside each other, each with its camera, settings, view and
// exposure. All of the interface is of the one that has the focus; what the others have waits here.
#pragma once
#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "Common/Gui/Gui.h"
#include "Common/Gui/Presenter.h"
#include "Common/Gui/SessionLink.h"
#include "Common/Gui/SplitAreas.h"

namespace rt::gui {

class Viewports {
  public:
    Viewports(Gui& gui, SessionLink& link, Presenter& presenter);

    // Once a frame, of all viewports: their states, and what has been changed. take() throws what is fatal.
    void take();
    void send();
    void place(const Rect& area, float scale); // in the window's units
    // A press gives the focus, or takes a gap; within a frame of ImGui, after the panels.
    void handlePointer();
    const Rect& focusArea() const { return areas_[focus()]; }
    // Each of the others that is there, as if it had the focus: with its area and the presenter's slot.
    void eachOther(const std::function<void(const Rect&, std::size_t)>& act);
    void drawFrames() const;                                 // which has the focus, and the gaps
    std::size_t slot() const { return link_.memory().slot; } // of the one that has the focus

  private:
    struct Seat {
        app::ViewportId id = 0; // 0: it is yet to be opened
        app::SessionState state;
        app::CameraController camera;
        PictureView view;
        app::ViewRequest viewRequest;
        PinnedView pinned;
        CompareBy compareBy = CompareBy::Split;
        float split = 0.5f, autoExposure = 0;
        std::uint32_t previewWidth = 0;
        std::string name;
        SessionLink::Memory link;
    };

    std::size_t count() const { return seats_.size(); }
    std::size_t focus() const { return gui_.settings.focusedViewport; }
    void exchange(std::size_t place);
    void setFocus(std::size_t place);
    void setCount(std::size_t count);
    void close(std::size_t place);
    void openMissing();
    void open(std::size_t place);
    void follow();
    void linkCameras();
    void nameAll();
    std::size_t freeSlot() const;
    bool isBusy() const;

    Gui& gui_;
    SessionLink& link_;
    Presenter& presenter_;
    std::vector<Seat> seats_; // by place; of the focus only what the Gui has counts, but for its id
    std::vector<Rect> areas_{{}};
    Rect all_;
    float gap_ = 0;
    Splitter splitter_, hovered_;       // that is dragged; that the pointer is at
    std::optional<std::size_t> coming_; // gets the focus when a field that is left has been read
    app::ViewportId first_;             // that the program ends without
};

} // namespace rt::gui
