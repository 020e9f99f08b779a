#include "Common/Scene/Edit/EditCheck.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>
#include <string_view>
#include <utility>

#include "Common/Core/Error.h"
#include "Common/Scene/Json/SceneJson.h"
#include "Common/Scene/TextureNames.h"

namespace rt::scene {

namespace {

[[noreturn]] void refuse(const std::string& place, const std::string& why) {
    throw InputError(place + ": " + why);
}

// ---- what refers to what -------------------------------------------------------------------------------------------

void forEachObject(const std::vector<ObjectDesc>& objects, const std::function<void(const ObjectDesc&)>& visit) {
    for (const ObjectDesc& object : objects) {
        visit(object);
        if (const auto* group = std::get_if<GroupDesc>(&object.shape)) forEachObject(group->objects, visit);
    }
}

void forEachObject(const SceneDesc& scene, const std::function<void(const ObjectDesc&)>& visit) {
    forEachObject(scene.objects, visit);
    for (const auto& [name, objects] : scene.prototypes) forEachObject(objects, visit);
}

const InstanceDesc* instanceOf(const ObjectDesc& object) {
    return std::get_if<InstanceDesc>(&object.shape);
}

std::size_t prototypeUses(const SceneDesc& scene, const std::string& name) {
    std::size_t uses = 0;
    forEachObject(scene, [&](const ObjectDesc& object) {
        const InstanceDesc* instance = instanceOf(object);
        uses += instance != nullptr && instance->prototype == name;
    });
    return uses;
}

// Whether a prototype contains another one, or is it.
bool reaches(const SceneDesc& scene, const std::string& from, const std::string& to, std::set<std::string>& seen) {
    if (from == to) return true;
    const auto prototype = scene.prototypes.find(from);
    if (!seen.insert(from).second || prototype == scene.prototypes.end()) return false;
    bool found = false;
    forEachObject(prototype->second, [&](const ObjectDesc& object) {
        const InstanceDesc* instance = instanceOf(object);
        found = found || (instance != nullptr && reaches(scene, instance->prototype, to, seen));
    });
    return found;
}

// ---- values --------------------------------------------------------------------------------------------------------

// By the reader of scene files, in a scene of nothing else. `theirs`: the place in that scene, which `place` replaces
// in what is said.
void checkByReader(const SceneDesc& small, const std::string& theirs, const std::string& place) {
    static const std::string kFile = "edit";
    try {
        parseScene(toJson(small), kFile, {});
    } catch (const InputError& error) {
        std::string text = error.what();
        if (const std::size_t at = text.find(theirs); at != text.npos) text = place + text.substr(at + theirs.size());
        throw InputError(text);
    }
}

bool isRepresentable(const glm::dvec3& v) {
    const auto fits = [](double x) { return std::abs(x) <= kLargest; }; // no NaN does
    return fits(v.x) && fits(v.y) && fits(v.z);
}

template <class Real>
void checkMesh(const MeshOf<Real>& mesh, const std::string& place) {
    if (mesh.triangles.empty()) refuse(place, "a mesh must have a triangle");
    if (!std::ranges::all_of(mesh.positions, isRepresentable)) refuse(place + "/positions", "numbers must be finite");
    const std::size_t count = mesh.positions.size();
    for (const glm::uvec3& t : mesh.triangles)
        if (std::max({t.x, t.y, t.z}) >= count) refuse(place + "/triangles", "an index is that of no position");
}

class ObjectCheck {
  public:
    ObjectCheck(const SceneDesc& scene, const ObjectPath& path) : scene_(scene), prototype_(path.prototype) {}

    void check(const ObjectDesc& object, const std::string& place) const {
        if (const auto* group = std::get_if<GroupDesc>(&object.shape)) {
            for (std::size_t i = 0; i < group->objects.size(); ++i)
                check(group->objects[i], place + "/objects/" + std::to_string(i));
            GroupDesc empty;
            empty.transform = group->transform;
            return checkAlone({empty}, place);
        }
        if (const auto* mesh = std::get_if<MeshDesc>(&object.shape)) {
            if (!std::holds_alternative<MeshFile>(mesh->source)) {
                if (mesh->material.empty()) refuse(place, "a mesh without a file needs a material");
                checkName(object, place);
            }
            if (const auto* data = std::get_if<Boxed<MeshData>>(&mesh->source)) return checkMesh(**data, place);
            if (const auto* data = std::get_if<Boxed<FloatMeshData>>(&mesh->source)) return checkMesh(**data, place);
        }
        if (const auto* spheres = std::get_if<SphereSetDesc>(&object.shape)) {
            if (!std::ranges::all_of(spheres->centers, isRepresentable))
                refuse(place + "/centers", "numbers must be finite");
            SphereSetDesc one = *spheres;
            one.centers.assign(1, glm::dvec3(0));
            return checkAlone({one}, place);
        }
        checkAlone(object, place);
    }

