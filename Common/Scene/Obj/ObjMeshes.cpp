// ObjGeometry: what has been read as meshes.
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include <glm/geometric.hpp>
#include <glm/vec4.hpp>

#include "Common/Scene/Counted.h"
#include "Common/Scene/Obj/ObjGeometry.h"
#include "Common/Shared/Base/Types.h"
#include "Common/Shared/Tonemap.h"

namespace rt::scene {

namespace {
// What the corners of a triangle have; more is a greater number.
constexpr unsigned kHasUvs = 4, kHasNormals = 2, kHasColors = 1, kKinds = 8;
} // namespace

bool ObjGeometry::hasColor(std::uint32_t vertex) const {
    const std::uint32_t position = vertices_.combinations()[vertex].x;
    return position < colors_.size() && std::isfinite(colors_[position].r);
}

bool ObjGeometry::hasColors(const Triangles& triangles) const {
    if (colors_.empty()) return false;
    return std::ranges::any_of(triangles,
                               [&](const glm::uvec3& t) { return hasColor(t.x) || hasColor(t.y) || hasColor(t.z); });
}

unsigned ObjGeometry::kindOf(const glm::uvec3& triangle, bool withColors) const {
    const glm::uvec3& corner = vertices_.combinations()[triangle.x]; // all are alike but in their colours
    const bool isColored = withColors && hasColor(triangle.x) && hasColor(triangle.y) && hasColor(triangle.z);
    return (corner.y != shared::kNone ? kHasUvs : 0) | (corner.z != shared::kNone ? kHasNormals : 0) |
           (isColored ? kHasColors : 0);
}

std::vector<MeshData> ObjGeometry::meshes(const Triangles& triangles, bool withColors) {
    const bool isColored = withColors && !colors_.empty();
    std::array<std::size_t, kKinds> counts{};
    for (const glm::uvec3& t : triangles) {
        const unsigned kind = kindOf(t, isColored);
        ++counts[kind];
        const bool isPlain = (kind & kHasColors) == 0;
        partlyColored_ += isColored && isPlain && (hasColor(t.x) || hasColor(t.y) || hasColor(t.z));
    }
    std::vector<MeshData> meshes;
    for (unsigned kind = kKinds; kind-- > 0;) {
        if (counts[kind] == 0) continue;
        Triangles some; // of this kind; most files have one alone
        if (counts[kind] < triangles.size())
            std::ranges::copy_if(triangles, std::back_inserter(some),
                                 [&](const glm::uvec3& t) { return kindOf(t, isColored) == kind; });
        meshes.push_back(meshOf(some.empty() ? triangles : some, kind));
    }
    return meshes;
}

glm::dvec3 ObjGeometry::normalOf(std::uint32_t normal) const {
    if ((normal & kSmoothed) == 0) return glm::dvec3(normals_.values[normal]);
    const glm::dvec3& sum = smooth_[normal & ~kSmoothed];
    const double length = glm::length(sum);
    return length > 0 ? sum / length : glm::dvec3(0);
}

MeshData ObjGeometry::meshOf(const Triangles& triangles, unsigned kind) {
    MeshData mesh;
    std::vector<std::uint32_t> used;
    mesh.triangles.reserve(triangles.size());
    for (const glm::uvec3& t : triangles) {
        glm::uvec3& renamed = mesh.triangles.emplace_back();
        for (int i = 0; i < 3; ++i) {
            std::uint32_t& name = renamed_[t[i]];
            if (name == shared::kNone) {
                name = static_cast<std::uint32_t>(used.size());
                used.push_back(t[i]);
            }
            renamed[i] = name;
        }
    }
    for (const std::uint32_t index : used) {
        renamed_[index] = shared::kNone; // for the next mesh
        const glm::uvec3& v = vertices_.combinations()[index];
        mesh.positions.emplace_back(positions_.values[v.x]);
        if (kind & kHasUvs) mesh.uvs.emplace_back(uvs_.values[v.y]);
        if (kind & kHasNormals) mesh.normals.push_back(normalOf(v.z));
        if (kind & kHasColors) {
            glm::vec4 color(0, 0, 0, 1);
            for (int c = 0; c < 3; ++c)
                color[c] = shared::srgbDecode(std::clamp(colorScale_ * colors_[v.x][c], 0.0f, 1.0f));
            mesh.colors.emplace_back(color);
        }
    }
    return mesh;
}

void ObjGeometry::appendColorNotices(const std::string& path, std::vector<std::string>& notices) const {
    if (partlyColored_ > 0)
        notices.push_back(path + ": " + counted(partlyColored_, "triangle has a colour", "triangles have colours") +
                          " at some corners only: left out");
    if (areColorsBytes_)
        notices.push_back(path + ": the colours of vertices are whole numbers up to 255, and divided by that");
    else if (colorsBeyond_ > 0)
        notices.push_back(path + ": the " + counted(colorsBeyond_, "colour of a vertex", "colours of vertices") +
                          " beyond [0,1] " + (colorsBeyond_ == 1 ? "is" : "are") + " clamped");
}

} // namespace rt::scene
