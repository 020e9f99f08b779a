#include <algorithm>
#include <filesystem>
#include <iterator>
#include <map>
#include <memory>
#include <set>
#include <system_error>
#include <utility>

#include "Common/Core/Error.h"
#include "Common/Core/OtherCase.h"
#include "Common/Core/Paths.h"
#include "Common/Core/Printable.h"
#include "Common/Scene/AddedModels.h"
#include "Common/Scene/Edit/ObjectPath.h"
#include "Common/Scene/Json/Import.h"
#include "Common/Scene/ModelFile.h"
#include "Common/Scene/TextureNames.h"

namespace rt::scene {

namespace {

struct CalledBy {
    std::string operator()(const InstanceDesc& instance) const { return instance.prototype; }
    std::string operator()(const GroupDesc&) const { return "group"; }
    std::string operator()(const MediumDesc&) const { return "medium"; }
    std::string operator()(const PointLightDesc&) const { return "point light"; }
    std::string operator()(const SpotLightDesc&) const { return "spot light"; }
    std::string operator()(const DirectionalLightDesc&) const { return "directional light"; }
    template <typename Surface>
    std::string operator()(const Surface& surface) const {
        return surface.material.empty() ? "mesh" : surface.material;
    }
};

constexpr std::string_view kOrdinal = " #", kTotal = " of ";

std::string nameWithoutOrdinal(const std::string& key) {
    return key.substr(0, key.rfind(kOrdinal));
}

// Where " of 3" begins; npos: nowhere.
std::size_t placeOfTotal(const std::string& key) {
    const std::size_t ordinal = key.rfind(kOrdinal);
    return ordinal == key.npos ? ordinal : key.find(kTotal, ordinal + kOrdinal.size());
}

} // namespace

ObjectKeys::ObjectKeys(const std::vector<ObjectDesc>& objects) {
    keys_.reserve(objects.size());
    for (const ObjectDesc& object : objects) {
        const std::string name = std::visit(CalledBy{}, object.shape);
        keys_.push_back(name + std::string(kOrdinal) + std::to_string(++counts_[name]));
        places_.emplace(keys_.back(), keys_.size() - 1);
    }
}

std::string ObjectKeys::key(std::size_t index) const {
    return keys_[index] + std::string(kTotal) + std::to_string(countLike(keys_[index]));
}

std::optional<std::size_t> ObjectKeys::find(const std::string& key) const {
    const auto found = places_.find(key.substr(0, placeOfTotal(key)));
    return found != places_.end() ? std::optional(found->second) : std::nullopt;
}

bool ObjectKeys::isOfAnotherList(const std::string& key) const {
    const std::size_t total = placeOfTotal(key);
    return total != key.npos && key.substr(total + kTotal.size()) != std::to_string(countLike(key));
}

std::size_t ObjectKeys::countLike(const std::string& key) const {
    const auto found = counts_.find(nameWithoutOrdinal(key));
    return found != counts_.end() ? found->second : 0;
}

// ---- the model -----------------------------------------------------------------------------------------------------

namespace {

// Without what kind of file it is.
ImportDesc readNamedFile(const JsonNode& node, const SceneReferences& references) {
    node.expectKeys({"file", "animation", "time"});
    ImportDesc named;
    named.file = references.file(node.at("file"), false);
    if (named.file.is_relative()) named.file = findAsset(named.file).value_or(named.file);
    if (const auto animation = node.find("animation")) named.moment.animation = animation->string();
    if (const auto time = node.find("time")) named.moment.time = time->within(0, kLargest);
    return named;
}

// That is there in other case; empty: it is there as it is called, or not at all.
std::filesystem::path otherCaseOf(const std::filesystem::path& file) {
    std::error_code none;
    return std::filesystem::exists(file, none) ? std::filesystem::path() : findInOtherCase(file);
}

void addModel(const std::string& name, const JsonNode& node, const SceneReferences& references, SceneDesc& scene) {
    if (!isModelName(name)) node.fail("the name of a model must not be empty, and not contain \": \"");
    if (hasContents(scene, name)) node.fail("the import has names that begin as those of this model do");
    const ImportDesc named = readNamedFile(node, references);
    const bool isReadable = isModelFile(named.file) || kindOfFile(named.file) == ".json";
    if (!isReadable) node.at("file").failValue("a file of glTF, OBJ or pbrt, or a scene file");
    ModelDesc model{named.file.generic_string(), named.moment.animation, named.moment.time};
    if (const auto other = otherCaseOf(named.file); !other.empty()) {
        scene.notices.push_back("the file of the model \"" + printable(name) +
                                "\" is named in other case: " + other.filename().string());
        model.file = other.generic_string();
    }
    try {
        ModelContents contents = readModel(name, model);
        for (const std::string& notice : contents.notices) scene.notices.push_back(printable(name) + ": " + notice);
        addContents(scene, std::move(contents));
    } catch (const UsageError& error) { // of an animation
        node.fail(error.what());
    }
    scene.models.emplace(name, std::move(model));
}

} // namespace

ImportDesc readImport(const JsonNode& node, const SceneReferences& references) {
    ImportDesc import = readNamedFile(node, references);
    if (!isModelFile(import.file)) node.at("file").failValue("a file of glTF, OBJ or pbrt");
    return import;
}

std::filesystem::path fileOfImport(const ImportDesc& import) {
    const std::filesystem::path other = otherCaseOf(import.file);
    return other.empty() ? import.file : other;
}

namespace {

SceneDesc loadImport(const JsonNode& node, const SceneReferences& references, const ModelReader& reader) {
    const ImportDesc import = readImport(node, references);
    const std::filesystem::path file = fileOfImport(import);
    try {
        SceneDesc scene = reader.load(file, momentOfImport(import.moment, reader.asked));
        if (file != import.file)
            scene.notices.push_back("the imported file is named in other case: " + file.filename().string());
        return scene;
    } catch (const UsageError& error) { // of an animation
        if (!reader.asked.animation.empty()) throw;
        node.fail(error.what());
    }
}

} // namespace

SceneDesc readBase(const JsonNode& root, const SceneReferences& references, const ModelReader& reader) {
    const auto import = root.find("import"), models = root.find("models");
    SceneDesc scene;
    if (import) scene = loadImport(*import, references, reader);
    if (models)
        models->forEachMember(
            [&](const std::string& name, const JsonNode& node) { addModel(name, node, references, scene); });
    return scene;
}

void removeFromModel(const JsonNode& removed, SceneDesc& scene) {
    removed.expectKeys({"textures", "materials", "prototypes", "cameras"});
    const auto removeFrom = [&](const char* key, auto& section) {
        if (const auto names = removed.find(key))
            names->forEachElement([&](const JsonNode& name) {
                if (section.erase(name.string()) == 0)
                    name.failValue(std::string("a name that the model has in its ") + key);
            });
    };
    removeFrom("textures", scene.textures);
    removeFrom("materials", scene.materials);
    removeFrom("prototypes", scene.prototypes);
    removeFrom("cameras", scene.cameras);
}

// ---- its objects ---------------------------------------------------------------------------------------------------

namespace {

// Of an object, and of those in it.
struct ModelChange {
    std::optional<JsonNode> becomes;
    std::map<std::size_t, std::unique_ptr<ModelChange>> inner;
    std::unique_ptr<ObjectKeys> keys; // of its objects, once any is changed
};

using ListOfModel = std::vector<ObjectDesc>;

ListOfModel& listToChange(const JsonNode& change, SceneDesc& scene) {
    const auto prototype = change.find("prototype");
    if (!prototype) return scene.objects;
    const auto found = scene.prototypes.find(prototype->string());
    if (found == scene.prototypes.end()) prototype->failValue("the name of a prototype of the model");
    return found->second;
}

// `shifted`: gets what is called as it is by another number of objects now.
void noteChange(const JsonNode& node, const ListOfModel& objects, ModelChange& root, std::set<std::string>& shifted) {
    node.expectKeys({"prototype", "object", "becomes"});
    const JsonNode names = node.at("object");
    if (names.arraySize() == 0) names.failValue("what the object is called, behind the groups that it is in");
    const ListOfModel* list = &objects;
    ModelChange* change = &root;
    for (std::size_t i = 0; i < names.arraySize(); ++i) {
        const JsonNode name = names.element(i);
        if (list == nullptr) name.failValue("in a group, which the one before is not");
        if (!change->keys) change->keys = std::make_unique<ObjectKeys>(*list);
        const auto index = change->keys->find(name.string());
        if (!index)
            name.failValue("an object of the model, in which " +
                           std::to_string(change->keys->countLike(name.string())) + " there are called \"" +
                           nameWithoutOrdinal(name.string()) + '"');
        if (change->keys->isOfAnotherList(name.string())) shifted.insert(nameWithoutOrdinal(name.string()));
        const auto* group = std::get_if<GroupDesc>(&(*list)[*index].shape);
        list = group != nullptr ? &group->objects : nullptr;
        std::unique_ptr<ModelChange>& inner = change->inner[*index];
        if (!inner) inner = std::make_unique<ModelChange>();
        change = inner.get();
    }
    if (change->becomes) node.fail("that object is changed once before");
    change->becomes = node.at("becomes");
}

bool keepsOriginal(const JsonNode& objects) {
    bool keeps = false;
    objects.forEachElement([&](const JsonNode& object) {
        const auto inner = object.find("objects");
        keeps = keeps || object.at("type").string() == "imported" || (inner && keepsOriginal(*inner));
    });
    return keeps;
}

[[noreturn]] void failInside(const ModelChange& change) {
    const ModelChange* lost = &change;
    while (!lost->becomes) lost = lost->inner.begin()->second.get();
    lost->becomes->fail("of an object in a group that another change takes away");
}

void applyInside(ListOfModel& list, const ModelChange& change, const SceneReferences& references) {
    const bool keepsCount = std::all_of(change.inner.begin(), change.inner.end(), [](const auto& entry) {
        const std::optional<JsonNode>& becomes = entry.second->becomes;
        return !becomes || becomes->arraySize() == 1;
    });
    ListOfModel result;
    std::size_t done = 0; // of the list, where the number of objects changes
    for (const auto& [index, inner] : change.inner) {
        ObjectDesc& object = list[index];
        if (!inner->inner.empty()) applyInside(std::get<GroupDesc>(object.shape).objects, *inner, references);
        if (!inner->becomes) continue;
        SceneReferences those = references;
        those.setOriginal(&object);
        ListOfModel becomes = readObjects(*inner->becomes, those);
        if (!inner->inner.empty() && !keepsOriginal(*inner->becomes)) failInside(*inner->inner.begin()->second);
        if (keepsCount) {
            object = std::move(becomes.front());
            continue;
        }
        const auto from = list.begin() + static_cast<std::ptrdiff_t>(done);
        std::move(from, list.begin() + static_cast<std::ptrdiff_t>(index), std::back_inserter(result));
        std::move(becomes.begin(), becomes.end(), std::back_inserter(result));
        done = index + 1;
    }
    if (keepsCount) return;
    std::move(list.begin() + static_cast<std::ptrdiff_t>(done), list.end(), std::back_inserter(result));
    list = std::move(result);
}

} // namespace

void changeModel(const JsonNode& changes, const SceneReferences& references, SceneDesc& scene) {
    std::map<ListOfModel*, ModelChange> lists;
    std::set<std::string> shifted;
    std::vector<JsonNode> nodes; // which those of what objects become point into
    nodes.reserve(changes.arraySize());
    for (std::size_t i = 0; i < changes.arraySize(); ++i) nodes.push_back(changes.element(i));
    for (const JsonNode& node : nodes) {
        ListOfModel& list = listToChange(node, scene);
        noteChange(node, list, lists[&list], shifted);
    }
    for (const std::string& name : shifted)
        scene.notices.push_back("the model does not have as many objects called \"" + printable(name) +
                                "\" as when they were changed: other ones may be changed now");
    for (auto& [list, change] : lists) applyInside(*list, change, references);
}

namespace {

class UsedNames {
  public:
    UsedNames(const JsonNode& root, const SceneDesc& scene) : root_(root), scene_(scene) {}

