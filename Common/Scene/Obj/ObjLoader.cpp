#include "Common/Scene/Obj/ObjLoader.h"

#include <algorithm>
#include <cmath>
#include <istream>
#include <streambuf>
#include <string_view>
#include <system_error>
#include <tiny_obj_loader.h>

#include <glm/common.hpp>

#include "Common/Core/Error.h"
#include "Common/Core/Interruption.h"
#include "Common/Core/ReadFile.h"
#include "Common/Scene/Compiler/Bounds.h"
#include "Common/Scene/FramingCamera.h"
#include "Common/Scene/Obj/Polygon.h"
#include "Common/Shared/Base/Types.h"

namespace rt::scene {

namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kMaxFileBytes = std::uint64_t{16} << 30;

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

std::string trimmed(std::string text) {
    text.erase(text.find_last_not_of(" \t\r") + 1);
    return text;
}

// ---- materials -----------------------------------------------------------------------------------------------------

glm::dvec3 color(const float (&rgb)[3], double high) {
    return glm::clamp(glm::dvec3(rgb[0], rgb[1], rgb[2]), 0.0, high);
}

// An image that a material names, as a texture of the model; returns its name.
std::string addImage(const std::string& name, const glm::dvec3& tint, const std::string& key, const fs::path& folder,
                     ObjModel& model, const std::string& place) {
    std::string portable = name;
    std::replace(portable.begin(), portable.end(), '\\', '/');
    const fs::path path = folder / fs::path(portable);
    std::error_code ignored;
    if (!fs::is_regular_file(path, ignored)) throw InputError(place + ": no such image file: " + path.generic_string());
    model.textures[key] = ImageTexture{fs::absolute(path).lexically_normal().generic_string(), {}, tint};
    return key;
}

MaterialDesc toMaterial(const tinyobj::material_t& source, const std::string& key, const fs::path& folder,
                        ObjModel& model, const std::string& file) {
    MaterialDesc material;
    const glm::dvec3 diffuse = color(source.diffuse, 1);
    const std::string place = file + ": material \"" + source.name + "\"";
    material.albedo = diffuse;
    if (!source.diffuse_texname.empty())
        material.albedo = addImage(source.diffuse_texname, diffuse, key + "/map_Kd", folder, model, place);
    switch (source.illum) { // the reflection models of the format's specification
        case 3:
        case 5:
        case 8:
            material.kind = MaterialKind::Metal;
            material.albedo = color(source.specular, 1);
            material.parameters[shared::kMetalFuzz] = std::clamp(double(source.roughness), 0.0, 1.0);
            break;
        case 4:
        case 6:
        case 7:
        case 9: {
            const glm::dvec3 filter = color(source.transmittance, 1);
            material.kind = MaterialKind::Dielectric;
            material.albedo = filter == glm::dvec3(0) ? glm::dvec3(1) : filter; // the format's default is 0 here
            material.parameters[shared::kDielectricIor] = source.ior > 1 ? double(source.ior) : 1.5;
            break;
        }
        default:
            break;
    }
    material.emission = color(source.emission, 1e30);
    if (!source.emissive_texname.empty()) {
        if (material.emission == glm::dvec3(0)) material.emission = glm::dvec3(1);
        material.emissionTexture =
            addImage(source.emissive_texname, glm::dvec3(1), key + "/map_Ke", folder, model, place);
    }
    return material;
}

// ---- geometry ------------------------------------------------------------------------------------------------------

// Receives the parser's events.
class Builder : public tinyobj::MaterialReader {
  public:
    Builder(const fs::path& path, const MemoryBuffer& buffer, const std::string& prefix)
        : path_(path), buffer_(buffer), prefix_(prefix) {}

    [[noreturn]] void fail(const std::string& message) const {
        throw InputError(path_.string() + ":" + std::to_string(buffer_.line()) + ": " + message);
    }

