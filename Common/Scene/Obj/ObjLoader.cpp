#include "Common/Scene/Obj/ObjLoader.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <locale>
#include <set>
#include <sstream>
#include <streambuf>
#include <string_view>
#include <tiny_obj_loader.h>

#include "Common/Core/Error.h"
#include "Common/Core/Interruption.h"
#include "Common/Core/Printable.h"
#include "Common/Scene/Compiler/Bounds.h"
#include "Common/Scene/FramingCamera.h"
#include "Common/Scene/Obj/MtlMaterials.h"
#include "Common/Scene/Obj/ObjText.h"
#include "Common/Scene/Obj/Polygon.h"
#include "Common/Scene/Tangents.h"
#include "Common/Shared/Base/Types.h"
#include "Common/Shared/Tonemap.h"

namespace rt::scene {

namespace {

namespace fs = std::filesystem;

// A file in memory as a stream that knows how far it has been read.
class MemoryBuffer : public std::streambuf {
  public:
    explicit MemoryBuffer(std::vector<std::byte>& bytes) {
        char* begin = reinterpret_cast<char*>(bytes.data());
        setg(begin, begin, begin + bytes.size());
    }
    // Of the line read last.
    std::ptrdiff_t line() const {
        const std::ptrdiff_t ended = std::count(eback(), gptr(), '\n');
        const bool isMidLine = gptr() != eback() && gptr()[-1] != '\n';
        return std::max<std::ptrdiff_t>(1, ended + isMidLine);
    }
    // The line read last, with its end.
    std::string_view text() const {
        const std::string_view all(eback(), static_cast<std::size_t>(gptr() - eback()));
        const std::size_t last = all.find_last_not_of("\r\n");
        const std::size_t before = last == all.npos ? last : all.find_last_of("\r\n", last);
        return before == all.npos ? all : all.substr(before + 1);
    }
};

// Receives the parser's events.
class ObjBuilder : public tinyobj::MaterialReader {
  public:
    ObjBuilder(const fs::path& path, const MemoryBuffer& buffer, bool withColors, const std::string& prefix)
        : path_(path), buffer_(buffer), withColors_(withColors), materials_(path.parent_path(), prefix, model_) {
        numbers_.imbue(std::locale::classic());
    }

    [[noreturn]] void fail(const std::string& message) const {
        throw InputError(path_.string() + ":" + std::to_string(buffer_.line()) + ": " + message);
    }

    void addPosition(float x, float y, float z) {
        interruptionPoint();
        const std::string_view rest = checkNumbers(3);
        if (!std::isfinite(x) || !std::isfinite(y) || !std::isfinite(z)) fail("a coordinate is too large");
        if (countWords(rest) >= 3) addColor(rest);
        positions_.emplace_back(x, y, z);
        firstVertex_.push_back(shared::kNone);
    }
    void addNormal(float x, float y, float z) {
        checkNumbers(3);
        normals_.emplace_back(x, y, z);
    }
    void addUv(float x, float y) {
        checkNumbers(1);
        if (!std::isfinite(x) || !std::isfinite(y)) fail("a texture coordinate is too large");
        uvs_.emplace_back(x, y);
    }

    void addFace(const tinyobj::index_t* corners, int count) {
        interruptionPoint();
        if (count < 3) fail("a face of " + std::to_string(count) + " corners: at least 3 are needed");
        if (static_cast<std::size_t>(count) > kMaxPolygonCorners)
            fail("a face of " + std::to_string(count) + " corners: at most " + std::to_string(kMaxPolygonCorners));
        face_.clear();
        outline_.clear();
        for (int i = 0; i < count; ++i) {
            face_.push_back(vertex(corners[i]));
            outline_.emplace_back(positions_[vertices_[face_.back()].position]);
        }
        std::vector<glm::uvec3>& triangles = current().triangles;
        if (count == 3)
            triangles.emplace_back(face_[0], face_[1], face_[2]);
        else
            for (const glm::uvec3& t : cutPolygon(outline_)) triangles.emplace_back(face_[t.x], face_[t.y], face_[t.z]);
    }

