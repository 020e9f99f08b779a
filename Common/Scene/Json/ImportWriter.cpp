// Writing of scene files that begin with a model: what the scene has of it is found by comparison, whoever has changed
// what.
#include <algorithm>
#include <filesystem>
#include <iterator>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "Common/Core/Error.h"
#include "Common/Core/Interruption.h"
#include "Common/Scene/AddedModels.h"
#include "Common/Scene/Edit/ObjectPath.h"
#include "Common/Scene/Json/Import.h"
#include "Common/Scene/Json/SceneWriter.h"
#include "Common/Scene/ModelFile.h"

namespace rt::scene {

namespace {

constexpr std::size_t kLookAhead = 64; // objects, for the next that is as it was

// Whether the object is the model's with another transform, material or neither.
bool stemsFrom(const ObjectDesc& original, const ObjectDesc& object) {
    if (original.shape.index() != object.shape.index()) return false;
    if (const auto* mesh = std::get_if<MeshDesc>(&original.shape)) {
        const auto& other = std::get<MeshDesc>(object.shape);
        const bool hasMaterial = !other.material.empty() || mesh->material.empty();
        return hasMaterial && mesh->light == other.light && mesh->source == other.source;
    }
    if (const auto* instance = std::get_if<InstanceDesc>(&original.shape))
        return instance->prototype == std::get<InstanceDesc>(object.shape).prototype;
    if (const auto* group = std::get_if<GroupDesc>(&original.shape)) {
        const auto& other = std::get<GroupDesc>(object.shape);
        if (group->objects.empty() || other.objects.empty()) return *group == other;
        return group->transform == other.transform || group->objects.front() == other.objects.front() ||
               group->objects.back() == other.objects.back();
    }
    return original.shape == object.shape;
}

// The object itself, or the only one in it, or in that; null where none stems from the model's.
const ObjectDesc* coreOf(const ObjectDesc& original, const ObjectDesc& object) {
    const auto* group = std::get_if<GroupDesc>(&object.shape);
    if (group != nullptr && group->objects.size() == 1 && !std::holds_alternative<GroupDesc>(original.shape))
        return coreOf(original, group->objects.front());
    return stemsFrom(original, object) ? &object : nullptr;
}

OrderedJson importedJson(const ObjectDesc& original, const ObjectDesc& object) {
    OrderedJson out = {{"type", "imported"}};
    if (object.hidden != original.hidden) out["hidden"] = object.hidden;
    if (const Transform* transform = transformOf(object))
        if (*transform != *transformOf(original)) out["transform"] = jsonOf(*transform);
    if (const std::string* material = materialNameOf(object))
        if (*material != *materialNameOf(original)) out["material"] = *material;
    return out;
}

// With groups around it.
OrderedJson becomesJson(const ObjectDesc& original, const ObjectDesc& object, const ObjectDesc& core) {
    if (&object == &core) return importedJson(original, object);
    const auto& group = std::get<GroupDesc>(object.shape);
    ObjectDesc around;
    around.hidden = object.hidden;
    around.shape = GroupDesc{group.transform, {}};
    OrderedJson out = jsonOf(around);
    out["objects"] = OrderedJson::array({becomesJson(original, group.objects.front(), core)});
    return out;
}

// What differs between a list of the model and the scene's.
class ListComparison {
  public:
    ListComparison(OrderedJson& changes, std::string prototype, std::vector<std::string> groups)
        : changes_(changes), prototype_(std::move(prototype)), groups_(std::move(groups)) {}

    // Returns what comes behind all of the model's objects, if the list has none of them.
    std::vector<OrderedJson> compare(const std::vector<ObjectDesc>& model, const std::vector<ObjectDesc>& scene) {
        model_ = &model;
        scene_ = &scene;
        std::size_t i = 0, j = 0;
        while (i < model.size() || j < scene.size()) {
            interruptionPoint();
            if (i < model.size() && j < scene.size() && model[i] == scene[j]) {
                ++i;
                ++j;
                continue;
            }
            const auto [skipped, added] = untilAlike(i, j);
            compareParts(i, i + skipped, j, j + added);
            i += skipped;
            j += added;
        }
        write();
        return std::move(trailing_);
    }

  private:
    struct Entry {
        std::vector<OrderedJson> before, after;
        std::optional<OrderedJson> self; // none: as it is
        bool isRemoved = false;
    };

