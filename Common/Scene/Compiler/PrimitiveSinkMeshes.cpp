// How PrimitiveSink appends surfaces of meshes: triangles without area are dropped, the others sorted along a curve.
// Vertices stand in the order of their first use.
#include <algorithm>
#include <atomic>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "Common/Core/Error.h"
#include "Common/Core/Interruption.h"
#include "Common/Core/Parallel.h"
#include "Common/Core/SystemMemory.h"
#include "Common/Scene/Compiler/LightTable.h"
#include "Common/Scene/Compiler/NearDivision.h"
#include "Common/Scene/Compiler/PrimitiveSink.h"
#include "Common/Scene/Compiler/Representable.h"

namespace rt::scene {

namespace {

constexpr std::size_t kChunk = 1u << 13; // vertices or triangles that a thread converts at a time
constexpr std::size_t kPieces = 4096;    // room for what huge surfaces are divided into: arrays that grow are copied
constexpr std::size_t kManyVertices = 1u << 18; // beside whose memory it is worth milliseconds to give some back

// Tangents go with the surface; the bitangent turns over with a map that mirrors, as the winding does.
shared::vec4 tangentOf(const glm::dvec4& authored, const Affine& map) {
    const glm::dvec3 along = map.vector(glm::dvec3(authored));
    if (!(glm::dot(along, along) > 0) || !representable(along)) return shared::vec4(0.0f);
    const double sign = (authored.w < 0) != map.mirrors() ? -1 : 1;
    return shared::vec4(glm::dvec4(glm::normalize(along), sign));
}

template <class Vec3>
std::vector<shared::vec3> mapped(const std::vector<Vec3>& positions, const Affine& map) {
    std::vector<shared::vec3> result;
    resizeLarge(result, positions.size());
    parallelChunks(0, result.size(), kChunk, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) result[i] = shared::vec3(map.point(glm::dvec3(positions[i])));
    });
    return result;
}

struct KeptTriangles {
    std::vector<std::uint32_t> numbers; // of those that have an area
    bool mustBeDivided;                 // as one is huge, where any may be divided
};

// `whose`: begins the message about a triangle of a vertex that there is not.
KeptTriangles keptTriangles(const std::vector<shared::vec3>& positions, const std::vector<glm::uvec3>& triangles,
                            bool mayBeDivided, const std::string& whose) {
    std::vector<std::uint8_t> isFlat(triangles.size());
    std::atomic<bool> mustBeDivided = false;
    parallelChunks(0, isFlat.size(), kChunk, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            interruptionPoint();
            const glm::uvec3& t = triangles[i];
            if (std::max({t.x, t.y, t.z}) >= positions.size())
                throw InputError(whose + ": a triangle refers to vertex " + std::to_string(std::max({t.x, t.y, t.z})) +
                                 " of " + std::to_string(positions.size()));
            isFlat[i] = doubleArea(positions[t.x], positions[t.y], positions[t.z]) == glm::dvec3(0);
            if (mayBeDivided && isHuge(positions[t.x], positions[t.y], positions[t.z])) mustBeDivided = true;
        }
    });
    KeptTriangles kept{{}, mustBeDivided};
    reserveLarge(kept.numbers, triangles.size());
    for (std::uint32_t i = 0; i < triangles.size(); ++i)
        if (!isFlat[i]) kept.numbers.push_back(i);
    return kept;
}

template <class Values>
std::uint32_t firstOf(const Values& authored, std::size_t already) {
    return authored.empty() ? shared::kNone : static_cast<std::uint32_t>(already);
}

// For all that comes, when the first comes: until then what it is made of may need the memory.
template <class T>
void makeRoom(std::vector<T>& array, std::size_t expected) {
    if (array.capacity() == 0 && expected > 0) reserveLarge(array, expected + kPieces);
}

template <class Mesh, class T>
void releaseOf(Mesh&, std::vector<T>& values) {
    release(values);
}
template <class Mesh, class T>
void releaseOf(const Mesh&, const std::vector<T>&) {}

