#include "Common/Scene/Obj/ObjLoader.h"

#include <array>
#include <charconv>
#include <cstdint>
#include <set>
#include <string_view>

#include "Common/Core/Error.h"
#include "Common/Core/Printable.h"
#include "Common/Scene/Compiler/Bounds.h"
#include "Common/Scene/Counted.h"
#include "Common/Scene/FramingCamera.h"
#include "Common/Scene/Obj/MtlMaterials.h"
#include "Common/Scene/Obj/ObjFiles.h"
#include "Common/Scene/Obj/ObjGeometry.h"
#include "Common/Scene/Obj/ObjText.h"
#include "Common/Scene/Obj/ObjTroubles.h"
#include "Common/Scene/Tangents.h"

namespace rt::scene {

namespace {

namespace fs = std::filesystem;

// Statements that are no faces, which alone are rendered.
struct ElementKind {
    std::string_view keyword;
    const char *one, *many;
};
constexpr std::array<ElementKind, 4> kElements = {{{"l", "line", "lines"},
                                                   {"p", "point", "points"},
                                                   {"curv", "curve", "curves"},
                                                   {"surf", "free-form surface", "free-form surfaces"}}};

class ObjReader {
  public:
    ObjReader(const fs::path& path, bool withMaterials, const std::string& prefix)
        : path_(path.string()),
          folder_(path.parent_path()),
          withMaterials_(withMaterials),
          materials_(folder_, prefix, files_, model_) {}

    void read(std::string_view text) {
        for (TextLines lines(text); lines.next();) {
            std::string_view rest = lines.line();
            const std::string_view keyword = takeWord(rest);
            readStatement(keyword, {rest, lines.source(), lines.number()});
        }
        geometry_.finish();
    }

    // Materials are looked up now, as their files may be named anywhere.
    ObjModel model() {
        std::map<std::string, ObjGeometry::Triangles> known; // by key of the material; empty: none has it
        for (auto& [name, triangles] : geometry_.parts()) {
            if (triangles.empty()) continue;
            ObjGeometry::Triangles& all = known[keyOf(name)];
            if (all.empty())
                all = std::move(triangles);
            else
                all.insert(all.end(), triangles.begin(), triangles.end());
            triangles = {};
        }
        for (auto& [material, triangles] : known) addParts(material, triangles);
        if (model_.parts.empty()) refuse();
        appendNotices();
        return std::move(model_);
    }

  private:
    void readStatement(std::string_view keyword, const ObjStatement& statement) {
        const auto is = [&](std::string_view name) { return keyword == name || lowerCase(keyword) == name; };
        if (keyword.size() <= 2) {
            if (is("v")) return geometry_.addPosition(statement, withMaterials_);
            if (is("vt")) return geometry_.addUv(statement);
            if (is("vn")) return geometry_.addNormal(statement);
            if (is("f") || is("fo")) return geometry_.addFace(statement);
            if (is("s")) return geometry_.smooth(smoothingGroup(statement.rest));
        } else if (withMaterials_ && is("usemtl")) {
            return geometry_.useMaterial(nameIn(statement.rest));
        } else if (withMaterials_ && is("mtllib")) {
            return addMaterialFiles(trimmed(statement.rest));
        }
        for (std::size_t i = 0; i < kElements.size(); ++i) elements_[i] += is(kElements[i].keyword);
    }

    // 0, off and what is no number: none.
    static std::uint32_t smoothingGroup(std::string_view rest) {
        const std::string_view word = takeWord(rest);
        std::uint32_t group = 0;
        std::from_chars(word.data(), word.data() + word.size(), group);
        return lowerCase(word) == "on" ? 1 : group;
    }

    // A name may have spaces, and there may be several.
    void addMaterialFiles(std::string_view names) {
        if (const fs::path whole = files_.find(names, folder_); !whole.empty()) return addMaterials(whole);
        std::vector<fs::path> paths;
        std::set<std::string> missing;
        for (std::string_view rest = names, name = takeWord(rest); !name.empty(); name = takeWord(rest)) {
            paths.push_back(files_.findMoved(withoutQuotes(name), folder_));
            if (paths.back().empty()) missing.emplace(name);
        }
        if (!missing.empty())
            if (const fs::path moved = files_.findMoved(names, folder_); !moved.empty()) return addMaterials(moved);
        for (const fs::path& path : paths)
            if (!path.empty()) addMaterials(path);
        missingFiles_.merge(missing);
    }

    void addMaterials(const fs::path& file) {
        if (read_.insert(file).second) materials_.addFile(file);
    }

    std::string keyOf(const std::string& name) {
        if (const std::string* key = materials_.find(name)) return *key;
        if (!name.empty()) unknown_.insert(name);
        return {};
    }

    void addParts(const std::string& material, ObjGeometry::Triangles& triangles) {
        const bool isTinted = material.empty() || takesVertexColors(model_.materials.at(material));
        if (!isTinted && geometry_.hasColors(triangles)) ++untinted_;
        const std::size_t first = model_.parts.size();
        for (MeshData& mesh : geometry_.meshes(triangles, isTinted))
            model_.parts.push_back({material, std::move(mesh)});
        triangles = {};
        noteMixture(first);
        for (std::size_t i = first; i < model_.parts.size(); ++i) dress(model_.parts[i]);
    }

