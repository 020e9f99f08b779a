// What an edit sets stands in a scene file of nothing else, so that there is one reader and one writer of it.
#include "Common/Scene/Edit/EditText.h"

#include <algorithm>
#include <array>
#include <functional>
#include <iterator>
#include <string_view>
#include <type_traits>
#include <utility>

#include "Common/Core/ReadFile.h"
#include "Common/Scene/Json/SceneJson.h"
#include "Common/Scene/Json/SceneWriter.h"
#include "Common/Scene/TextureNames.h"

namespace rt::scene {

namespace {

// In the order of SceneEdit.
constexpr std::array<const char*, std::variant_size_v<SceneEdit>> kEditNames = {
    "object",    "transform", "material_of", "hidden", "place",   "wrap",  "material", "texture",
    "prototype", "camera",    "background",  "render", "targets", "title", "model"};

std::string quotedText(const std::string& text) {
    return nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

// What the objects name must exist where they are read.
void addNamesOf(SceneDesc& alone, const std::vector<ObjectDesc>& objects) {
    for (const ObjectDesc& object : objects) {
        if (const std::string* name = materialNameOf(object); name != nullptr && !name->empty())
            alone.materials[*name] = {};
        if (const auto* medium = std::get_if<MediumDesc>(&object.shape))
            visitTextureName(medium->albedo, [&](const std::string& name) { alone.textures[name] = SolidTexture{}; });
        if (const auto* instance = std::get_if<InstanceDesc>(&object.shape))
            alone.prototypes.try_emplace(instance->prototype);
        if (const auto* group = std::get_if<GroupDesc>(&object.shape)) addNamesOf(alone, group->objects);
    }
}

ObjectDesc groupOf(const Transform& transform) {
    GroupDesc group;
    group.transform = transform;
    return {group};
}

// Nothing: the edit takes something away, or sets no more than a flag or a name.
struct SceneOfEdit {
    SceneDesc alone{};

    bool operator()(const SetObject& edit) { return setObject(edit.object); }
    bool operator()(const SetTransform& edit) { return setObject(groupOf(edit.transform)); }
    bool operator()(const SetMaterialOf&) { return false; }
    bool operator()(const SetHidden&) { return false; }
    bool operator()(const PlaceObject& edit) { return edit.object && setObject(*edit.object); }
    bool operator()(const WrapObject& edit) { return edit.transform && setObject(groupOf(*edit.transform)); }
    bool operator()(const SetMaterial& edit) {
        if (!edit.value) return false;
        forEachTextureName(*edit.value, [&](const std::string& name) { alone.textures[name] = SolidTexture{}; });
        alone.materials[edit.name] = *edit.value;
        return true;
    }
    bool operator()(const SetTexture& edit) {
        if (!edit.value) return false;
        forEachInnerTexture(*edit.value, [&](const std::string& name) { alone.textures[name] = SolidTexture{}; });
        alone.textures[edit.name] = *edit.value;
        return true;
    }
    bool operator()(const SetPrototype& edit) {
        if (!edit.value) return false;
        addNamesOf(alone, *edit.value);
        alone.prototypes[edit.name] = *edit.value;
        return true;
    }
    bool operator()(const SetModel& edit) {
        if (edit.value) alone.models[edit.name] = *edit.value;
        return edit.value.has_value();
    }
    bool operator()(const SetCamera& edit) { return set(alone.camera, edit.value); }
    bool operator()(const SetBackground& edit) { return set(alone.background, edit.value); }
    bool operator()(const SetRenderDefaults& edit) { return set(alone.render, edit.value); }
    bool operator()(const SetTargets& edit) { return set(alone.importanceTargets, edit.value); }
    bool operator()(const SetTitle& edit) { return set(alone.title, edit.value); }

  private:
    bool setObject(ObjectDesc object) {
        alone.objects = {std::move(object)};
        addNamesOf(alone, alone.objects);
        return true;
    }
    template <typename Value>
    static bool set(Value& part, const Value& value) {
        part = value;
        return true;
    }
};

// A model is named; its file has the rest.
std::string aloneText(const SceneDesc& alone) {
    if (alone.models.empty()) return toJson(alone);
    return layOut({{"models", jsonOf(alone.models)}, {"objects", OrderedJson::array()}});
}

std::string textOfPath(const ObjectPath& path) {
    std::string text = R"(, "prototype": )" + quotedText(path.prototype) + R"(, "place": [)";
    for (std::size_t i = 0; i < path.indices.size(); ++i)
        text += (i == 0 ? "" : ", ") + std::to_string(path.indices[i]);
    return text + ']';
}

// ---- reading -------------------------------------------------------------------------------------------------------

ObjectPath readPath(const JsonNode& node) {
    ObjectPath path{node.at("prototype").string(), {}};
    node.at("place").forEachElement([&](const JsonNode& index) { path.indices.push_back(index.unsignedInteger()); });
    if (path.indices.empty()) node.at("place").failValue("the place of an object");
    return path;
}

// What a scene of nothing else holds of it.
class EditReader {
  public:
    EditReader(const JsonNode& node, SceneDesc alone, bool hasValue)
        : node_(node), alone_(std::move(alone)), hasValue_(hasValue) {}

    void operator()(SetObject& edit) {
        edit.path = readPath(node_);
        edit.object = object();
    }
    void operator()(SetTransform& edit) {
        edit.path = readPath(node_);
        edit.transform = transform();
    }
    void operator()(SetMaterialOf& edit) {
        edit.path = readPath(node_);
        edit.material = node_.at("name").string();
    }
    void operator()(SetHidden& edit) {
        edit.path = readPath(node_);
        edit.isHidden = node_.at("is_hidden").boolean();
    }
    void operator()(PlaceObject& edit) {
        edit.path = readPath(node_);
        if (hasValue_) edit.object = object();
    }
    void operator()(WrapObject& edit) {
        edit.path = readPath(node_);
        edit.isHidden = node_.at("is_hidden").boolean();
        if (hasValue_) edit.transform = transform();
    }
    void operator()(SetMaterial& edit) { readNamed(edit, alone_.materials); }
    void operator()(SetTexture& edit) { readNamed(edit, alone_.textures); }
    void operator()(SetPrototype& edit) { readNamed(edit, alone_.prototypes); }
    void operator()(SetModel& edit) {
        readNamed(edit, alone_.models);
        if (hasValue_) edit.contents = takeContents(alone_, edit.name);
    }
    void operator()(SetCamera& edit) { edit.value = alone_.camera; }
    void operator()(SetBackground& edit) { edit.value = alone_.background; }
    void operator()(SetRenderDefaults& edit) { edit.value = alone_.render; }
    void operator()(SetTargets& edit) { edit.value = std::move(alone_.importanceTargets); }
    void operator()(SetTitle& edit) { edit.value = alone_.title; }

  private:
    ObjectDesc object() {
        if (alone_.objects.size() != 1) node_.fail("\"scene\" must hold one object");
        return std::move(alone_.objects.front());
    }
    Transform transform() {
        ObjectDesc group = object();
        Transform* transform = transformOf(group);
        if (transform == nullptr) node_.fail("\"scene\" must hold a group");
        return std::move(*transform);
    }
    template <typename Edit, typename Section>
    void readNamed(Edit& edit, Section& section) {
        edit.name = node_.at("name").string();
        if (!hasValue_) return;
        const auto found = section.find(edit.name);
        if (found == section.end()) node_.fail("\"scene\" must hold what has that name");
        edit.value = std::move(found->second);
    }

    const JsonNode& node_;
    SceneDesc alone_;
    const bool hasValue_;
};

// Which the user has chosen, wherever it lies; empty: the scene takes in none.
std::string modelFileIn(const JsonNode& scene) {
    std::string file;
    if (const auto models = scene.find("models"))
        models->forEachMember([&](const std::string&, const JsonNode& model) { file = model.at("file").string(); });
    return file;
}

template <std::size_t... I>
SceneEdit editOfKind(std::size_t kind, std::index_sequence<I...>) {
    SceneEdit edit;
    (void)((kind == I && (edit.emplace<I>(), true)) || ...);
    return edit;
}

} // namespace

std::string toText(const SceneEdit& edit) {
    std::string text = std::string(R"({"edit": ")") + kEditNames[edit.index()] + '"';
    std::visit(
        [&](const auto& value) {
            if constexpr (requires { value.path; }) text += textOfPath(value.path);
            if constexpr (requires { value.name; }) text += R"(, "name": )" + quotedText(value.name);
            if constexpr (requires { value.material; }) text += R"(, "name": )" + quotedText(value.material);
            if constexpr (requires { value.isHidden; })
                text += std::string(R"(, "is_hidden": )") + (value.isHidden ? "true" : "false");
        },
        edit);
    SceneOfEdit scene;
    if (std::visit(scene, edit)) text += R"(, "scene": )" + aloneText(scene.alone);
    std::replace(text.begin(), text.end(), '\n', ' '); // of the layout: within names they are written otherwise
    return text + '}';
}

SceneEdit parseEdit(const JsonNode& node, const std::string& assetsBelow) {
    node.expectKeys({"edit", "prototype", "place", "name", "is_hidden", "scene"});
    const std::string kind = node.at("edit").string();
    const auto found = std::find(kEditNames.begin(), kEditNames.end(), std::string_view(kind));
    if (found == kEditNames.end()) node.at("edit").failValue("the name of an edit");
    SceneEdit edit = editOfKind(static_cast<std::size_t>(std::distance(kEditNames.begin(), found)),
                                std::make_index_sequence<std::variant_size_v<SceneEdit>>());
    SceneDesc alone;
    const auto scene = node.find("scene");
    if (scene) {
        const ReadsBelow confined(assetsBelow, modelFileIn(*scene));
        alone = parseScene(scene->value().dump(), node.file() + ": " + scene->path(), {});
    }
    std::visit(EditReader(node, std::move(alone), scene.has_value()), edit);
    return edit;
}

} // namespace rt::scene