// Huge triangles are few, and are divided in double precision.
const MeshData& inDoubles(const MeshData& mesh) {
    return mesh;
}
MeshData inDoubles(const FloatMeshData& mesh) {
    return mesh.as<double>();
}

} // namespace

// The first use of a vertex: by a triangle of the scene, of a vertex of the mesh as it comes.
struct PrimitiveSink::VertexUse {
    std::uint32_t vertex, triangle;
};

template <class Mesh>
void PrimitiveSink::add(Mesh& data, const MaterialDesc& own, bool light, const Placement& at) {
    if (isExcluded(at.part, !emits(own))) return;
    const Affine map = at.outer * at.local;
    const MaterialDesc& material = at.material ? *at.material : own;
    makeRoomForTriangles();
    const KeptSurface* before = known(&data, map, isInWorld());
    const std::optional<KeptSurface> made =
        before ? takeOver(*before, data, material, light) : surface(data, material, light, map, at.place, isInWorld());
    if (made && memory_ != nullptr) kept_.emplace(&data, *made);
}

// Nothing where it is none that the next compilation could take over.
template <class Mesh>
std::optional<KeptSurface> PrimitiveSink::surface(Mesh& data, const MaterialDesc& material, bool light,
                                                  const Affine& map, const std::string& place, bool mayBeDivided) {
    const std::size_t vertexCount = data.positions.size();
    const auto giveBack = [&] {
        if (vertexCount > kManyVertices) releaseFreedMemory();
    };
    std::vector<shared::vec3> positions = mapped(data.positions, map);
    KeptTriangles kept = keptTriangles(positions, data.triangles, mayBeDivided, out_.id + ": " + place);
    if (kept.mustBeDivided) {
        MeshData divided = divideHugeTriangles(inDoubles(data), map, materials_.mayShowImage(material));
        surface(divided, material, light, map, place, false);
        return std::nullopt;
    }
    KeptSurface made;
    made.map = map;
    made.mayBeDivided = mayBeDivided;
    made.dropped = data.triangles.size() - kept.numbers.size();
    dropped_.triangles += made.dropped;
    if (kept.numbers.empty()) return std::nullopt;
    releaseOf(data, data.positions);
    const WoundTriangles triangles{data.triangles, map.mirrors()};
    orderAlongCurve(positions, triangles, kept.numbers);
    giveBack();

    shared::Mesh mesh = meshRecord(data, material, kept.numbers.size(), light);
    const std::vector<VertexUse> uses = appendTriangles(mesh, positions, triangles, kept.numbers);
    release(kept.numbers);
    releaseOf(data, data.triangles);
    giveBack();
    makeRoom(out_.positions, expected_.positions);
    for (const VertexUse& use : uses) {
        out_.positions.push_back(positions[use.vertex]);
        made.bounds.add(out_.positions.back());
    }
    release(positions);
    giveBack();
    appendAttributes(mesh, data, map, uses);
    made.vertexCount = static_cast<std::uint32_t>(uses.size());
    finishMesh(mesh, made);
    return made;
}

void PrimitiveSink::finishMesh(const shared::Mesh& mesh, KeptSurface& made) {
    bounds_.add(made.bounds.lower);
    bounds_.add(made.bounds.upper);
    made.mesh = static_cast<std::uint32_t>(out_.meshes.size());
    out_.meshes.push_back(mesh);
}

void PrimitiveSink::makeRoomForTriangles() {
    makeRoom(out_.triangles, expected_.triangles);
    makeRoom(out_.triangleMesh, expected_.triangles);
}

// As the compilation before has it; null: it does not.
const KeptSurface* PrimitiveSink::known(const void* mesh, const Affine& map, bool mayBeDivided) const {
    if (memory_ == nullptr || !memory_->scene) return nullptr;
    const auto [begin, end] = memory_->surfaces.equal_range(mesh);
    const auto found = std::find_if(begin, end, [&](const auto& entry) {
        // Bit by bit: -0 is not 0.
        return entry.second.mayBeDivided == mayBeDivided && std::memcmp(&entry.second.map, &map, sizeof map) == 0;
    });
    return found == end ? nullptr : &found->second;
}