    // How many objects of each list come before the next that is alike, or the ends.
    std::pair<std::size_t, std::size_t> untilAlike(std::size_t i, std::size_t j) const {
        const std::size_t restOfModel = model_->size() - i, restOfScene = scene_->size() - j;
        for (std::size_t sum = 1; sum <= kLookAhead; ++sum)
            for (std::size_t skipped = 0; skipped <= std::min(sum, restOfModel); ++skipped) {
                const std::size_t added = sum - skipped;
                if (added > restOfScene) continue;
                const bool isEnd = skipped == restOfModel && added == restOfScene;
                const bool isWithin = skipped < restOfModel && added < restOfScene;
                if (isEnd || (isWithin && (*model_)[i + skipped] == (*scene_)[j + added])) return {skipped, added};
            }
        if (restOfModel == 0 || restOfScene == 0) return {restOfModel, restOfScene};
        return {1, 1};
    }

    void compareParts(std::size_t from, std::size_t to, std::size_t j, std::size_t end) {
        for (std::size_t i = from; i < to; ++i) {
            const ObjectDesc& original = (*model_)[i];
            const auto begin = scene_->begin() + static_cast<std::ptrdiff_t>(j);
            const auto stop = scene_->begin() + static_cast<std::ptrdiff_t>(end);
            const auto found = std::find_if(
                begin, stop, [&](const ObjectDesc& object) { return coreOf(original, object) != nullptr; });
            Entry& entry = entries_[i];
            entry.isRemoved = found == stop;
            if (entry.isRemoved) continue;
            for (auto own = begin; own != found; ++own) entry.before.push_back(jsonOf(*own));
            noteSelf(entry, i, original, *found);
            j += static_cast<std::size_t>(std::distance(begin, found)) + 1;
        }
        for (; j < end; ++j) addBehind(to, jsonOf((*scene_)[j]));
    }

    void noteSelf(Entry& entry, std::size_t index, const ObjectDesc& original, const ObjectDesc& object) {
        const ObjectDesc& core = *coreOf(original, object);
        OrderedJson self = becomesJson(original, object, core);
        if (&core != &object || self.size() > 1) entry.self = std::move(self);
        const auto* group = std::get_if<GroupDesc>(&original.shape);
        if (group == nullptr) return;
        if (!keys_) keys_.emplace(*model_);
        std::vector<std::string> groups = groups_;
        groups.push_back(keys_->key(index));
        ListComparison(changes_, prototype_, std::move(groups))
            .compare(group->objects, std::get<GroupDesc>(core.shape).objects);
    }

    // Behind the model's objects before that one.
    void addBehind(std::size_t next, OrderedJson own) {
        if (next == model_->size() && groups_.empty() && prototype_.empty())
            trailing_.push_back(std::move(own));
        else if (next > 0)
            entries_[next - 1].after.push_back(std::move(own));
        else
            entries_[next].before.push_back(std::move(own));
    }

    void write() {
        for (auto& [index, entry] : entries_) {
            if (!entry.isRemoved && !entry.self && entry.before.empty() && entry.after.empty()) continue;
            if (!keys_) keys_.emplace(*model_);
            OrderedJson change = OrderedJson::object();
            if (!prototype_.empty()) change["prototype"] = prototype_;
            change["object"] = groups_;
            change["object"].push_back(keys_->key(index));
            OrderedJson& becomes = change["becomes"] = OrderedJson::array();
            for (OrderedJson& own : entry.before) becomes.push_back(std::move(own));
            if (!entry.isRemoved) becomes.push_back(entry.self.value_or(OrderedJson{{"type", "imported"}}));
            for (OrderedJson& own : entry.after) becomes.push_back(std::move(own));
            changes_.push_back(std::move(change));
        }
    }

