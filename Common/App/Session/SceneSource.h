// From what --scene names to a scene.
#pragma once
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

#include "Common/App/Session/SceneImages.h"
#include "Common/Render/ShutterEngine.h"
#include "Common/Scene/CompiledScene.h"
#include "Common/Scene/Moment.h"
#include "Common/Scene/SceneDesc.h"

namespace rt::scene {
struct CompileMemory;
}

namespace rt::app {

// A .json scene file, an .obj, .gltf, .glb or .pbrt file, by a path of its own or within the assets' folder "scenes",
// or the id of a built-in scene. A model that brings no light stands in a studio (Studio.h), which is the same at all
// moments. Throws InputError, and UsageError for an animation that there is not.
scene::SceneDesc loadScene(const std::string& source, const scene::Moment& moment = {});

// With its textures; with generated ones in place of files that have a stand-in, where asked for. `camera`: a pose or
// name, as --camera takes it; empty: the scene's own. Throws InputError, and UsageError for a camera that there is not.
std::shared_ptr<const scene::CompiledScene> compile(const scene::SceneDesc& desc, bool oneSidedLights,
                                                    bool generatedAssets = false, const std::string& camera = {});

// What --scene and the flags beside it ask for.
struct SceneRequest {
    std::string source; // id or file, as --scene takes it
    bool oneSidedLights = true;
    std::string pose = {};        // or name of the camera, as --camera takes it; empty: the scene's own
    std::string assetsBelow = {}; // the folder that the scene's files must lie in; empty: anywhere
    scene::Moment moment = {};    // as --animation and --time say
    scene::Shutter shutter = {};  // about that moment; for a window, see LoadedScene::poses
    std::uint64_t edits = 0;      // grows with what has been edited since; 0: the scene is as the source has it
    std::uint64_t poses = 0;      // grows with each moment that was wished since it was opened; 0: none was
    bool operator==(const SceneRequest&) const = default;
};
std::shared_ptr<const scene::CompiledScene> compile(const SceneRequest& request);
// Of a scene that is at hand, in place of what the request's source names.
std::shared_ptr<const scene::CompiledScene> compile(scene::SceneDesc desc, const SceneRequest& request);
// Of a description that is edited and stays: in place of what the request's source names. `memory`: of the compilation
// before, or null.
std::shared_ptr<const scene::CompiledScene> compileKept(const scene::SceneDesc& desc, const SceneRequest& request,
                                                        scene::CompileMemory* memory,
                                                        const TexelLoader& loadTexels = {});

// The file that a source names: itself, or the assets' file of this name.
std::filesystem::path fileNamedBy(const std::string& source);

// The moment from the start of an animation, also where it comes after one that a scene file imports a model at.
scene::Moment wholeMoment(const SceneRequest& request);

// The request's scene at any time of its animation: its file is read once. None where nothing moves, whatever the time.
// Both throw what compile() throws.
PoseScene posesOf(const SceneRequest& request);

// The camera of a pose that may leave parts of it to the scene. Throws UsageError.
scene::CameraDesc poseOf(const std::string& pose, const scene::CameraDesc& scenes);

// Whether --camera takes the text for a pose, and not for the name of a camera.
bool isPose(const std::string& text);

// What --camera names: a pose, or one of the scene's cameras by its name. Throws UsageError.
scene::CameraDesc cameraOf(const std::string& text, const scene::SceneDesc& scene);

// Ids and titles, one a line or as JSON: [{"id": …, "title": …, "description": …}].
std::string listScenes(bool json);

} // namespace rt::app