// What depends on the material alone is made anew: the record, and lights.
template <class Real>
KeptSurface PrimitiveSink::takeOver(KeptSurface surface, const MeshOf<Real>& data, const MaterialDesc& material,
                                    bool light) {
    const CompiledScene& before = *memory_->scene;
    const shared::Mesh& was = before.meshes[surface.mesh];
    shared::Mesh mesh = meshRecord(data, material, was.triangleCount, light);
    dropped_.triangles += surface.dropped;
    const auto append = [](auto& to, const auto& from, std::uint32_t first, std::uint32_t count, std::size_t all) {
        interruptionPoint();
        if (first != shared::kNone) makeRoom(to, all);
        if (first != shared::kNone) to.insert(to.end(), from.begin() + first, from.begin() + first + count);
    };
    append(out_.positions, before.positions, was.firstVertex, surface.vertexCount, expected_.positions);
    append(out_.normals, before.normals, was.firstNormal, surface.vertexCount, expected_.normals);
    append(out_.uvs, before.uvs, was.firstUv, surface.vertexCount, expected_.uvs);
    if (was.firstUv2 != shared::kNone) mesh.firstUv2 = static_cast<std::uint32_t>(out_.uvs.size());
    append(out_.uvs, before.uvs, was.firstUv2, surface.vertexCount, expected_.uvs);
    append(out_.colors, before.colors, was.firstColor, surface.vertexCount, expected_.colors);
    append(out_.tangents, before.tangents, was.firstTangent, surface.vertexCount, expected_.tangents);

    append(out_.triangles, before.triangles, was.firstTriangle, was.triangleCount, 0);
    const shared::uvec3 shift(mesh.firstVertex - was.firstVertex); // modulo 2^32
    for (std::size_t i = mesh.firstTriangle; i < out_.triangles.size(); ++i) out_.triangles[i] += shift;
    out_.triangleMesh.resize(out_.triangles.size(), static_cast<std::uint32_t>(out_.meshes.size()));
    if (mesh.firstLight != shared::kNone)
        for (std::size_t i = mesh.firstTriangle; i < out_.triangles.size(); ++i) {
            interruptionPoint();
            const shared::uvec3 t = out_.triangles[i];
            appendTriangleLight(i, out_.positions[t.x], out_.positions[t.y], out_.positions[t.z], mesh.material);
        }
    finishMesh(mesh, surface);
    return surface;
}

void PrimitiveSink::appendTriangleLight(std::size_t triangle, const shared::vec3& a, const shared::vec3& b,
                                        const shared::vec3& c, std::uint32_t material) {
    shared::Light record = triangleLight(a, b, c);
    record.triangle = static_cast<std::uint32_t>(triangle);
    appendLight(record, material);
}

template <class Real>
shared::Mesh PrimitiveSink::meshRecord(const MeshOf<Real>& data, const MaterialDesc& material,
                                       std::size_t triangleCount, bool light) const {
    shared::Mesh mesh{};
    mesh.material = materials_.index(material);
    mesh.firstTriangle = static_cast<std::uint32_t>(out_.triangles.size());
    mesh.triangleCount = static_cast<std::uint32_t>(triangleCount);
    mesh.firstVertex = static_cast<std::uint32_t>(out_.positions.size());
    mesh.firstNormal = firstOf(data.normals, out_.normals.size());
    mesh.firstUv = firstOf(data.uvs, out_.uvs.size());
    mesh.firstUv2 = firstOf(data.uvs2, 0); // known when the first set is complete
    mesh.firstColor = firstOf(data.colors, out_.colors.size());
    mesh.firstTangent = firstOf(data.tangents, out_.tangents.size());
    mesh.firstLight = isLight(mesh.material, light) ? static_cast<std::uint32_t>(out_.lights.size()) : shared::kNone;
    return mesh;
}