    // MaterialReader: asked for each word of a line, whose words may be files or, together, the name of one.
    bool operator()(const std::string&, std::vector<tinyobj::material_t>*, std::map<std::string, int>*, std::string*,
                    std::string*) override {
        std::string_view names = trimmed(buffer_.text().substr(0, buffer_.text().find_first_of("\r\n")));
        names = trimmed(names.substr(std::string_view("mtllib").size()));
        const fs::path folder = path_.parent_path();
        if (const fs::path whole = findNamed(names, folder); !whole.empty()) {
            addMaterials(whole);
            return true;
        }
        std::vector<fs::path> files;
        std::set<std::string> missing;
        for (std::string_view rest = names; !rest.empty();) {
            const std::string_view name = rest.substr(0, rest.find_first_of(" \t"));
            rest = trimmed(rest.substr(name.size()));
            files.push_back(findMoved(name, folder));
            if (files.back().empty()) missing.emplace(name);
        }
        if (const fs::path moved = findMoved(names, folder); !missing.empty() && !moved.empty()) {
            files = {moved};
            missing.clear();
        }
        for (const fs::path& file : files)
            if (!file.empty()) addMaterials(file);
        missingFiles_.merge(missing);
        return true;
    }

    void useMaterial(std::string_view name) { part_ = &parts_[std::string(trimmed(name))]; }

    // Materials are looked up now, as their files may be named anywhere.
    ObjModel finish(std::string_view text) {
        const std::string leftOut = describeLeftOut(text);
        Part plain;
        std::map<std::string, Part> known;
        std::set<std::string> unknown;
        for (auto& [name, part] : parts_) {
            if (part.triangles.empty()) continue;
            const std::string* material = materials_.find(name);
            if (!material && !name.empty()) unknown.insert(name);
            std::vector<glm::uvec3>& triangles = material ? known[*material].triangles : plain.triangles;
            if (triangles.empty())
                triangles = std::move(part.triangles);
            else
                triangles.insert(triangles.end(), part.triangles.begin(), part.triangles.end());
        }
        if (!plain.triangles.empty()) {
            model_.parts.push_back({{}, toMesh(plain.triangles, true)});
            if (!model_.parts.back().mesh.colors.empty()) model_.parts.back().material = materials_.addWhite();
        }
        for (auto& [material, part] : known) {
            const bool isTinted = takesVertexColors(model_.materials.at(material));
            model_.parts.push_back({material, toMesh(part.triangles, isTinted)});
            MeshData& mesh = model_.parts.back().mesh;
            if (!mesh.colors.empty()) model_.materials.at(material) = withVertexColors(model_.materials.at(material));
            const bool hasMap = !model_.materials.at(material).principled.normalTexture.empty();
            if (hasMap && !mesh.uvs.empty()) addTangents(mesh, 0);
        }
        if (model_.parts.empty())
            throw InputError(path_.string() + ": there is no face in it" +
                             (leftOut.empty() ? "" : ", and nothing else can be rendered: " + leftOut));
        if (!leftOut.empty())
            model_.notices.push_back(path_.string() + ": left out, as only faces are rendered: " + leftOut);
        if (!missingFiles_.empty())
            model_.notices.push_back(path_.string() + ": material files that do not exist: " + listed(missingFiles_));
        if (!unknown.empty())
            model_.notices.push_back(
                path_.string() + ": materials that none of its material files has, grey instead: " + listed(unknown));
        if (uncoloredParts_ > 0)
            model_.notices.push_back(path_.string() + ": the colours of vertices are left out of " +
                                     std::to_string(uncoloredParts_) +
                                     (uncoloredParts_ == 1 ? " material" : " materials") +
                                     ": mirrors and glass take none, and every vertex must have one");
        materials_.appendNotices();
        return std::move(model_);
    }

  private:
    static constexpr std::uint32_t kNone = shared::kNone;

