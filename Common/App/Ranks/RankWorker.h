// What every rank does: render the tiles that rank 0 leases to it.
#pragma once
#include <functional>
#include <memory>
#include <optional>

#include "Common/App/Ranks/Message.h"
#include "Common/Render/Engine.h"

namespace rt::app {

// To rank 0, and from it. Rank 0 itself has one within the process.
struct RankLink {
    std::function<void(Message, TilesToPack)> send;  // the message's tiles, where there are any, are still to be packed
    std::function<std::optional<Message>()> receive; // does not wait
    std::function<void()> wait;                      // until there is something to receive
};

// Until rank 0 ends it. The engine has its scene, and resetForLeases() was called with these settings: what that takes
// is over before the first lease. Throws what the engine throws.
void serveLeases(Engine& engine, const scene::CompiledScene& scene, const RenderSettings& settings,
                 const RankLink& link);

} // namespace rt::app