    OrderedJson& changes_;
    const std::string prototype_;
    const std::vector<std::string> groups_;
    const std::vector<ObjectDesc>*model_ = nullptr, *scene_ = nullptr;
    std::map<std::size_t, Entry> entries_; // of the model's objects that are not as they were
    std::vector<OrderedJson> trailing_;
    std::optional<ObjectKeys> keys_;
};

// What the scene has otherwise, and the names of what it has no more.
template <typename Section>
void compareSections(const Section& model, const Section& scene, Section& own, const char* key, OrderedJson& removed) {
    for (const auto& [name, value] : scene)
        if (const auto found = model.find(name); found == model.end() || !(found->second == value)) own[name] = value;
    for (const auto& [name, value] : model)
        if (!scene.contains(name)) removed[key].push_back(name);
}

// Relative to the folder, unless it is on another drive.
std::string fileFrom(const std::filesystem::path& folder, const std::filesystem::path& file) {
    const std::filesystem::path relative = folder.empty() ? file : file.lexically_relative(folder);
    return (relative.empty() ? file : relative).generic_string();
}

OrderedJson importJson(const ImportDesc& import, const std::filesystem::path& folder) {
    OrderedJson out = {{"file", fileFrom(folder, import.file)}};
    if (!import.moment.animation.empty()) out["animation"] = import.moment.animation;
    if (import.moment.time != 0) out["time"] = import.moment.time;
    return out;
}

// All that is not large: usual values may be set in one scene and not in the other.
std::string textWithoutObjects(const SceneDesc& scene) {
    SceneDesc rest;
    rest.title = scene.title;
    rest.camera = scene.camera;
    rest.cameras = scene.cameras;
    rest.background = scene.background;
    rest.textures = scene.textures;
    rest.materials = scene.materials;
    rest.importanceTargets = scene.importanceTargets;
    rest.render = scene.render;
    return toJson(rest);
}

bool isSameScene(const SceneDesc& a, const SceneDesc& b) {
    return a.objects == b.objects && a.prototypes == b.prototypes && textWithoutObjects(a) == textWithoutObjects(b);
}

} // namespace

SceneDesc baseOf(const std::optional<ImportDesc>& import, const std::map<std::string, ModelDesc>& models) {
    SceneDesc base;
    if (import) base = loadModelFile(import->file, import->moment);
    for (const auto& [name, model] : models) {
        try {
            if (hasContents(base, name)) continue;
            addContents(base, readModel(name, model));
            base.models.emplace(name, model);
        } catch (const Error&) { // what it has brought is the scene's own
        }
    }
    return base;
}

std::string toJson(const SceneDesc& scene, const std::optional<ImportDesc>& import, SceneDesc model,
                   const std::filesystem::path& folder) {
    SceneDesc own; // beyond the model
    std::map<std::string, ModelDesc> models = model.models;
    for (auto& [name, named] : models) named.file = fileFrom(folder, named.file);
    OrderedJson removed = OrderedJson::object(), changes = OrderedJson::array();
    compareSections(model.cameras, scene.cameras, own.cameras, "cameras", removed);
    compareSections(model.textures, scene.textures, own.textures, "textures", removed);
    compareSections(model.materials, scene.materials, own.materials, "materials", removed);
    for (const auto& [name, objects] : scene.prototypes) {
        const auto found = model.prototypes.find(name);
        const bool isChanged = found != model.prototypes.end() && !found->second.empty() && !objects.empty();
        if (isChanged)
            ListComparison(changes, name, {}).compare(found->second, objects);
        else if (found == model.prototypes.end() || found->second != objects)
            own.prototypes[name] = objects;
    }
    for (const auto& [name, objects] : model.prototypes)
        if (!scene.prototypes.contains(name)) removed["prototypes"].push_back(name);
    const std::vector<OrderedJson> added = ListComparison(changes, "", {}).compare(model.objects, scene.objects);
    own.camera = scene.camera;
    own.background = scene.background;
    own.render = scene.render;
    own.importanceTargets = scene.importanceTargets;
    OrderedJson all = jsonOf(own), out = {{"version", 1}};
    if (scene.title != model.title) out["title"] = scene.title;
    if (import) out["import"] = importJson(*import, folder);
    if (!models.empty()) out["models"] = jsonOf(models);
    if (scene.camera != model.camera) out["camera"] = all["camera"];
    if (all.contains("cameras")) out["cameras"] = all["cameras"];
    if (scene.background != model.background) out["background"] = all["background"];
    if (scene.render != model.render) out["render"] = {{"aspect", scene.render.aspect}};
    if (!removed.empty()) out["removed"] = removed;
    for (const char* key : {"textures", "materials", "prototypes"})
        if (all.contains(key)) out[key] = std::move(all[key]);
    if (!changes.empty()) out["changes"] = std::move(changes);
    out["objects"] = added;
    if (scene.importanceTargets != model.importanceTargets)
        out["importance_targets"] = scene.importanceTargets.empty() ? OrderedJson::array() : all["importance_targets"];
    std::string text = layOut(out);
    if (!isSameScene(parseSceneOn(text, "scene", {}, std::move(model)), scene))
        throw InputError("a file that names the model would not give the scene");
    return text;
}

} // namespace rt::scene
