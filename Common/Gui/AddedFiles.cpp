#include "Common/Gui/AddedFiles.h"

#include <algorithm>
#include <exception>
#include <filesystem>
#include <iterator>
#include <string_view>
#include <utility>
#include <vector>

#include <imgui.h>

#include "Common/Core/Error.h"
#include "Common/Core/Printable.h"
#include "Common/Core/TextSearch.h"
#include "Common/Gui/Gui.h"
#include "Common/Gui/Widgets.h"
#include "Common/Scene/Edit/EditCheck.h"
#include "Common/Scene/Edit/MaterialTransfer.h"

namespace rt::gui {
namespace {

namespace fs = std::filesystem;

std::string shortName(const std::string& file) {
    return fs::path(file).filename().string();
}

scene::Bounds shownBounds(const Gui& gui) {
    if (!gui.state.scene) return {};
    return {gui.state.scene->lower, gui.state.scene->upper};
}

// As one step; afterwards it is selected.
void placeModel(Gui& gui, const std::string& name, std::optional<scene::SetModel> model) {
    const scene::SceneDesc& scene = gui.editor.document()->scene();
    const scene::ObjectPath path{"", {static_cast<std::uint32_t>(scene.objects.size())}};
    const std::string file = shortName(model ? model->value->file : scene.models.at(name).file);
    std::string told = "Added " + file;
    if (model && !model->contents.notices.empty()) told += ": " + model->contents.notices.front();
    auto edits = app::editsToAdd(scene, name, std::move(model), shownBounds(gui), gui.camera.camera());
    if (!editScene(gui, "Add " + file, std::move(edits), false)) return;
    gui.editor.select(path);
    gui.editing.revealsSelection = true;
    gui.settings.openPanels["objects"] = true;
    gui.say(told);
}

void beginReading(Gui& gui) {
    const std::string file = std::exchange(gui.added.wantedModel, {});
    const scene::SceneDesc& scene = gui.editor.document()->scene();
    // A file that the scene has is another instance of it.
    if (const std::string name = app::modelOfFile(scene, file); !name.empty()) return placeModel(gui, name, {});
    gui.added.sceneReads = gui.state.sceneReads;
    gui.added.model.start(freeModelName(scene, file), file, gui.assetsBelow);
    gui.say("Reading " + shortName(file));
}

// The name of an image texture in the scene: of one that is equal, else a new one, which the edit makes.
std::string textureOf(const scene::SceneDesc& scene, const std::string& file, bool isColor,
                      std::vector<scene::SceneEdit>& edits) {
    scene::ImageTexture image;
    image.file = app::wholePath(file);
    image.colorSpace = isColor ? scene::ColorSpace::Srgb : scene::ColorSpace::Linear;
    image.wrapU = image.wrapV = scene::Wrap::Repeat;
    const scene::TextureDesc wanted = image;
    for (const auto& [name, texture] : scene.textures)
        if (texture == wanted) return name;
    const auto isTaken = [&](const std::string& name) { return scene.textures.contains(name); };
    std::string name = scene::freeName(printable(fs::path(file).stem().string(), 60), isTaken);
    edits.emplace_back(scene::SetTexture{name, wanted});
    return name;
}

// The colour of the material that is seen there.
void takeImageAt(Gui& gui, const std::string& file, const scene::ObjectPath& path, const std::string& shown) {
    const std::string name = materialSeen(gui.editor.document()->scene(), path, shown);
    if (name.empty()) return gui.say("The material there is of a model's file, not of the scene");
    setTexture(gui, {name, true, [](scene::MaterialDesc& m, const std::string& texture) { m.albedo = texture; }}, file);
}

} // namespace

// ---- models --------------------------------------------------------------------------------------------------------

void addModel(Gui& gui, const std::string& file) {
    gui.editor.begin();
    gui.added.wantedModel = app::wholePath(file);
}

void followAddedFiles(Gui& gui) {
    AddedFiles& added = gui.added;
    if (!added.wantedModel.empty() && gui.editor.document() != nullptr) beginReading(gui);
    if (!added.model.isUnderWay()) return;
    if (added.sceneReads != gui.state.sceneReads) return added.model.stop(); // another scene is edited by now
    try {
        if (auto model = added.model.take()) {
            const std::string name = model->name;
            placeModel(gui, name, std::move(model));
        }
    } catch (const std::exception& error) {
        gui.fail("cannot be added: " + messageOf(error), app::ErrorSource::Scene);
    }
}

void drawModelReading(Gui& gui) {
    if (!gui.added.model.isUnderWay()) return;
    note(elided("Reading " + printable(shortName(gui.added.model.file())) + " ...",
                ImGui::GetContentRegionAvail().x - buttonWidth("Stop") - 2 * ImGui::GetFontSize()));
    besideIfItFits(buttonWidth("Stop"));
    if (button("Stop", "It is not added", true)) gui.added.model.stop();
}

// ---- images --------------------------------------------------------------------------------------------------------

bool isImageFile(const std::string& file) {
    const std::string kind = lowerCase(fs::path(file).extension().string());
    return std::any_of(std::begin(kImageKinds), std::end(kImageKinds),
                       [&](std::string_view known) { return kind == known; });
}

void askImage(Gui& gui, std::function<void(Gui&, const std::string& file)> take) {
    gui.added.takeImage = std::move(take);
    gui.browse(BrowseFor::Image);
}

void setSkyImage(Gui& gui, const std::string& file) {
    const scene::Background& before = gui.editor.document()->scene().background;
    const auto* image = std::get_if<scene::ImageBackground>(&before);
    scene::ImageBackground sky = image != nullptr ? *image : scene::ImageBackground{};
    sky.file = app::wholePath(file);
    if (editScene(gui, "Sky", {scene::SetBackground{sky}}, false)) gui.say("Sky of " + shortName(file));
}

void setTexture(Gui& gui, const TextureSlot& slot, const std::string& file) {
    const scene::SceneDesc& scene = gui.editor.document()->scene();
    const auto found = scene.materials.find(slot.material);
    if (found == scene.materials.end()) return;
    std::vector<scene::SceneEdit> edits;
    scene::MaterialDesc material = found->second;
    slot.set(material, textureOf(scene, file, slot.isColor, edits));
    edits.emplace_back(scene::SetMaterial{slot.material, std::move(material)});
    if (!editScene(gui, "Texture of " + slot.material, std::move(edits), false)) return;
    const std::size_t lacking = slot.needsTangents ? scene::meshesWithoutTangents(scene, slot.material) : 0;
    gui.say("\"" + slot.material + "\" has now " + shortName(file) +
            (lacking > 0 ? ", which meshes without tangents do not show: " + std::to_string(lacking) : ""));
}

void dropImage(Gui& gui, const std::string& file, const std::array<std::uint32_t, 2>& pixel) {
    const auto onObject = [file](Gui& g, const scene::ObjectPath& path, const std::string& shown) {
        takeImageAt(g, file, path, shown);
    };
    askPicture(gui, pixel, onObject, [file](Gui& g) { setSkyImage(g, file); });
}

// ---- drops ---------------------------------------------------------------------------------------------------------

std::optional<std::string> takeDroppedImage(Gui& gui) {
    if (gui.added.droppedImage.empty() || !ImGui::IsItemHovered(ImGuiHoveredFlags_RectOnly)) return std::nullopt;
    return std::exchange(gui.added.droppedImage, {});
}

// Once the pointer is where it was let go.
std::optional<std::string> takeDroppedModel(Gui& gui) {
    const ImVec2 corner = ImGui::GetWindowPos(), size = ImGui::GetWindowSize();
    const bool isHere = ImGui::IsMouseHoveringRect(corner, {corner.x + size.x, corner.y + size.y}, false);
    if (gui.added.droppedScene.empty() || gui.window.hasEvents() || !isHere) return std::nullopt;
    return std::exchange(gui.added.droppedScene, {});
}

void beginDrop(Gui& gui, const std::string& file) {
    const bool isPart = isMaterialFile(file) || isImageFile(file);
    (isPart ? gui.materials.droppedFile : gui.added.droppedScene) = file;
}

void endDrops(Gui& gui) {
    if (!std::exchange(gui.added.droppedImage, {}).empty())
        gui.say("An image can be let go above an object, above the sky, and above fields of colours and textures");
    if (!gui.added.droppedScene.empty() && !gui.window.hasEvents())
        gui.openScene(std::exchange(gui.added.droppedScene, {}));
}

} // namespace rt::gui
