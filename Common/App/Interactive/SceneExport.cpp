#include "Common/App/Interactive/SceneExport.h"

#include <chrono>
#include <filesystem>

#include "Common/App/Session/Outputs.h"
#include "Common/App/Session/SceneSource.h"
#include "Common/Core/Interruption.h"
#include "Common/Core/ReadFile.h"
#include "Common/Scene/Json/SceneJson.h"

namespace rt::app {

SceneExport::~SceneExport() {
    callOff_ = true;
}

void SceneExport::start(const std::string& source, const scene::Moment& moment, const std::string& assetsBelow,
                        const std::string& file) {
    if (file_.valid()) file_.wait();
    file_ = std::async(std::launch::async, [this, source, moment, assetsBelow, file] {
        const Interruptible interruptible(callOff_);
        const ReadsBelow confined(assetsBelow, source);
        writeText(file, scene::toJson(loadScene(source, moment)));
        return file;
    });
}

std::optional<std::string> SceneExport::takeResult() {
    const bool isDone = file_.valid() && file_.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
    if (!isDone) return std::nullopt;
    return file_.get();
}

} // namespace rt::app
