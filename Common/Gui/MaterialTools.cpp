#include "Common/Gui/MaterialTools.h"

#include <filesystem>
#include <utility>

#include "Common/App/Interactive/VisibleSurface.h"
#include "Common/App/Session/Outputs.h"
#include "Common/Core/Error.h"
#include "Common/Core/Log.h"
#include "Common/Core/ReadFile.h"
#include "Common/Core/TextSearch.h"
#include "Common/Gui/Gui.h"
#include "Common/Scene/Edit/MaterialTransfer.h"
#include "Common/Scene/MaterialX/MaterialXLoader.h"
#include "Common/Scene/MaterialX/MaterialXWriter.h"

namespace rt::gui {
namespace {

namespace fs = std::filesystem;

constexpr const char* kNoSurface = "What is there has no material of its own";

// Once the description of the scene is there.
void askDescription(Gui& gui, MaterialTools::Take take) {
    gui.editor.begin();
    gui.materials.question = MaterialTools::Question{std::nullopt, std::move(take), {}};
}

void giveSelection(Gui& gui, const std::string& material) {
    const std::vector<scene::ObjectPath>& objects = gui.editor.selected().paths();
    const scene::SceneDesc& scene = gui.editor.document()->scene();
    scene::MaterialTransfer transfer(scene, scene);
    if (objects.empty()) return gui.say("Nothing is selected: no object gets \"" + material + "\"");
    if (!transfer.assign(objects, material)) return gui.say(kNoSurface);
    std::vector<scene::SceneEdit> edits = transfer.takeEdits();
    if (edits.empty() || editScene(gui, "Assign " + material, std::move(edits), false))
        gui.say("Material \"" + material + "\"");
}

// All materials of a document, of which the objects get the first.
void takeMaterials(Gui& gui, const std::string& file, const std::vector<scene::ObjectPath>& objects) {
    try {
        const ReadsBelow confined(gui.assetsBelow, file);
        const scene::SceneDesc source = scene::loadMaterialX(file);
        scene::MaterialTransfer transfer(gui.editor.document()->scene(), source);
        std::string first, names;
        for (const auto& [name, material] : source.materials) {
            const std::string own = transfer.bring(name);
            if (first.empty()) first = own;
            names += (names.empty() ? "\"" : ", \"") + own + "\"";
        }
        const bool isAssigned = transfer.assign(objects, first);
        gui.materials.notices = source.notices;
        std::vector<scene::SceneEdit> edits = transfer.takeEdits();
        if (!edits.empty() && !editScene(gui, "Open " + fs::path(file).filename().string(), std::move(edits), false))
            return;
        gui.say((isAssigned ? "Assigned " : "The scene has now ") + (isAssigned ? '"' + first + '"' : names));
    } catch (const Error& error) {
        gui.fail(error.what(), app::ErrorSource::Scene);
    }
}

} // namespace

void askPicture(Gui& gui, const std::array<std::uint32_t, 2>& pixel, MaterialTools::Take take,
                std::function<void(Gui&)> takeSky) {
    const image::Image* picture = gui.state.picture.image.get();
    if (picture == nullptr || !gui.state.scene) return;
    gui.editor.begin();
    const SceneEditing::Click place{gui.camera.camera(), pixel, {picture->width, picture->height}, false};
    gui.materials.question = MaterialTools::Question{place, std::move(take), std::move(takeSky)};
}

std::string materialSeen(const scene::SceneDesc& scene, const scene::ObjectPath& path, const std::string& shown) {
    const scene::ObjectDesc* object = findObject(scene, path);
    const std::string* own = object != nullptr ? materialNameOf(*object) : nullptr;
    if (own != nullptr && !own->empty()) return *own;
    return scene.materials.contains(shown) ? shown : "";
}

void followMaterials(Gui& gui) {
    MaterialTools& tools = gui.materials;
    if (tools.isPicking && !gui.editor.selection()) tools.isPicking = false;
    if (!tools.question || !gui.editor.isInStep(gui.state)) return;
    const MaterialTools::Question question = *std::exchange(tools.question, std::nullopt);
    if (!question.place) return question.take(gui, {}, {});
    const auto& [camera, pixel, size, isAdded] = *question.place;
    const auto surface = app::visibleSurface(*gui.state.scene, camera, {size[0], size[1]}, {pixel[0], pixel[1]});
    if (!surface) return question.takeSky ? question.takeSky(gui) : gui.say("There is no object");
    question.take(gui, pathOfLeaf(gui.editor.document()->scene(), surface->object),
                  gui.state.scene->materialNames[surface->material]);
}

const std::vector<app::MaterialPreset>& materialPresets(Gui& gui) {
    auto& presets = gui.materials.presets;
    if (presets) return *presets;
    std::vector<std::string> failures;
    presets = app::readMaterialPresets(app::materialPresetFolder(), failures);
    for (const std::string& failure : failures) logWarning(failure);
    return *presets;
}

void giveMaterial(Gui& gui, const std::vector<scene::ObjectPath>& objects, const scene::SceneDesc& source,
                  const std::string& material) {
    if (gui.editor.document() == nullptr) return;
    scene::MaterialTransfer transfer(gui.editor.document()->scene(), source);
    const std::string name = transfer.bring(material);
    if (!transfer.assign(objects, name)) return gui.say(kNoSurface);
    std::vector<scene::SceneEdit> edits = transfer.takeEdits();
    if (edits.empty() || editScene(gui, "Assign " + name, std::move(edits), false))
        gui.say("Material \"" + name + "\"");
}

void dropMaterial(Gui& gui, const std::optional<std::array<std::uint32_t, 2>>& pixel) {
    if (const std::string file = std::exchange(gui.materials.droppedFile, {}); !file.empty()) {
        if (isImageFile(file)) return pixel ? dropImage(gui, file, *pixel) : void(gui.added.droppedImage = file);
        const auto open = [file](Gui& g, const scene::ObjectPath& path, const std::string&) {
            takeMaterials(g, file, {path});
        };
        return pixel ? askPicture(gui, *pixel, open) : openMaterials(gui, file);
    }
    if (!gui.materials.dragged) return;
    const std::size_t index = *std::exchange(gui.materials.dragged, std::nullopt);
    if (!pixel) return;
    askPicture(gui, *pixel, [index](Gui& g, const scene::ObjectPath& path, const std::string&) {
        const app::MaterialPreset& preset = materialPresets(g)[index];
        giveMaterial(g, {path}, *preset.scene, preset.name);
    });
}

void beginPipette(Gui& gui) {
    gui.materials.isPicking = true;
    gui.say("Pipette: click what has the material that the selected object is to get; Escape leaves it");
}

void pickMaterial(Gui& gui, const std::array<std::uint32_t, 2>& pixel) {
    gui.materials.isPicking = false;
    askPicture(gui, pixel, [](Gui& g, const scene::ObjectPath& path, const std::string& shown) {
        const std::string name = materialSeen(g.editor.document()->scene(), path, shown);
        name.empty() ? g.say("That material is of a model's file, not of the scene") : giveSelection(g, name);
    });
}

bool isMaterialFile(const std::string& file) {
    return lowerCase(fs::path(file).extension().string()) == ".mtlx";
}

void openMaterials(Gui& gui, const std::string& file) {
    askDescription(gui, [file](Gui& g, const scene::ObjectPath&, const std::string&) {
        takeMaterials(g, file, g.editor.selected().paths());
    });
}

std::string selectedMaterial(const Gui& gui) {
    for (const scene::ObjectPath& path : gui.editor.selected().paths())
        if (const std::string* own = materialNameOf(*findObject(gui.editor.document()->scene(), path)))
            if (gui.editor.document()->scene().materials.contains(*own)) return *own;
    return {};
}

void saveMaterial(Gui& gui, const std::string& file) {
    const std::string name = selectedMaterial(gui);
    if (name.empty()) return gui.say("Nothing with a material is selected");
    try {
        std::vector<std::string> notices;
        const fs::path folder = fs::path(file).parent_path();
        app::writeText(file, scene::toMaterialX(gui.editor.document()->scene(), name, folder, notices));
        gui.materials.notices = std::move(notices);
        gui.say("Saved " + file);
    } catch (const Error& error) {
        gui.fail(error.what(), app::ErrorSource::Save);
    }
}

} // namespace rt::gui
