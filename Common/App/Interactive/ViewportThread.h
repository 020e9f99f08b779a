// The session's thread: it alone has the engines, and gives each viewport its turns.
#pragma once
#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "Common/App/Interactive/SessionThread.h"
#include "Common/App/Interactive/TurnTaking.h"
#include "Common/App/Interactive/Viewport.h"

namespace rt::app {

class ViewportThread {
  public:
    ViewportThread(ViewportBoard& board, SceneLoader& loader) : board_(board), loader_(loader) {}

    // Until the last viewport has been asked to quit. Returns how it went with the files of the end.
    EndFiles run();

  private:
    struct Place {
        std::shared_ptr<Viewport> viewport;
        std::unique_ptr<SessionThread> thread; // uses the viewport
    };

    bool open();
    std::optional<std::size_t> next(double secondsToRest);
    bool hasFocus(std::size_t place) const { return places_[place].viewport->id == board_.focus(); }
    void close(std::size_t place);

    ViewportBoard& board_;
    SceneLoader& loader_;
    std::vector<Place> places_;
    Turns turns_; // of each place
    EndFiles endFiles_;
};

} // namespace rt::app
