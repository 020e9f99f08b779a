#include "Common/App/Interactive/SceneExport.h"

#include <chrono>
#include <filesystem>
#include <memory>
#include <utility>

#include "Common/App/Session/SceneOutput.h"
#include "Common/App/Session/SceneSource.h"
#include "Common/Core/Interruption.h"
#include "Common/Core/ReadFile.h"

namespace rt::app {

SceneExport::~SceneExport() {
    callOff_ = true;
}

void SceneExport::run(std::function<scene::SceneDesc()> load, const std::string& source, const std::string& assetsBelow,
                      const std::string& file) {
    if (result_.valid()) result_.wait();
    result_ = std::async(std::launch::async, [this, load = std::move(load), source, assetsBelow, file] {
        const Interruptible interruptible(callOff_);
        const ReadsBelow confined(assetsBelow, source);
        return Result{file, writeScene(file, load())};
    });
}

void SceneExport::start(const std::string& source, const scene::Moment& moment, const std::string& assetsBelow,
                        const std::string& file) {
    run([source, moment] { return loadScene(source, moment); }, source, assetsBelow, file);
}

void SceneExport::start(scene::SceneDesc scene, const std::string& source, const std::string& assetsBelow,
                        const std::string& file) {
    const auto kept = std::make_shared<scene::SceneDesc>(std::move(scene));
    run([kept] { return std::move(*kept); }, source, assetsBelow, file);
}

std::optional<SceneExport::Result> SceneExport::takeResult() {
    const bool isDone = result_.valid() && result_.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
    if (!isDone) return std::nullopt;
    return result_.get();
}

} // namespace rt::app