    void check() const {
        for (const auto& [name, material] : scene_.materials)
            forEachTextureName(
                material, [&, &owner = name](const std::string& used) { expectTexture(used, "/materials/" + owner); });
        for (const auto& [name, texture] : scene_.textures)
            forEachInnerTexture(
                texture, [&, &owner = name](const std::string& used) { expectTexture(used, "/textures/" + owner); });
        for (const auto& [name, objects] : scene_.prototypes) check(objects, "/prototypes/" + name);
        check(scene_.objects, "/objects");
    }

  private:
    void check(const std::vector<ObjectDesc>& objects, const std::string& place) const {
        for (const ObjectDesc& object : objects) {
            const std::string* material = materialNameOf(object);
            if (material != nullptr && !material->empty() && !scene_.materials.contains(*material))
                fail("material", *material, place);
            if (const auto* instance = std::get_if<InstanceDesc>(&object.shape))
                if (!scene_.prototypes.contains(instance->prototype)) fail("prototype", instance->prototype, place);
            if (const auto* medium = std::get_if<MediumDesc>(&object.shape))
                visitTextureName(medium->albedo, [&](const std::string& used) { expectTexture(used, place); });
            if (const auto* group = std::get_if<GroupDesc>(&object.shape)) check(group->objects, place);
        }
    }
    void expectTexture(const std::string& name, const std::string& place) const {
        if (!scene_.textures.contains(name)) fail("texture", name, place);
    }
    [[noreturn]] void fail(const char* what, const std::string& name, const std::string& place) const {
        root_.fail(std::string(what) + " \"" + name + "\" is removed, and used in " + place);
    }

    const JsonNode& root_;
    const SceneDesc& scene_;
};

} // namespace

void checkNames(const JsonNode& root, const SceneDesc& scene) {
    if (root.has("removed")) UsedNames(root, scene).check();
}

} // namespace rt::scene