    // The parser takes what is no number for 0: the first `count` fields behind the keyword of the line at hand must be
    // numbers. Returns what is behind them.
    std::string_view checkNumbers(int count) const {
        constexpr const char* kSpace = " \t\r\n";
        std::string_view rest = buffer_.text();
        rest.remove_prefix(std::min(rest.find_first_not_of(kSpace), rest.size()));
        for (int i = 0; i < count; ++i) {
            rest.remove_prefix(std::min(rest.find_first_of(kSpace), rest.size()));
            rest.remove_prefix(std::min(rest.find_first_not_of(kSpace), rest.size()));
            const std::string_view field = rest.substr(0, rest.find_first_of(kSpace));
            if (field.empty()) fail("a number is missing");
            if (field.find_first_not_of("+-.0123456789eE") != field.npos)
                fail("\"" + std::string(field) + "\" is not a finite number");
        }
        rest.remove_prefix(std::min(rest.find_first_of(kSpace), rest.size()));
        return rest;
    }

    // Red, green and blue behind the position that is added next, encoded as in images: no specification has them, and
    // Blender's importer reads them so. Vertices before them that have none are -1.
    void addColor(std::string_view text) {
        if (!withColors_) return;
        glm::vec3 color(0);
        numbers_.clear();
        numbers_.str(std::string(text.substr(0, text.find_first_of("\r\n"))));
        if (!(numbers_ >> color.r >> color.g >> color.b)) fail("the colour of a vertex must be three finite numbers");
        colors_.resize(positions_.size(), glm::vec3(-1));
        for (int c = 0; c < 3; ++c) color[c] = shared::srgbDecode(std::clamp(color[c], 0.0f, 1.0f));
        colors_.push_back(color);
    }
    bool hasColor(std::uint32_t position) const { return position < colors_.size() && colors_[position].r >= 0; }

    // A combination of indices that some corner has; those of one position are chained.
    struct Vertex {
        std::uint32_t position, uv, normal;
        std::uint32_t next;
    };
    struct Part {
        std::vector<glm::uvec3> triangles; // indices into vertices_
    };

    void addMaterials(const fs::path& file) {
        if (files_.insert(file).second) materials_.addFile(file);
    }

    Part& current() {
        if (!part_) part_ = &parts_[""];
        return *part_;
    }

    // From the file's index, which counts from 1, or backwards from the end if negative; 0: none.
    std::uint32_t resolve(int index, std::size_t count, const char* what) const {
        const std::int64_t resolved = index > 0 ? std::int64_t{index} - 1 : static_cast<std::int64_t>(count) + index;
        if (resolved < 0 || resolved >= static_cast<std::int64_t>(count))
            fail(std::string(what) + " index " + std::to_string(index) + ": there are " + std::to_string(count) +
                 " so far");
        return static_cast<std::uint32_t>(resolved);
    }

    std::uint32_t vertex(const tinyobj::index_t& corner) {
        if (corner.vertex_index == 0) fail("a vertex index must be a whole number that is not 0");
        Vertex v{};
        v.position = resolve(corner.vertex_index, positions_.size(), "vertex");
        v.uv = corner.texcoord_index == 0 ? kNone : resolve(corner.texcoord_index, uvs_.size(), "texture coordinate");
        v.normal = corner.normal_index == 0 ? kNone : resolve(corner.normal_index, normals_.size(), "normal");
        std::uint32_t* link = &firstVertex_[v.position];
        while (*link != kNone) {
            const Vertex& known = vertices_[*link];
            if (known.uv == v.uv && known.normal == v.normal) return *link;
            link = &vertices_[*link].next;
        }
        const auto index = static_cast<std::uint32_t>(vertices_.size());
        *link = index;
        v.next = kNone;
        vertices_.push_back(v);
        return index;
    }