    void addPosition(float x, float y, float z) {
        interruptionPoint();
        checkNumbers(3);
        if (!std::isfinite(x) || !std::isfinite(y) || !std::isfinite(z)) fail("a coordinate is too large");
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

    // MaterialReader: one file of materials.
    bool operator()(const std::string& name, std::vector<tinyobj::material_t>* materials,
                    std::map<std::string, int>* ids, std::string* warnings, std::string* errors) override {
        const fs::path file = path_.parent_path() / fs::path(trimmed(name));
        std::error_code ignored;
        if (!fs::is_regular_file(file, ignored)) fail("no such material file: " + file.string());
        std::vector<std::byte> bytes = readFile(file, kMaxFileBytes);
        MemoryBuffer buffer(bytes);
        std::istream stream(&buffer);
        tinyobj::LoadMtl(ids, materials, &stream, warnings, errors);
        const auto isNamed = [](const tinyobj::material_t& material) { return !material.name.empty(); };
        if (std::none_of(materials->begin(), materials->end(), isNamed)) // the parser makes one of nothing
            model_.notices.push_back(file.string() + ": there is no material in it");
        for (const tinyobj::material_t& material : *materials)
            if (!material.name.empty()) {
                const std::string key = prefix_ + material.name;
                model_.materials[key] = toMaterial(material, key, path_.parent_path(), model_, file.string());
            }
        return true;
    }

    void useMaterial(const std::string& name) {
        const std::string key = prefix_ + trimmed(name);
        if (model_.materials.count(key) == 0)
            fail("material \"" + trimmed(name) + "\" is in none of its material files");
        part_ = &parts_[key];
    }

    ObjModel finish() {
        for (auto& [material, part] : parts_)
            if (!part.triangles.empty()) model_.parts.push_back({material, toMesh(part.triangles)});
        if (model_.parts.empty()) throw InputError(path_.string() + ": there is no face in it");
        return std::move(model_);
    }

  private:
    static constexpr std::uint32_t kNone = shared::kNone;

    // The parser takes what is no number for 0: the first `count` fields behind the keyword of the line at hand must be
    // numbers.
    void checkNumbers(int count) const {
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
    }

    // A combination of indices that some corner has; those of one position are chained.
    struct Vertex {
        std::uint32_t position, uv, normal;
        std::uint32_t next;
    };
    struct Part {
        std::vector<glm::uvec3> triangles; // indices into vertices_
    };

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

    MeshData toMesh(std::vector<glm::uvec3>& triangles) {
        MeshData mesh;
        renamed_.assign(vertices_.size(), kNone);
        bool hasNormals = true, hasUvs = true;
        std::vector<std::uint32_t> used;
        for (glm::uvec3& t : triangles)
            for (int i = 0; i < 3; ++i) {
                std::uint32_t& name = renamed_[t[i]];
                if (name == kNone) {
                    name = static_cast<std::uint32_t>(used.size());
                    used.push_back(t[i]);
                    hasNormals = hasNormals && vertices_[t[i]].normal != kNone;
                    hasUvs = hasUvs && vertices_[t[i]].uv != kNone;
                }
                t[i] = name;
            }
        mesh.triangles = std::move(triangles);
        for (const std::uint32_t index : used) {
            const Vertex& v = vertices_[index];
            mesh.positions.emplace_back(positions_[v.position]);
            if (hasNormals) mesh.normals.emplace_back(normals_[v.normal]);
            if (hasUvs) mesh.uvs.emplace_back(uvs_[v.uv]);
        }
        return mesh;
    }

    const fs::path& path_;
    const MemoryBuffer& buffer_;
    const std::string& prefix_;
    ObjModel model_;
    std::vector<glm::vec3> positions_, normals_;
    std::vector<glm::vec2> uvs_;
    std::vector<Vertex> vertices_;
    std::vector<std::uint32_t> firstVertex_; // of each position
    std::map<std::string, Part> parts_;      // by material
    Part* part_ = nullptr;
    std::vector<std::uint32_t> face_; // scratch
    std::vector<glm::dvec3> outline_;
    std::vector<std::uint32_t> renamed_;
};

Builder& builder(void* user) {
    return *static_cast<Builder*>(user);
}

} // namespace

MaterialDesc plainMaterial() {
    MaterialDesc material;
    material.albedo = glm::dvec3(0.7);
    return material;
}

ObjModel loadObj(const fs::path& path, bool withMaterials, const std::string& prefix) {
    std::vector<std::byte> bytes = readFile(path, kMaxFileBytes);
    MemoryBuffer buffer(bytes);
    std::istream stream(&buffer);
    Builder target(path, buffer, prefix);
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
    return target.finish();
}

SceneDesc loadObjScene(const fs::path& path) {
    ObjModel model = loadObj(path, true);
    SceneDesc scene;
    scene.id = scene.title = path.filename().string();
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