    // Counts the triangles of parts of one material from `first` on that do without what others there have.
    void noteMixture(std::size_t first) {
        const auto note = [&](auto attribute, Lack& lack) {
            std::size_t without = 0, with = 0;
            for (std::size_t i = first; i < model_.parts.size(); ++i) {
                const MeshData& mesh = model_.parts[i].mesh;
                ((mesh.*attribute).empty() ? without : with) += mesh.triangles.size();
            }
            if (without == 0 || with == 0) return;
            lack.triangles += without;
            ++lack.materials;
        };
        note(&MeshData::uvs, withoutUvs_);
        note(&MeshData::normals, withoutNormals_);
        note(&MeshData::colors, withoutColors_);
    }

    // Gives a part the material that it can have, and what that needs.
    void dress(ObjPart& part) {
        MeshData& mesh = part.mesh;
        if (part.material.empty() && mesh.colors.empty()) return;
        if (part.material.empty()) part.material = materials_.white();
        if (mesh.uvs.empty()) {
            const std::string& bare = materials_.withoutMaps(part.material);
            if (bare != part.material) unmapped_ += mesh.triangles.size();
            part.material = bare;
        }
        part.isUnlit = materials_.isUnlit(part.material);
        MaterialDesc& material = model_.materials.at(part.material);
        if (!mesh.colors.empty()) material = withVertexColors(material);
        if (!material.principled.normalTexture.empty()) addTangents(mesh, 0);
    }

    std::string describeElements() const {
        std::string text;
        for (std::size_t i = 0; i < kElements.size(); ++i)
            if (elements_[i] > 0)
                text += (text.empty() ? "" : ", ") + counted(elements_[i], kElements[i].one, kElements[i].many);
        return text;
    }

    [[noreturn]] void refuse() const {
        if (const auto reason = troubles_.whyNoFace(path_)) throw InputError(*reason);
        const std::string elements = describeElements();
        throw InputError(path_ + ": there is no face in it" +
                         (elements.empty() ? "" : ", and nothing else can be rendered: " + elements));
    }

    struct Lack {
        std::size_t triangles = 0, materials = 0;
    };
    void appendNotices() {
        const auto say = [&](const std::string& what) { model_.notices.push_back(path_ + ": " + what); };
        const auto sayLack = [&](const Lack& lack, const std::string& what) {
            if (lack.triangles == 0) return;
            say(counted(lack.triangles, "triangle", "triangles") + " of " +
                counted(lack.materials, "material", "materials") + (lack.triangles == 1 ? " does" : " do") +
                " without " + what + ", which others of the material have");
        };
        if (const std::string elements = describeElements(); !elements.empty())
            say("left out, as only faces are rendered: " + elements);
        troubles_.appendNotices(path_, model_.notices);
        sayLack(withoutUvs_, "texture coordinates");
        sayLack(withoutNormals_, "normals");
        sayLack(withoutColors_, "colours of vertices");
        if (unmapped_ > 0)
            say(counted(unmapped_, "triangle is", "triangles are") +
                " without texture coordinates and so without the images of the material");
        geometry_.appendColorNotices(path_, model_.notices);
        if (untinted_ > 0)
            say("the colours of vertices are left out of " + counted(untinted_, "material", "materials") +
                ": mirrors and glass take none");
        if (!missingFiles_.empty()) say("material files that do not exist: " + listed(missingFiles_));
        if (!unknown_.empty()) say("materials that none of its material files has, grey instead: " + listed(unknown_));
        materials_.appendNotices();
        if (!files_.foundInOtherCase().empty())
            say("files that are named in other case: " + listed(files_.foundInOtherCase()));
    }

    const std::string path_;
    const fs::path folder_;
    const bool withMaterials_;
    ObjModel model_;
    FileFinder files_;
    MtlMaterials materials_;
    ObjTroubles troubles_;
    ObjGeometry geometry_{troubles_};
    std::set<fs::path> read_; // files of materials
    std::set<std::string> missingFiles_, unknown_;
    std::array<std::size_t, kElements.size()> elements_{};
    Lack withoutUvs_, withoutNormals_, withoutColors_;
    std::size_t unmapped_ = 0; // triangles
    std::size_t untinted_ = 0; // materials that the colours of vertices do not multiply
};

} // namespace

MaterialDesc plainMaterial() {
    MaterialDesc material;
    material.albedo = glm::dvec3(0.7);
    return material;
}

ObjModel loadObj(const fs::path& path, bool withMaterials, const std::string& prefix) {
    const std::vector<std::byte> bytes = readText(path);
    ObjReader reader(path, withMaterials, prefix);
    reader.read({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
    return reader.model();
}

SceneDesc loadObjScene(const fs::path& path) {
    ObjModel model = loadObj(path, true);
    SceneDesc scene;
    scene.id = path.filename().string();
    scene.title = printable(scene.id);
    scene.notices = std::move(model.notices);
    scene.materials = std::move(model.materials);
    scene.textures = std::move(model.textures);
    Bounds bounds;
    for (ObjPart& part : model.parts) {
        for (const glm::dvec3& position : part.mesh.positions) bounds.add(position);
        if (part.material.empty()) {
            part.material = "plain";
            while (scene.materials.count(part.material) > 0) part.material += '\'';
            scene.materials[part.material] = plainMaterial();
        }
        MeshDesc mesh;
        mesh.source = std::move(part.mesh);
        mesh.material = part.material;
        mesh.light = !part.isUnlit;
        scene.objects.push_back({std::move(mesh)});
    }
    scene.camera = framingCamera(bounds);
    return scene;
}

} // namespace rt::scene
