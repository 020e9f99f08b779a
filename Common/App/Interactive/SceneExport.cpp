#include "Common/App/Interactive/SceneExport.h"

#include <chrono>
#include <memory>
#include <utility>

#include "Common/App/Interactive/SceneFileText.h"
#include "Common/App/Session/Outputs.h"
#include "Common/App/Session/SceneOutput.h"
#include "Common/App/Session/SceneSource.h"
#include "Common/Core/Interruption.h"
#include "Common/Core/ReadFile.h"

namespace rt::app {

SceneExport::~SceneExport() {
    callOff_ = true;
}

void SceneExport::run(std::function<std::vector<std::string>()> write, const std::string& source,
                      const std::string& assetsBelow, const std::string& file) {
    if (result_.valid()) result_.wait();
    result_ = std::async(std::launch::async, [this, write = std::move(write), source, assetsBelow, file] {
        const Interruptible interruptible(callOff_);
        const ReadsBelow confined(assetsBelow, source);
        return Result{file, write()};
    });
}

void SceneExport::start(const std::string& source, const scene::Moment& moment, const std::string& assetsBelow,
                        const std::string& file) {
    run([source, moment, file] { return writeScene(file, loadScene(source, moment)); }, source, assetsBelow, file);
}

void SceneExport::start(scene::SceneDesc scene, const std::string& source, const std::string& assetsBelow,
                        const std::string& file) {
    const auto kept = std::make_shared<const scene::SceneDesc>(std::move(scene));
    run([kept, file] { return writeScene(file, *kept); }, source, assetsBelow, file);
}

void SceneExport::startEdited(scene::SceneDesc scene, const std::string& source, const scene::Moment& moment,
                              const std::string& assetsBelow, const std::string& file) {
    const auto kept = std::make_shared<const scene::SceneDesc>(std::move(scene));
    const auto write = [kept, source, moment, file] {
        writeText(file, sceneFileText(*kept, source, moment, file));
        return std::vector<std::string>();
    };
    run(write, source, assetsBelow, file);
}

std::optional<SceneExport::Result> SceneExport::takeResult() {
    const bool isDone = result_.valid() && result_.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
    if (!isDone) return std::nullopt;
    return result_.get();
}

} // namespace rt::app