    void checkName(const ObjectDesc& object, const std::string& place) const {
        const std::string* name = materialNameOf(object);
        if (name != nullptr && !name->empty() && !scene_.materials.contains(*name))
            refuse(place + "/material", "\"" + *name + "\" is not the name of a material");
    }

  private:
    void checkAlone(const ObjectDesc& object, const std::string& place) const {
        checkName(object, place);
        SceneDesc small;
        if (const std::string* name = materialNameOf(object); name != nullptr && !name->empty())
            small.materials[*name] = {};
        if (const auto* medium = std::get_if<MediumDesc>(&object.shape))
            visitTextureName(medium->albedo, [&](const std::string& name) {
                if (scene_.textures.contains(name)) small.textures[name] = SolidTexture{};
            });
        if (const InstanceDesc* instance = instanceOf(object)) {
            std::set<std::string> seen;
            if (!prototype_.empty() && reaches(scene_, instance->prototype, prototype_, seen))
                refuse(place, "prototype \"" + prototype_ + "\" would contain itself");
            if (scene_.prototypes.contains(instance->prototype)) small.prototypes[instance->prototype] = {};
        }
        small.objects = {object};
        checkByReader(small, "/objects/0", place);
    }

    const SceneDesc& scene_;
    const std::string& prototype_; // that the object is in; empty: in none
};

// ---- edits ---------------------------------------------------------------------------------------------------------

struct Check {
    const SceneDesc& scene;

    const ObjectDesc& object(const ObjectPath& path) const {
        const ObjectDesc* found = findObject(scene, path);
        if (found == nullptr) refuse(textOf(path), "there is no such object");
        return *found;
    }

    void operator()(const SetObject& edit) const {
        (void)object(edit.path);
        ObjectCheck(scene, edit.path).check(edit.object, textOf(edit.path));
    }
    void operator()(const SetTransform& edit) const {
        if (transformOf(object(edit.path)) == nullptr) refuse(textOf(edit.path), "such an object has no transform");
        checkTransform(edit.path, edit.transform);
    }
    void operator()(const SetMaterialOf& edit) const {
        const ObjectDesc& target = object(edit.path);
        if (materialNameOf(target) == nullptr) refuse(textOf(edit.path), "such an object has no material of its own");
        const bool mayLack = std::holds_alternative<InstanceDesc>(target.shape) || isMeshFile(target);
        if (edit.material.empty() && !mayLack) refuse(textOf(edit.path), "such an object needs a material");
        InstanceDesc named;
        named.material = edit.material;
        ObjectCheck(scene, edit.path).checkName({named}, textOf(edit.path));
    }
    void operator()(const SetHidden& edit) const { (void)object(edit.path); }
    void operator()(const PlaceObject& edit) const {
        if (!edit.object) return (void)object(edit.path);
        ObjectPath last = edit.path;
        const bool isInList = !last.indices.empty();
        if (isInList && last.indices.back() > 0) --last.indices.back();
        const bool isFirst = isInList && edit.path.indices.back() == 0;
        if (!isInList || !(isFirst ? hasList(edit.path) : findObject(scene, last) != nullptr))
            refuse(textOf(edit.path), "there is no such place for an object");
        ObjectCheck(scene, edit.path).check(*edit.object, textOf(edit.path));
    }
    void operator()(const WrapObject& edit) const {
        const ObjectDesc& target = object(edit.path);
        if (edit.transform) return checkTransform(edit.path, *edit.transform);
        const auto* group = std::get_if<GroupDesc>(&target.shape);
        if (group == nullptr || group->objects.size() != 1) refuse(textOf(edit.path), "this is no group of one object");
    }
    void operator()(const SetMaterial& edit) const {
        const std::string place = "/materials/" + edit.name;
        if (!edit.value)
            return checkRemoval(scene.materials.contains(edit.name), materialUses(scene, edit.name), place);
        SceneDesc small;
        small.materials[edit.name] = *edit.value;
        forEachTextureName(*edit.value, [&](const std::string& name) { addTexture(small, name); });
        checkByReader(small, place, place);
    }
    void operator()(const SetTexture& edit) const {
        const std::string place = "/textures/" + edit.name;
        if (!edit.value) return checkRemoval(scene.textures.contains(edit.name), textureUses(scene, edit.name), place);
        SceneDesc small;
        forEachInnerTexture(*edit.value, [&](const std::string& name) { addTexture(small, name); });
        small.textures[edit.name] = *edit.value;
        checkByReader(small, place, place);
    }
    void operator()(const SetPrototype& edit) const {
        const std::string place = "/prototypes/" + edit.name;
        if (edit.name.empty()) refuse(place, "a prototype needs a name");
        if (!edit.value)
            return checkRemoval(scene.prototypes.contains(edit.name), prototypeUses(scene, edit.name), place);
        const ObjectPath inside{edit.name, {}};
        for (std::size_t i = 0; i < edit.value->size(); ++i)
            ObjectCheck(scene, inside).check((*edit.value)[i], place + "/" + std::to_string(i));
    }
    void operator()(const SetModel& edit) const {
        const std::string place = "/models/" + edit.name;
        if (!edit.value) return checkRemoval(scene.models.contains(edit.name), modelUses(scene, edit.name), place);
        if (!isModelName(edit.name)) refuse(place, "the name of a model must not be empty, and not contain \": \"");
        if (scene.models.contains(edit.name) || hasContents(scene, edit.name))
            refuse(place, "the scene has names that begin as those of this model do");
    }
    void operator()(const SetCamera& edit) const { checkPart(&SceneDesc::camera, edit.value, "/camera"); }
    void operator()(const SetBackground& edit) const { checkPart(&SceneDesc::background, edit.value, "/background"); }
    void operator()(const SetRenderDefaults& edit) const { checkPart(&SceneDesc::render, edit.value, "/render"); }
    void operator()(const SetTargets& edit) const {
        checkPart(&SceneDesc::importanceTargets, edit.value, "/importance_targets");
    }
    void operator()(const SetTitle& edit) const { checkPart(&SceneDesc::title, edit.value, "/title"); }

