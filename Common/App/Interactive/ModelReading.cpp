#include "Common/App/Interactive/ModelReading.h"

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <utility>

#include "Common/Core/Error.h"
#include "Common/Core/Interruption.h"
#include "Common/Core/Printable.h"
#include "Common/Core/ReadFile.h"
#include "Common/Scene/AddedModels.h"
#include "Common/Scene/ModelFile.h"
#include "Common/Scene/ModelPlace.h"

namespace rt::app {
namespace {

namespace fs = std::filesystem;

bool isReadByNow(const std::future<scene::SetModel>& future) {
    return future.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
}

scene::SetModel readToAdd(const std::string& name, const std::string& file) {
    std::error_code none;
    if (!fs::exists(file, none)) throw InputError(printable(file) + ": there is no such file");
    if (!scene::isModelFile(file) && scene::kindOfFile(file) != ".json")
        throw InputError(printable(file) + ": must be a file of glTF, OBJ or pbrt, or a scene file");
    const scene::ModelDesc model{file, {}, 0};
    scene::ModelContents contents = scene::readModel(name, model);
    if (contents.prototypes.at(name).empty()) throw InputError(printable(file) + ": there is nothing in it to add");
    return {name, model, std::move(contents)};
}

} // namespace

std::string wholePath(const std::string& file) {
    std::error_code none;
    return fs::absolute(file, none).lexically_normal().generic_string();
}

void ModelReading::start(const std::string& name, const std::string& file, const std::string& assetsBelow) {
    stop();
    file_ = wholePath(file);
    callOff_ = std::make_shared<std::atomic<bool>>(false);
    reading_ = std::async(std::launch::async, [name, whole = file_, assetsBelow, callOff = callOff_] {
        const Interruptible interruptible(*callOff);
        const ReadsBelow confined(assetsBelow, whole);
        return readToAdd(name, whole);
    });
}

void ModelReading::stop() {
    if (callOff_) *callOff_ = true;
    if (reading_.valid()) unwanted_.push_back(std::move(reading_));
    reading_ = {};
    std::erase_if(unwanted_, isReadByNow);
}

std::optional<scene::SetModel> ModelReading::take() {
    if (!reading_.valid() || !isReadByNow(reading_)) return std::nullopt;
    return reading_.get();
}

std::string modelOfFile(const scene::SceneDesc& scene, const std::string& file) {
    const scene::ModelDesc wanted{wholePath(file), {}, 0};
    const auto found = std::find_if(scene.models.begin(), scene.models.end(),
                                    [&](const auto& entry) { return entry.second == wanted; });
    return found != scene.models.end() ? found->first : std::string();
}

std::vector<scene::SceneEdit> editsToAdd(const scene::SceneDesc& scene, const std::string& name,
                                         std::optional<scene::SetModel> model, const scene::Bounds& bounds,
                                         const scene::CameraDesc& camera) {
    const auto& prototypes = model ? model->contents.prototypes : scene.prototypes;
    const scene::Bounds own = boundsOfPrototype(prototypes, name);
    scene::InstanceDesc instance{name, placeOfModel(own, bounds, camera), {}};
    std::vector<scene::SceneEdit> edits;
    if (model) edits.emplace_back(std::move(*model));
    const scene::ObjectPath path{"", {static_cast<std::uint32_t>(scene.objects.size())}};
    edits.emplace_back(scene::PlaceObject{path, scene::ObjectDesc{std::move(instance)}});
    return edits;
}

std::vector<scene::SceneEdit> editsToDrop(const scene::SceneDesc& scene,
                                          const std::vector<scene::ObjectPath>& objects) {
    std::vector<scene::SceneEdit> edits;
    for (const auto& [name, model] : scene.models) {
        std::size_t uses = 0; // by the objects that go
        for (const scene::ObjectPath& path : objects) {
            const scene::ObjectDesc* object = findObject(scene, path);
            const auto* instance = object != nullptr ? std::get_if<scene::InstanceDesc>(&object->shape) : nullptr;
            uses += instance != nullptr && instance->prototype == name && instance->material.empty();
        }
        if (uses > 0 && uses == modelUses(scene, name)) edits.emplace_back(scene::SetModel{name, std::nullopt, {}});
    }
    return edits;
}

} // namespace rt::app
