#include "Common/Scene/AddedModels.h"

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <string_view>
#include <utility>

#include "Common/Core/Error.h"
#include "Common/Core/Printable.h"
#include "Common/Scene/Edit/ObjectPath.h"
#include "Common/Scene/Json/SceneJson.h"
#include "Common/Scene/ModelFile.h"
#include "Common/Scene/TextureNames.h"

namespace rt::scene {

namespace {

namespace fs = std::filesystem;

constexpr std::string_view kPart = ": "; // between the name of a model and that of a part
constexpr std::size_t kLongestName = 60;
constexpr std::size_t kDeepest = 8; // scene files in one another

std::string partOf(const std::string& model, const std::string& name) {
    return model + std::string(kPart) + name;
}

bool isPartOf(const std::string& name, const std::string& model) {
    return name.size() > model.size() + kPart.size() && name.starts_with(model) &&
           std::string_view(name).substr(model.size()).starts_with(kPart);
}

bool isPrototypeOf(const std::string& name, const std::string& model) {
    return name == model || isPartOf(name, model);
}

template <typename Section>
bool hasPart(const Section& section, const std::string& model) {
    return std::any_of(section.begin(), section.end(), [&](const auto& entry) { return isPartOf(entry.first, model); });
}

// Calls visit(name) for all that the objects refer to: (a name, whether it is that of a prototype).
template <typename Objects, typename Visit>
void forEachName(Objects& objects, const Visit& visit) {
    for (auto& object : objects) {
        if (auto* material = materialNameOf(object); material != nullptr && !material->empty()) visit(*material, false);
        if (auto* instance = std::get_if<InstanceDesc>(&object.shape)) visit(instance->prototype, true);
        if (auto* medium = std::get_if<MediumDesc>(&object.shape))
            visitTextureName(medium->albedo, [&](auto& texture) { visit(texture, false); });
        if (auto* group = std::get_if<GroupDesc>(&object.shape)) forEachName(group->objects, visit);
    }
}

template <typename Section, typename IsTaken>
void moveParts(Section& from, Section& to, const IsTaken& isTaken) {
    for (auto entry = from.begin(); entry != from.end();) {
        const auto next = std::next(entry);
        if (isTaken(entry->first)) to.insert(from.extract(entry));
        entry = next;
    }
}

// The scene files that are being read on this thread, each within the one before it.
class OpenFiles {
  public:
    explicit OpenFiles(const fs::path& file) {
        std::error_code none;
        const fs::path whole = fs::weakly_canonical(file, none);
        if (std::find(open().begin(), open().end(), whole) != open().end())
            throw InputError(file.string() + ": it would take in itself");
        if (open().size() >= kDeepest)
            throw InputError(file.string() + ": there are more than " + std::to_string(kDeepest) +
                             " scene files that take in one another");
        open().push_back(whole);
    }
    ~OpenFiles() { open().pop_back(); }
    OpenFiles(const OpenFiles&) = delete;
    OpenFiles& operator=(const OpenFiles&) = delete;

  private:
    static std::vector<fs::path>& open() {
        thread_local std::vector<fs::path> files;
        return files;
    }
};

} // namespace

bool isModelName(const std::string& name) {
    return !name.empty() && name.find(kPart) == name.npos;
}

bool hasContents(const SceneDesc& scene, const std::string& name) {
    return scene.prototypes.contains(name) || hasPart(scene.prototypes, name) || hasPart(scene.materials, name) ||
           hasPart(scene.textures, name);
}

std::string freeModelName(const SceneDesc& scene, const std::string& file) {
    std::string base = printable(fs::path(file).stem().string(), kLongestName);
    for (std::size_t at = base.find(kPart); at != base.npos; at = base.find(kPart)) base.erase(at, 1);
    if (base.empty()) base = "model";
    std::string name = base;
    for (std::size_t count = 2; scene.models.contains(name) || hasContents(scene, name); ++count)
        name = base + " " + std::to_string(count);
    return name;
}

ModelContents contentsOf(const std::string& name, SceneDesc file) {
    const auto rename = [&](std::string& own) { own = partOf(name, own); };
    const auto renameIn = [&](std::vector<ObjectDesc>& objects) {
        forEachName(objects, [&](std::string& own, bool) { rename(own); });
    };
    ModelContents contents;
    for (auto& [own, texture] : file.textures) {
        forEachInnerTexture(texture, rename);
        contents.textures.emplace(partOf(name, own), std::move(texture));
    }
    for (auto& [own, material] : file.materials) {
        forEachTextureName(material, rename);
        contents.materials.emplace(partOf(name, own), std::move(material));
    }
    for (auto& [own, objects] : file.prototypes) {
        renameIn(objects);
        contents.prototypes.emplace(partOf(name, own), std::move(objects));
    }
    renameIn(file.objects);
    contents.prototypes.emplace(name, std::move(file.objects));
    contents.notices = std::move(file.notices);
    return contents;
}

ModelContents readModel(const std::string& name, const ModelDesc& model) {
    if (isModelFile(model.file)) return contentsOf(name, loadModelAlone(model.file, {model.animation, model.time}));
    const OpenFiles within(model.file);
    SceneDesc scene = loadSceneFile(model.file);
    noticeStandstill({model.animation, model.time}, scene.notices);
    return contentsOf(name, std::move(scene));
}

void addContents(SceneDesc& scene, ModelContents contents) {
    scene.textures.merge(contents.textures);
    scene.materials.merge(contents.materials);
    scene.prototypes.merge(contents.prototypes);
}

ModelContents takeContents(SceneDesc& scene, const std::string& name) {
    const auto isPart = [&](const std::string& own) { return isPartOf(own, name); };
    ModelContents contents;
    moveParts(scene.textures, contents.textures, isPart);
    moveParts(scene.materials, contents.materials, isPart);
    moveParts(scene.prototypes, contents.prototypes, [&](const std::string& own) { return isPrototypeOf(own, name); });
    return contents;
}

std::size_t modelUses(const SceneDesc& scene, const std::string& name) {
    std::size_t uses = 0;
    const auto count = [&](const std::string& used) { uses += isPartOf(used, name); };
    const auto countIn = [&](const std::vector<ObjectDesc>& objects) {
        forEachName(objects, [&](const std::string& used, bool isPrototype) {
            uses += isPrototype ? isPrototypeOf(used, name) : isPartOf(used, name);
        });
    };
    countIn(scene.objects);
    for (const auto& [own, objects] : scene.prototypes)
        if (!isPrototypeOf(own, name)) countIn(objects);
    for (const auto& [own, material] : scene.materials)
        if (!isPartOf(own, name)) forEachTextureName(material, count);
    for (const auto& [own, texture] : scene.textures)
        if (!isPartOf(own, name)) forEachInnerTexture(texture, count);
    return uses;
}

} // namespace rt::scene
