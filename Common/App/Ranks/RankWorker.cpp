#include "Common/App/Ranks/RankWorker.h"

#include <chrono>
#include <thread>
#include <utility>

#include "Common/App/Ranks/Ranks.h"
#include "Common/App/Session/Stopwatch.h"

namespace rt::app {
namespace {

constexpr double kSlice = 0.05; // seconds between two looks for messages

class Worker {
  public:
    Worker(Engine& engine, const scene::CompiledScene& scene, const RenderSettings& settings, const RankLink& link)
        : engine_(engine), scene_(scene), settings_(settings), link_(link) {}

    void run() {
        link_.send({MessageKind::Ready,
                    {{"scene", scene_.hash},
                     {"width", settings_.width},
                     {"height", settings_.height},
                     {"report", toJson(engine_.report())}},
                    {}});
        for (;;) {
            const std::optional<Message> message = link_.receive();
            if (!message) {
                std::this_thread::sleep_for(kPollInterval);
            } else if (message->kind == MessageKind::Begin) {
                begin(message->fields);
            } else if (message->kind == MessageKind::Lease) {
                if (!render(*message)) return;
            } else if (message->kind == MessageKind::End) {
                return;
            }
        }
    }

  private:
    void begin(const nlohmann::json& fields) {
        settings_.secondMoments = fields.at("second_moments");
        settings_.sppIsKnown = fields.at("spp_is_known");
        engine_.reset(scene_.camera, settings_);
    }

    // False: that was the end.
    bool render(const Message& lease) {
        const Stopwatch watch;
        const image::TileList tiles = lease.fields.at("tiles");
        const double seconds = lease.fields.at("seconds");
        engine_.renderOnly(tiles, lease.fields.at("spp"), lease.tiles);
        const std::uint64_t before = image::totalSamples(engine_.film(), tiles);
        bool isRecalled = false, isEnd = false;
        while (!isRecalled && !isEnd && watch.seconds() < seconds) {
            if (engine_.renderSome({std::chrono::duration<double>(kSlice), nullptr}).finished) break;
            if (const std::optional<Message> message = link_.receive()) {
                isEnd = message->kind == MessageKind::End;
                isRecalled = message->kind == MessageKind::Recall;
            }
        }
        if (isEnd) return false;
        const image::Film& film = engine_.film();
        Message result{MessageKind::Result, {}, image::packTiles(film, tiles)};
        result.fields = {{"samples", image::totalSamples(film, tiles) - before},
                         {"busy", watch.seconds()},
                         {"report", toJson(engine_.report())}};
        link_.send(std::move(result));
        return true;
    }

    Engine& engine_;
    const scene::CompiledScene& scene_;
    RenderSettings settings_;
    const RankLink& link_;
};

} // namespace

void serveLeases(Engine& engine, const scene::CompiledScene& scene, const RenderSettings& settings,
                 const RankLink& link) {
    Worker(engine, scene, settings, link).run();
}

} // namespace rt::app
