// The vertices and faces of an OBJ file.
#pragma once
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "Common/Scene/Obj/ObjTroubles.h"
#include "Common/Scene/Obj/ObjVertices.h"
#include "Common/Scene/SceneDesc.h"

namespace rt::scene {

// A statement as far as its numbers: what stands behind the keyword, and where it is.
struct ObjStatement {
    std::string_view rest, source; // source: the whole line, which outlives the reading
    std::size_t line;
};

// What of one kind a file lists, as faces refer to it.
template <class Value>
struct ObjEntries {
    struct Broken {
        std::uint32_t index;
        std::size_t line;
        std::string_view source;
    };
    std::vector<Value> values;  // not finite: broken
    std::vector<Broken> broken; // by index
};

class ObjGeometry {
  public:
    using Triangles = std::vector<glm::uvec3>; // indices of combinations of indices

    explicit ObjGeometry(ObjTroubles& troubles) : troubles_(troubles) {}

    void addPosition(const ObjStatement& statement, bool withColor);
    void addUv(const ObjStatement& statement);
    void addNormal(const ObjStatement& statement);
    // Faces from here on are of that material, or of that smoothing group; 0: none.
    void useMaterial(std::string_view name) { triangles_ = &parts_[std::string(name)]; }
    void smooth(std::uint32_t group) { group_ = group; }
    // A face may refer to what follows later: it is put off until then.
    void addFace(const ObjStatement& statement);

    void finish(); // once everything has been added, and before what follows
    std::map<std::string, Triangles>& parts() { return parts_; } // by material
    // Triangles as meshes, one for each combination of what their corners have, which of colours is only asked where
    // they count. Those with most come first; none is empty.
    std::vector<MeshData> meshes(const Triangles& triangles, bool withColors);
    bool hasColors(const Triangles& triangles) const; // some of them
    // What became of colours, one line each.
    void appendColorNotices(const std::string& path, std::vector<std::string>& notices) const;

  private:
    static constexpr std::uint32_t kSmoothed = 0x80000000u; // bit of a normal that is computed, index into smooth_

    // As files count: from 1; 0: none.
    struct Corner {
        std::uint32_t position, uv, normal;
    };
    using IndexOfCorner = std::uint32_t Corner::*;
    struct Face {
        std::size_t line;
        Triangles* triangles;
        std::uint32_t group;
        std::size_t firstCorner, cornerCount; // of those put off
    };

    void addColor(std::string_view numbers, const ObjStatement& statement);
    bool readCorners(const ObjStatement& statement);
    bool readCorner(std::string_view word, std::size_t line, Corner& corner);
    void build(const Face& face, const Corner* corners);
    void cut(const Face& face, bool isSmooth);
    template <class Value>
    bool has(const Face& face, const Corner* corners, const ObjEntries<Value>& entries, IndexOfCorner index);
    bool hasPositions(const Face& face, const Corner* corners);
    bool hasColor(std::uint32_t vertex) const;
    unsigned kindOf(const glm::uvec3& triangle, bool withColors) const;
    MeshData meshOf(const Triangles& triangles, unsigned kind);
    glm::dvec3 normalOf(std::uint32_t normal) const;

    ObjTroubles& troubles_;
    ObjEntries<glm::vec3> positions_, normals_;
    ObjEntries<glm::vec2> uvs_;
    std::vector<glm::vec3> colors_;  // encoded, of as many positions as the last that has one; NaN: it has none
    float colorScale_ = 1;           // to [0,1]
    std::size_t colorsBeyond_ = 0;   // [0,1]
    std::size_t partlyColored_ = 0;  // triangles
    bool areColorsBytes_ = true;     // so far each is one that 8 bits can have
    VertexTable vertices_;           // position, texture coordinate, normal; kNone: it has none
    VertexTable smoothed_;           // position and smoothing group of normals that are no entry
    std::vector<glm::dvec3> smooth_; // their sums over the triangles there
    std::map<std::string, Triangles> parts_;
    Triangles* triangles_ = &parts_[""];
    std::uint32_t group_ = 0;
    std::vector<Face> later_;
    std::vector<Corner> laterCorners_;
    // Scratch
    std::vector<Corner> corners_;
    std::vector<std::uint32_t> face_;
    std::vector<glm::dvec3> outline_;
    std::vector<std::uint32_t> renamed_;
};

} // namespace rt::scene
