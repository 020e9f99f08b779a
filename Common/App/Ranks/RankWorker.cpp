#include "Common/App/Ranks/RankWorker.h"

#include <chrono>
#include <deque>
#include <utility>

#include "Common/Render/Stopwatch.h"

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
                    {}},
                   nullptr);
        while (!isEnd_) {
            if (leases_.empty()) link_.wait();
            listen();
            if (leases_.empty() || isEnd_) continue;
            const Message lease = std::move(leases_.front());
            leases_.pop_front();
            render(lease);
        }
    }

  private:
    // To what has arrived.
    void listen() {
        while (std::optional<Message> message = link_.receive()) {
            if (message->kind == MessageKind::Begin) begin(message->fields);
            if (message->kind == MessageKind::Lease) leases_.push_back(std::move(*message));
            if (message->kind == MessageKind::Recall) recall(message->fields);
            if (message->kind == MessageKind::End) isEnd_ = true;
        }
    }

    void begin(const nlohmann::json& fields) {
        const bool secondMoments = fields.at("second_moments"), sppIsKnown = fields.at("spp_is_known");
        if (secondMoments == settings_.secondMoments && sppIsKnown == settings_.sppIsKnown) return;
        settings_.secondMoments = secondMoments;
        settings_.sppIsKnown = sppIsKnown;
        engine_.resetForLeases(scene_.camera, settings_);
    }

    // One lease, or all. What was not begun goes back at once.
    void recall(const nlohmann::json& fields) {
        const auto isMeant = [&fields](std::uint64_t id) { return fields.is_null() || fields.at("id") == id; };
        isRecalled_ = isRecalled_ || (current_ != 0 && isMeant(current_));
        std::erase_if(leases_, [&](const Message& lease) {
            const std::uint64_t id = lease.fields.at("id");
            if (isMeant(id)) giveBack(id, 0, 0, nullptr);
            return isMeant(id);
        });
    }

    void giveBack(std::uint64_t id, std::uint64_t samples, double busy, TilesToPack tiles) {
        link_.send({MessageKind::Result,
                    {{"id", id}, {"samples", samples}, {"busy", busy}, {"report", toJson(engine_.report())}},
                    {}},
                   std::move(tiles));
    }

    void render(const Message& lease) {
        const Stopwatch watch;
        const image::TileList tiles = lease.fields.at("tiles");
        const double seconds = lease.fields.at("seconds");
        current_ = lease.fields.at("id");
        isRecalled_ = false;
        engine_.renderOnly(tiles, lease.fields.at("spp"), lease.tiles);
        const std::uint64_t before = image::totalSamples(engine_.film(), tiles);
        RenderStatus status{.samplesDone = before};
        while (!status.finished && !isRecalled_ && !isEnd_ && watch.seconds() < seconds) {
            status = engine_.renderSome({std::chrono::duration<double>(kSlice), nullptr});
            if (!status.finished) listen();
        }
        if (!isEnd_) {
            TilesToPack taken = engine_.takeTiles(tiles); // copied from a device: part of the work
            giveBack(current_, status.samplesDone - before, watch.seconds(), std::move(taken));
        }
        current_ = 0;
    }

    Engine& engine_;
    const scene::CompiledScene& scene_;
    RenderSettings settings_;
    const RankLink& link_;
    std::deque<Message> leases_; // that it has not begun
    std::uint64_t current_ = 0;  // the lease that it works at; 0: none
    bool isRecalled_ = false;    // that one
    bool isEnd_ = false;
};

} // namespace

void serveLeases(Engine& engine, const scene::CompiledScene& scene, const RenderSettings& settings,
                 const RankLink& link) {
    Worker(engine, scene, settings, link).run();
}

} // namespace rt::app