    MeshData toMesh(std::vector<glm::uvec3>& triangles, bool takesColors) {
        MeshData mesh;
        renamed_.assign(vertices_.size(), kNone);
        bool hasNormals = true, hasUvs = true, hasColors = takesColors, hasAnyColor = false;
        std::vector<std::uint32_t> used;
        for (glm::uvec3& t : triangles)
            for (int i = 0; i < 3; ++i) {
                std::uint32_t& name = renamed_[t[i]];
                if (name == kNone) {
                    name = static_cast<std::uint32_t>(used.size());
                    used.push_back(t[i]);
                    hasNormals = hasNormals && vertices_[t[i]].normal != kNone;
                    hasUvs = hasUvs && vertices_[t[i]].uv != kNone;
                    const bool isColored = hasColor(vertices_[t[i]].position);
                    hasColors = hasColors && isColored;
                    hasAnyColor = hasAnyColor || isColored;
                }
                t[i] = name;
            }
        mesh.triangles = std::move(triangles);
        for (const std::uint32_t index : used) {
            const Vertex& v = vertices_[index];
            mesh.positions.emplace_back(positions_[v.position]);
            if (hasNormals) mesh.normals.emplace_back(normals_[v.normal]);
            if (hasUvs) mesh.uvs.emplace_back(uvs_[v.uv]);
            if (hasColors) mesh.colors.emplace_back(colors_[v.position], 1);
        }
        uncoloredParts_ += hasAnyColor && !hasColors;
        return mesh;
    }

    const fs::path& path_;
    const MemoryBuffer& buffer_;
    const bool withColors_;
    ObjModel model_;
    MtlMaterials materials_;
    std::set<fs::path> files_; // of materials, read
    std::set<std::string> missingFiles_;
    std::vector<glm::vec3> positions_, normals_;
    std::vector<glm::vec3> colors_;  // linear, of as many positions as the last that has one; -1: it has none
    std::istringstream numbers_;     // scratch
    std::size_t uncoloredParts_ = 0; // some of whose vertices have colours that do not count
    std::vector<glm::vec2> uvs_;
    std::vector<Vertex> vertices_;
    std::vector<std::uint32_t> firstVertex_; // of each position
    std::map<std::string, Part> parts_;      // by name of the material in the file
    Part* part_ = nullptr;
    std::vector<std::uint32_t> face_; // scratch
    std::vector<glm::dvec3> outline_;
    std::vector<std::uint32_t> renamed_;
};

ObjBuilder& builder(void* user) {
    return *static_cast<ObjBuilder*>(user);
}

} // namespace

MaterialDesc plainMaterial() {
    MaterialDesc material;
    material.albedo = glm::dvec3(0.7);
    return material;
}

ObjModel loadObj(const fs::path& path, bool withMaterials, const std::string& prefix) {
    std::vector<std::byte> bytes = readText(path);
    MemoryBuffer buffer(bytes);
    std::istream stream(&buffer);
    ObjBuilder target(path, buffer, withMaterials, prefix);
    tinyobj::callback_t events;
    events.vertex_cb = [](void* user, float x, float y, float z, float) { builder(user).addPosition(x, y, z); };
    events.normal_cb = [](void* user, float x, float y, float z) { builder(user).addNormal(x, y, z); };
    events.texcoord_cb = [](void* user, float x, float y, float) { builder(user).addUv(x, y); };
    events.index_cb = [](void* user, tinyobj::index_t* corners, int count) { builder(user).addFace(corners, count); };
    if (withMaterials) events.usemtl_cb = [](void* user, const char* name, int) { builder(user).useMaterial(name); };
    std::string warnings, errors;
    const bool isRead =
        tinyobj::LoadObjWithCallback(stream, events, &target, withMaterials ? &target : nullptr, &warnings, &errors);
    if (!isRead || !errors.empty()) target.fail(errors.substr(0, errors.find('\n')));
    return target.finish({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

SceneDesc loadObjScene(const fs::path& path) {
    ObjModel model = loadObj(path, true);
    SceneDesc scene;
    scene.id = path.filename().string();
    scene.title = printable(scene.id);
    scene.background = GradientBackground{};
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
        scene.objects.push_back({std::move(mesh)});
    }
    scene.camera = framingCamera(bounds);
    return scene;
}

} // namespace rt::scene
