#include "Common/App/Ranks/RankedEngine.h"

#include <algorithm>
#include <functional>
#include <optional>
#include <thread>
#include <utility>

#include "Common/App/Ranks/LocalRank.h"
#include "Common/App/Ranks/Ranks.h"
#include "Common/App/Ranks/TilePool.h"
#include "Common/Core/Error.h"
#include "Common/Core/Log.h"
#include "Common/Image/SamplePlan.h"
#include "Common/Render/PictureDenoiser.h"
#include "Common/Render/RenderParams.h"
#include "Common/Render/Stopwatch.h"

namespace rt::app {
namespace {

constexpr double kStart = 1;                  // seconds that ranks are waited for before the first samples
constexpr double kRecall = 1;                 // seconds that ranks get to give back what they hold
constexpr std::uint32_t kTilesOfThread = 8;   // of a lease, at least: its threads end together, nearly
constexpr std::uint32_t kTilesOfDevice = 256; // likewise: 16 384 pixels

std::string engineKind(const EngineReport& report) {
    return report.threads > 0 ? "cpu" : report.engine;
}

std::string instructionSet(const EngineReport& report) {
    return report.kernel.substr(report.kernel.rfind('/') + 1);
}

class RankedEngine final : public Engine {
  public:
    RankedEngine(std::unique_ptr<Engine> local, Communicator& ranks)
        : local_(std::move(local)),
          ranks_(ranks),
          idle_(local_->report().threads > 0),
          states_(static_cast<std::size_t>(ranks.size())) {}

    bool setScene(std::shared_ptr<const scene::CompiledScene> scene, const std::atomic<bool>* cancel) override {
        if (!local_->setScene(scene, cancel)) return false;
        scene_ = std::move(scene);
        return true;
    }

    void reset(const scene::CameraDesc& camera, const RenderSettings& settings) override;
    void restore(image::Film film) override {
        film_ = std::move(film);
        plan_.spp = goal();
    }
    void renderOnly(image::TileList tiles, std::uint32_t spp, std::span<const std::byte> packed) override {
        image::unpackTiles(packed, film_);
        plan_ = {std::move(tiles), spp, plan_.evenly};
        isPart_ = true;
    }
    RenderStatus renderSome(const Budget& budget) override;
    const image::Film& film() override;
    AovImages renderAovs(const AovRequest& request, std::uint32_t samples) override {
        localRank_.reset(); // its engine is free then
        return local_->renderAovs(request, samples);
    }
    DenoisedPicture denoiseHalves(const image::DenoiseInput& halves, bool details, std::uint32_t threads) override {
        localRank_.reset();
        return local_->denoiseHalves(halves, details, threads);
    }
    std::optional<DenoisedPicture> denoiseWhole(const image::DenoiseInput& halves, bool details) override {
        localRank_.reset();
        return local_->denoiseWhole(halves, details);
    }
    EngineReport report() const override;

  private:
    struct RankState {
        bool isReady = false;  // for leases
        bool isSilent = false; // it has not answered a recall in time, nor said anything since: it may hang
        EngineReport report;
        RankFigures figures;
    };

    void send(std::size_t rank, Message message);
    bool receiveAll();
    void awaitReady();
    void receiveWhile(const std::function<bool()>& isWaiting, double seconds);
    void receive(std::size_t rank, const Message& message);
    void greet(std::size_t rank, const nlohmann::json& fields);
    void takeResult(std::size_t rank, const Message& message);
    void fail(std::size_t rank, const Error& error);
    void lease(std::size_t rank);
    std::uint32_t goal() const { return static_cast<std::uint32_t>(image::goalOf(film_, settings_.spp)); }
    bool planSamples(const std::atomic<bool>* cancel);
    RenderStatus status() const;

