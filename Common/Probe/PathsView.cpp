#include "Common/Probe/PathsView.h"

#include <exception>

#include "Common/Core/Error.h"
#include "Common/Probe/NextHit.h"

namespace rt::probe {
namespace {

constexpr double kPathsPublishSeconds = 0.1; // between two results of one wish
constexpr std::size_t kPieces = 16;          // of a path between two of its points
constexpr float kNearEnd = 1e-3f;            // of the way to a piece: what is closer to it hides nothing

bool isOfSameSamples(const PathsWish& a, PathsWish b) {
    b.eye = a.eye;
    return a == b;
}

bool isHiddenFrom(const SceneFormulas& scene, const shared::vec3& eye, const shared::vec3& point) {
    const shared::vec3 way = point - eye;
    const float distance = glm::length(way);
    if (!(distance > 0)) return false;
    const shared::Ray ray{eye, way / distance, 0.0f};
    return nextHit(scene, shared::kFeatureNone, ray, {}, 0u, distance * (1 - kNearEnd)).t >= 0.0f;
}

} // namespace

std::vector<PathLine> linesSeenFrom(const SceneFormulas& scene, const glm::dvec3& eye,
                                    const std::vector<ListedPath>& paths) {
    const shared::vec3 from = scene.toScene(shared::vec3(eye));
    std::vector<PathLine> lines;
    for (std::size_t path = 0; path < paths.size(); ++path) {
        const std::vector<PathPoint>& points = paths[path].found.line;
        lines.push_back({path, {}});
        for (std::size_t i = 0; i + 1 < points.size(); ++i) {
            const shared::vec3 begin = points[i].position, way = points[i + 1].position - begin;
            for (std::size_t k = 0; k < kPieces; ++k) {
                const auto at = [&](float place) { return begin + way * (place / float{kPieces}); };
                const auto first = static_cast<float>(k);
                const shared::vec3 end = k + 1 < kPieces ? at(first + 1) : points[i + 1].position;
                const bool isHidden = isHiddenFrom(scene, from, scene.toScene(at(first + 0.5f)));
                lines.back().pieces.push_back({at(first), end, isHidden});
            }
        }
    }
    return lines;
}

PathsView::PathsView(std::function<void()> onChange)
    : wishes_([this](const PathsWish* wish) { work(wish); }, std::move(onChange)) {}

void PathsView::work(const PathsWish* wish) {
    try {
        if (wish != nullptr) return answer(*wish);
    } catch (const std::exception& error) {
        wishes_.publish(*wish, messageOf(error), {});
    }
    formulas_.reset(); // with its acceleration structure
    done_.reset();
}

PathsShown PathsView::shownOf(const PathsWish& wish, PathsResult result) const {
    PathsShown shown{std::move(result), {}};
    shown.lines = linesSeenFrom(*formulas_, wish.eye, shown.paths());
    return shown;
}

void PathsView::answer(const PathsWish& wish) {
    formulas_ = formulasFor(wish.scene, wish.rendering, std::move(formulas_));
    if (!formulas_->prepare(wishes_.isSceneStale())) return;
    if (done_ && isOfSameSamples(wish, done_->wish)) // the camera has moved alone
        return wishes_.publish(wish, "", shownOf(wish, done_->result.result));
    done_.reset();
    PathsRun run(*formulas_, wish.camera, wish.pixel[0], wish.pixel[1], wish.settings);
    wishes_.advance(run, kPathsPublishSeconds, [&] {
        PathsShown shown = shownOf(wish, run.result());
        if (run.isDone()) done_ = PathsState{wish, "", shown, 0};
        wishes_.publish(wish, "", std::move(shown));
    });
}

} // namespace rt::probe
