#include "Common/App/Session/PosedScene.h"

#include <utility>

#include "Common/Core/ReadFile.h"

namespace rt::app {

PosedScene::PosedScene(SceneRequest request) : request_(std::move(request)), mark_(markOf(request_.source)) {
    const ReadsBelow confined(request_.assetsBelow, request_.source);
    if (scene::isGltfFile(request_.source)) {
        model_ = std::make_unique<scene::AnimatedModel>(fileNamedBy(request_.source));
        isAnimated_ = model_->isAnimated();
    } else if (scene::kindOfFile(request_.source) == ".json") {
        file_ = std::make_unique<scene::PosedSceneFile>(fileNamedBy(request_.source));
        isAnimated_ = file_->isAnimated();
    }
}

bool PosedScene::isOf(const SceneRequest& request) const {
    return request.source == request_.source && request.oneSidedLights == request_.oneSidedLights &&
           request.pose == request_.pose && request.assetsBelow == request_.assetsBelow;
}

scene::SceneDesc PosedScene::describe(const scene::Moment& moment) {
    return model_ ? model_->at(moment) : file_ ? file_->at(moment) : loadScene(request_.source, moment);
}

// Until a compilation succeeds meshes of those before must stay, as the memory knows them by where they lie.
std::shared_ptr<const scene::CompiledScene> PosedScene::at(const scene::Moment& moment) {
    const std::scoped_lock lock(mutex_);
    const ReadsBelow confined(request_.assetsBelow, request_.source);
    described_.push_back(std::make_unique<const scene::SceneDesc>(describe(moment)));
    auto scene = compileKept(*described_.back(), request_, &memory_, loadTexels_);
    described_.erase(described_.begin(), described_.end() - 1);
    return scene;
}

PoseScene posesOf(std::shared_ptr<PosedScene> scene, const scene::Moment& moment) {
    return [scene = std::move(scene), moment](double seconds) {
        scene::Moment at = moment;
        at.time = seconds;
        at.isAsked = at.isWhole = true;
        return scene->at(at);
    };
}

} // namespace rt::app
