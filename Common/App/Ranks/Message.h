// What ranks tell each other: a kind, some fields as JSON, and packed tiles of a film.
#pragma once
#include <exception>

#include <nlohmann/json.hpp>

#include "Common/App/Ranks/Communicator.h"
#include "Common/Render/Engine.h"

namespace rt::app {

enum class MessageKind : std::uint32_t {
    Begin,    // rank 0: reset, with what only rank 0 knows of the settings
    Lease,    // rank 0: render these tiles
    Recall,   // rank 0: give back the lease of this number, or all that you hold
    End,      // rank 0: there is nothing more to do
    Ready,    // to rank 0: this is my engine; after setScene and reset
    Result,   // to rank 0: the tiles of a lease, as far as they got; none of one that was not begun
    Failure,  // to rank 0: this went wrong, and I do nothing more
    Rendered, // to rank 0: all frames that are mine
    Bye       // to rank 0: I got your End
};

struct Message {
    MessageKind kind = MessageKind::End;
    nlohmann::json fields = nullptr;
    Bytes tiles; // of FilmTiles.h
};

Message failureMessage(const std::exception& error);

// Tiles may be most of a film: their bytes are moved, not copied.
Bytes toBytes(Message message);
Message toMessage(Bytes bytes); // throws RenderError for what is none

nlohmann::json toJson(const EngineReport& report);
EngineReport toReport(const nlohmann::json& json);

} // namespace rt::app