    std::unique_ptr<Engine> local_;
    Communicator& ranks_;
    std::shared_ptr<const scene::CompiledScene> scene_;
    RenderSettings settings_;
    image::Film film_;
    TilePlan plan_;
    bool isPart_ = false;          // of the image: renderOnly() has said which
    std::optional<TilePool> pool_; // from the first samples on
    Stopwatch clock_;
    IdleWait idle_;
    double sampling_ = 0; // seconds
    std::vector<RankState> states_;
    std::optional<Error> failure_;       // of a rank
    std::optional<LocalRank> localRank_; // while there are samples to take
};

void RankedEngine::reset(const scene::CameraDesc& camera, const RenderSettings& settings) {
    local_->resetForLeases(camera, settings); // whose failures are seen before anybody waits
    settings_ = settings;
    film_ = image::Film(filmDesc(settings));
    if (settings.spp % image::Film::kBlock != 0 || settings.replicates > 1) film_.reserveOpenBlocks();
    plan_ = {image::allTiles(film_), goal(), !settings.sppIsKnown};
    isPart_ = false;
    pool_.reset();
    localRank_.emplace(*local_, *scene_, settings_);
    awaitReady();
}

// Time is counted from the first samples on, and all begin together, if nobody takes far longer to get ready.
void RankedEngine::awaitReady() {
    const auto isMissing = [](const RankState& state) { return !state.isReady; };
    receiveWhile([&] { return !failure_ && std::any_of(states_.begin(), states_.end(), isMissing); }, kStart);
}

RenderStatus RankedEngine::renderSome(const Budget& budget) {
    if (!pool_) pool_.emplace(film_, plan_, states_.size());
    const Stopwatch watch;
    while (!pool_->isDone() || planSamples(budget.cancel)) {
        if (budget.cancel != nullptr && budget.cancel->load(std::memory_order_relaxed)) break;
        const bool isBusy = receiveAll();
        if (failure_) throw *failure_;
        for (std::size_t rank = 0; rank < states_.size(); ++rank)
            if (!pool_->isLeased(rank)) lease(rank);
        for (std::size_t rank = 0; rank < states_.size(); ++rank) lease(rank); // ahead
        if (watch.seconds() >= budget.time.count()) break;
        if (isBusy)
            idle_.wake();
        else
            localRank_->wait(idle_.next());
    }
    sampling_ += watch.seconds();
    return status();
}

// Decides on the samples of an adaptive film, whose pilot is done. False: there is nothing to decide, or cancelled.
bool RankedEngine::planSamples(const std::atomic<bool>* cancel) {
    if (isPart_ || !film_.isPilot()) return false;
    const shared::Features features = report().features;
    std::vector<std::uint32_t> plan =
        image::makeSamplePlan(film_, settings_.spp, dependentSide(features), {.cancel = cancel});
    if (plan.empty()) return false;
    film_.setPlan(std::move(plan));
    plan_.spp = goal();
    for (std::size_t rank = 0; rank < states_.size(); ++rank) // who was overdue; others have done its tiles
        if (pool_->isLeased(rank)) send(rank, {MessageKind::Recall, nullptr, {}});
    pool_->goOn(plan_);
    return true;
}

const image::Film& RankedEngine::film() {
    if (!pool_ || pool_->isDone()) return film_;
    const auto isAwaited = [this](std::size_t rank) { return pool_->isLeased(rank) && !states_[rank].isSilent; };
    std::vector<std::size_t> awaited;
    for (std::size_t rank = 0; rank < states_.size(); ++rank) {
        if (!isAwaited(rank)) continue;
        send(rank, {MessageKind::Recall, nullptr, {}});
        awaited.push_back(rank);
    }
    const auto isAnyAwaited = [&] { return std::erase_if(awaited, std::not_fn(isAwaited)), !awaited.empty(); };
    receiveWhile(isAnyAwaited, kRecall);
    for (const std::size_t rank : awaited) states_[rank].isSilent = true;
    return film_;
}

void RankedEngine::send(std::size_t rank, Message message) {
    if (rank == 0) return localRank_->send(std::move(message));
    Bytes bytes = toBytes(std::move(message));
    states_[rank].figures.bytes += bytes.size();
    ranks_.send(static_cast<int>(rank), std::move(bytes));
}

// What has arrived; whether there was anything.
bool RankedEngine::receiveAll() {
    bool any = false;
    while (localRank_) {
        const std::optional<Message> message = localRank_->receive();
        if (!message) break;
        receive(0, *message);
        any = true;
    }
    while (std::optional<Received> received = ranks_.receive()) {
        const auto rank = static_cast<std::size_t>(received->from);
        states_[rank].figures.bytes += received->message.size();
        receive(rank, toMessage(std::move(received->message)));
        any = true;
    }
    return any;
}

// For so many seconds at most.
void RankedEngine::receiveWhile(const std::function<bool()>& isWaiting, double seconds) {
    const Stopwatch watch;
    while (isWaiting() && watch.seconds() < seconds)
        if (!receiveAll()) std::this_thread::sleep_for(kPollInterval);
}

void RankedEngine::receive(std::size_t rank, const Message& message) {
    states_[rank].isSilent = false;
    if (message.kind == MessageKind::Ready) greet(rank, message.fields);
    if (message.kind == MessageKind::Result) takeResult(rank, message);
    if (message.kind != MessageKind::Failure) return;
    const std::string where = rank == 0 ? "" : "rank " + std::to_string(rank) + ": ";
    fail(rank, Error(static_cast<ExitCode>(message.fields.at("code").get<int>()),
                     where + message.fields.at("what").get<std::string>()));
}

// Is thrown by the next renderSome().
void RankedEngine::fail(std::size_t rank, const Error& error) {
    states_[rank].isReady = false;
    if (pool_) pool_->giveUp(rank, clock_.seconds());
    if (!failure_) failure_ = error;
}

// All must make the same bits.
void RankedEngine::greet(std::size_t rank, const nlohmann::json& fields) {
    RankState& state = states_[rank];
    state.report = toReport(fields.at("report"));
    const EngineReport mine = local_->report();
    const std::string name = "rank " + std::to_string(rank) + " (" + state.report.device + ")";
    if (engineKind(state.report) != engineKind(mine))
        return fail(rank,
                    UsageError(name + " renders with the engine " + engineKind(state.report) + ", but rank 0 with " +
                               engineKind(mine) + ": say --engine, and start one program only"));
    if (fields.at("scene") != scene_->hash || fields.at("width") != settings_.width ||
        fields.at("height") != settings_.height)
        return fail(rank, InputError(name + " has another scene than rank 0: are the files of its host the same?"));
    const bool isAlike =
        mine.threads > 0 ? instructionSet(state.report) == instructionSet(mine) : state.report.device == mine.device;
    if (!isAlike)
        logWarning(name + " is unlike rank 0's " + mine.device + ": the last bits of its tiles may be others");
    send(rank, {MessageKind::Begin,
                {{"second_moments", settings_.secondMoments}, {"spp_is_known", settings_.sppIsKnown}},
                {}});
    state.isReady = true;
}

void RankedEngine::takeResult(std::size_t rank, const Message& message) {
    image::unpackTiles(message.tiles, film_);
    RankState& state = states_[rank];
    state.report = toReport(message.fields.at("report"));
    const std::uint64_t samples = message.fields.at("samples");
    const double busy = message.fields.at("busy");
    state.figures.samples += samples;
    state.figures.busySeconds += busy;
    idle_.leaseTook(busy);
    pool_->giveBack(rank, message.fields.at("id"), samples, busy, clock_.seconds());
}

void RankedEngine::lease(std::size_t rank) {
    const RankState& state = states_[rank];
    if (!state.isReady || state.isSilent) return;
    const std::uint32_t minimum = state.report.threads > 0 ? kTilesOfThread * state.report.threads : kTilesOfDevice;
    const std::optional<Lease> lease = pool_->lease(rank, minimum, clock_.seconds());
    if (!lease) return;
    if (const auto& recalled = pool_->recalled())
        send(recalled->rank, {MessageKind::Recall, {{"id", recalled->id}}, {}});
    send(rank, {MessageKind::Lease,
                {{"tiles", lease->tiles}, {"spp", lease->spp}, {"seconds", lease->seconds}, {"id", lease->id}},
                image::packTiles(film_, lease->tiles)});
}

RenderStatus RankedEngine::status() const {
    const bool isDone = pool_->isDone() && (isPart_ || !film_.isPilot());
    const std::uint64_t done = image::totalSamples(film_, plan_.tiles);
    const std::uint64_t total = image::pixelCount(film_, plan_.tiles) * (isPart_ ? plan_.spp : settings_.spp);
    return {isDone, done, total};
}

// Sums over the ranks; what they must have in common is that of rank 0.
EngineReport RankedEngine::report() const {
    EngineReport report = states_[0].isReady ? states_[0].report : local_->report();
    if (!pool_) return report;
    report.rays = {};
    report.nonfiniteSamples = 0;
    report.cutOff = 0;
    for (const RankState& state : states_) {
        report.rays += state.report.rays;
        report.nonfiniteSamples += state.report.nonfiniteSamples;
        report.cutOff += state.report.cutOff;
        RankFigures figures = state.figures;
        figures.device = state.report.device;
        figures.threads = state.report.threads;
        figures.busyShare = sampling_ > 0 ? std::min(1.0, figures.busySeconds / sampling_) : 0;
        report.ranks.push_back(figures);
    }
    return report;
}

} // namespace

std::unique_ptr<Engine> makeRankedEngine(std::unique_ptr<Engine> local, Communicator& ranks) {
    return std::make_unique<RankedEngine>(std::move(local), ranks);
}

} // namespace rt::app