    // A member of the description, in a scene that has nothing else.
    template <typename Member, typename Part>
    static void checkPart(Member part, const Part& value, const std::string& place) {
        SceneDesc small;
        small.*part = value;
        checkByReader(small, place, place);
    }
    static bool isMeshFile(const ObjectDesc& object) {
        const auto* mesh = std::get_if<MeshDesc>(&object.shape);
        return mesh != nullptr && std::holds_alternative<MeshFile>(mesh->source);
    }
    // That the object would be the first of.
    bool hasList(const ObjectPath& path) const {
        if (path.indices.size() == 1) return path.prototype.empty() || scene.prototypes.contains(path.prototype);
        ObjectPath group = path;
        group.indices.pop_back();
        const ObjectDesc* around = findObject(scene, group);
        return around != nullptr && std::holds_alternative<GroupDesc>(around->shape);
    }
    void checkTransform(const ObjectPath& path, const Transform& transform) const {
        GroupDesc group;
        group.transform = transform;
        ObjectCheck(scene, path).check({group}, textOf(path));
    }
    static void checkRemoval(bool exists, std::size_t uses, const std::string& place) {
        if (!exists) refuse(place, "there is nothing of this name");
        if (uses > 0) refuse(place, "cannot be removed while it is used " + std::to_string(uses) + " times");
    }
    void addTexture(SceneDesc& small, const std::string& name) const {
        if (scene.textures.contains(name)) small.textures[name] = SolidTexture{};
    }
};

} // namespace

void checkEdit(const SceneDesc& scene, const SceneEdit& edit) {
    std::visit(Check{scene}, edit);
}

std::size_t materialUses(const SceneDesc& scene, const std::string& name) {
    std::size_t uses = 0;
    forEachObject(scene, [&](const ObjectDesc& object) {
        const std::string* own = materialNameOf(object);
        uses += own != nullptr && *own == name;
    });
    return uses;
}

std::size_t textureUses(const SceneDesc& scene, const std::string& texture) {
    std::size_t uses = 0;
    const auto count = [&](const std::string& name) { uses += name == texture; };
    for (const auto& [name, material] : scene.materials) forEachTextureName(material, count);
    for (const auto& [name, other] : scene.textures) forEachInnerTexture(other, count);
    forEachObject(scene, [&](const ObjectDesc& object) {
        if (const auto* medium = std::get_if<MediumDesc>(&object.shape)) visitTextureName(medium->albedo, count);
    });
    return uses;
}

std::size_t meshesWithoutTangents(const SceneDesc& scene, const std::string& material) {
    std::size_t count = 0;
    forEachObject(scene, [&](const ObjectDesc& object) {
        const auto* mesh = std::get_if<MeshDesc>(&object.shape);
        if (mesh == nullptr || mesh->material != material) return;
        if (const auto* data = std::get_if<Boxed<MeshData>>(&mesh->source))
            count += (*data)->tangents.empty();
        else if (const auto* floats = std::get_if<Boxed<FloatMeshData>>(&mesh->source))
            count += (*floats)->tangents.empty();
        else
            ++count; // a file of OBJ has them where its own materials want them
    });
    return count;
}

} // namespace rt::scene