// Vertices in the order of their first use: neighbours in space become neighbours in memory, unused ones vanish.
std::vector<PrimitiveSink::VertexUse> PrimitiveSink::appendTriangles(const shared::Mesh& mesh,
                                                                     const std::vector<shared::vec3>& positions,
                                                                     const WoundTriangles& triangles,
                                                                     const std::vector<std::uint32_t>& order) {
    std::vector<VertexUse> uses;
    reserveLarge(uses, positions.size());
    std::vector<std::uint32_t> renamed;
    resizeLarge(renamed, positions.size(), shared::kNone);
    for (const std::uint32_t i : order) {
        interruptionPoint();
        const glm::uvec3 t = triangles[i];
        for (int corner = 0; corner < 3; ++corner) {
            std::uint32_t& name = renamed[t[corner]];
            if (name != shared::kNone) continue;
            name = mesh.firstVertex + static_cast<std::uint32_t>(uses.size());
            uses.push_back({t[corner], static_cast<std::uint32_t>(out_.triangles.size())});
        }
        out_.triangles.emplace_back(renamed[t.x], renamed[t.y], renamed[t.z]);
        out_.triangleMesh.push_back(static_cast<std::uint32_t>(out_.meshes.size()));
        if (mesh.firstLight != shared::kNone)
            appendTriangleLight(out_.triangles.size() - 1, positions[t.x], positions[t.y], positions[t.z],
                                mesh.material);
    }
    return uses;
}

template <class Mesh>
void PrimitiveSink::appendAttributes(shared::Mesh& mesh, Mesh& data, const Affine& map,
                                     const std::vector<VertexUse>& uses) {
    const auto append = [&](auto& to, auto& from, std::size_t expected, const auto& converted) {
        if (from.empty()) return;
        makeRoom(to, expected);
        const std::size_t first = to.size();
        to.resize(first + uses.size());
        parallelChunks(0, uses.size(), kChunk, [&](std::size_t begin, std::size_t end) {
            interruptionPoint();
            for (std::size_t i = begin; i < end; ++i) to[first + i] = converted(from[uses[i].vertex], uses[i].triangle);
        });
        releaseOf(data, from);
    };
    const auto uvOf = [](const glm::dvec2& uv, std::uint32_t) { return shared::vec2(uv); };
    append(out_.uvs, data.uvs, expected_.uvs, uvOf);
    if (!data.uvs2.empty()) mesh.firstUv2 = static_cast<std::uint32_t>(out_.uvs.size());
    append(out_.uvs, data.uvs2, expected_.uvs, uvOf);
    append(out_.colors, data.colors, expected_.colors,
           [](const glm::dvec4& color, std::uint32_t) { return shared::vec4(color); });
    append(out_.tangents, data.tangents, expected_.tangents,
           [&](const glm::dvec4& t, std::uint32_t) { return tangentOf(t, map); });
    const glm::dmat3 normalMap = data.normals.empty() ? glm::dmat3(1) : glm::transpose(glm::inverse(map.linear));
    append(out_.normals, data.normals, expected_.normals, [&](const glm::dvec3& authored, std::uint32_t triangle) {
        const glm::dvec3 normal = normalMap * authored;
        if (glm::dot(normal, normal) > 0 && representable(normal)) return shared::vec3(glm::normalize(normal));
        const glm::uvec3 t = out_.triangles[triangle];
        return shared::vec3(glm::normalize(doubleArea(out_.positions[t.x], out_.positions[t.y], out_.positions[t.z])));
    });
}

template void PrimitiveSink::add(const MeshData&, const MaterialDesc&, bool, const Placement&);
template void PrimitiveSink::add(const FloatMeshData&, const MaterialDesc&, bool, const Placement&);
template void PrimitiveSink::add(MeshData&, const MaterialDesc&, bool, const Placement&);
template void PrimitiveSink::add(FloatMeshData&, const MaterialDesc&, bool, const Placement&);

} // namespace rt::scene
