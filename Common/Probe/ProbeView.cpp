#include "Common/Probe/ProbeView.h"

#include <chrono>
#include <exception>
#include <filesystem>

#include "Common/Core/AtomicFile.h"
#include "Common/Core/Error.h"
#include "Common/Probe/ProbeReport.h"
#include "Common/Scene/CameraRecord.h"

namespace rt::probe {
namespace {

constexpr double kPublishSeconds = 0.06; // between two results of one wish

std::optional<Probe> placeOf(const ProbeWish& wish, const SceneFormulas& formulas) {
    const shared::Camera camera =
        scene::makeCamera(wish.camera, wish.rendering.width, wish.rendering.height, wish.scene->origin);
    return Probe::at(formulas, camera, wish.pixel[0], wish.pixel[1]);
}

std::string whyNothingAt(const std::optional<Probe>& probe, const Strategy& strategy) {
    if (!probe) return "The pixel shows no surface";
    const bool isOfOther =
        strategy.kind == StrategyKind::Light && strategy.light >= probe->scene().compiled()->globals.lightCount;
    return isOfOther ? "The scene has no light " + std::to_string(strategy.light) : probe->whyNoDensity(strategy);
}

ProbeSaved saveWish(const std::string& file, ProbeWish wish, const std::atomic<bool>& isGivenUp) {
    wish.settings.projections = {Projection::Sphere, Projection::Hemisphere};
    try {
        const auto formulas = formulasFor(wish.scene, wish.rendering);
        if (!formulas->prepare(isGivenUp)) return {file, ""};
        const std::optional<Probe> probe = placeOf(wish, *formulas);
        if (std::string why = whyNothingAt(probe, wish.settings.strategy); !why.empty()) return {file, std::move(why)};
        ProbeRun work(*probe, wish.settings);
        while (!work.isDone()) {
            if (isGivenUp) return {file, ""};
            work.advance();
        }
        const ProbeResult result = work.result();
        writePicture(file, result);
        const std::string figures = figuresOf(result, wish.scene->id, wish.pixel).dump(2) + "\n";
        AtomicFile beside(std::filesystem::path(file).replace_extension(".json"));
        beside.stream() << figures;
        beside.commit();
        return {file, ""};
    } catch (const std::exception& error) {
        return {file, messageOf(error)};
    }
}

} // namespace

ProbeView::ProbeView(std::function<void()> onChange)
    : onChange_(std::move(onChange)), wishes_([this](const ProbeWish* wish) { work(wish); }, onChange_) {}

ProbeView::~ProbeView() {
    isGivenUp_ = true;
    if (saving_.valid()) saving_.wait();
}

void ProbeView::save(const std::string& file, const ProbeWish& wish) {
    if (isSaving()) return;
    saving_ = std::async(std::launch::async, [this, file, wish] {
        ProbeSaved saved = saveWish(file, wish, isGivenUp_);
        onChange_();
        return saved;
    });
}

std::optional<ProbeSaved> ProbeView::takeSaved() {
    if (!saving_.valid() || saving_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return std::nullopt;
    return saving_.get();
}

void ProbeView::work(const ProbeWish* wish) {
    if (wish == nullptr) {
        formulas_.reset(); // with its acceleration structure
        return;
    }
    try {
        answer(*wish);
    } catch (const std::exception& error) {
        formulas_.reset();
        wishes_.publish(*wish, messageOf(error), {});
    }
}

void ProbeView::answer(const ProbeWish& wish) {
    formulas_ = formulasFor(wish.scene, wish.rendering, std::move(formulas_));
    if (!formulas_->prepare(wishes_.isSceneStale())) return;
    const std::optional<Probe> probe = placeOf(wish, *formulas_);
    if (std::string why = whyNothingAt(probe, wish.settings.strategy); !why.empty())
        return wishes_.publish(wish, std::move(why), {});
    ProbeRun work(*probe, wish.settings);
    wishes_.advance(work, kPublishSeconds, [&] { wishes_.publish(wish, "", work.result()); });
}

} // namespace rt::probe
