// Turns authored objects into primitives of the compiled scene: transforms in double, one rounding to float, nothing
// degenerate, lights for what emits.
#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "Common/Scene/Affine.h"
#include "Common/Scene/CompiledScene.h"
#include "Common/Scene/Compiler/Bounds.h"
#include "Common/Scene/Compiler/CompileMemory.h"
#include "Common/Scene/Compiler/MaterialTable.h"
#include "Common/Scene/Compiler/MeshOrder.h"

namespace rt::scene {

// What is shared by all instances of a prototype: static surfaces that do not emit, spheres that are spheres in its
// space. The rest goes to the world for each instance.
enum class Part { All, Shared, Rest };

inline bool isExcluded(Part part, bool isShareable) {
    return part == Part::Shared ? !isShareable : part == Part::Rest && isShareable;
}

// How an object stands in what is being filled.
struct Placement {
    Affine outer;                           // prototype to target space
    Affine local;                           // object to prototype
    Part part = Part::All;                  // emit only these
    const MaterialDesc* material = nullptr; // replaces the object's own unless null
    std::string place;                      // JSON path, for errors
};

// What is no sphere in the world, or one whose texture is turned: the unit sphere under an affine map.
struct Ellipsoid {
    Affine toWorld;
    std::uint32_t material;
    std::uint32_t light; // kNone: it is none
};

struct PrimitiveCounts {
    std::size_t spheres = 0, quads = 0, triangles = 0, rounds = 0;
    std::size_t positions = 0, normals = 0, uvs = 0, colors = 0, tangents = 0; // of meshes
};

class PrimitiveSink {
  public:
    // `memory`: of a compilation before, or null.
    PrimitiveSink(CompiledScene& out, MaterialTable& materials, const CompileMemory* memory = nullptr)
        : out_(out), materials_(materials), memory_(memory) {}

    // What comes, for which there is to be room: arrays that grow are copied again and again.
    void expect(const PrimitiveCounts& counts);

    void add(const SphereDesc& sphere, const Placement& at);
    void add(const SphereSetDesc& spheres, const Placement& at);
    void add(const QuadDesc& quad, const Placement& at);
    void add(const BoxDesc& box, const Placement& at);
    void add(const DiskDesc& disk, const Placement& at);
    void add(const CylinderDesc& cylinder, const Placement& at);
    // One surface of a mesh, a MeshData or FloatMeshData, with one material. One that is not const is given back piece
    // by piece, where there is no memory of a compilation before.
    template <class Mesh>
    void add(Mesh& mesh, const MaterialDesc& material, bool light, const Placement& at);

    void add(const PointLightDesc& light, const Placement& at);
    void add(const SpotLightDesc& light, const Placement& at);
    void add(const DirectionalLightDesc& light, const Placement& at);

    // Everything added since the last call as a geometry, with its bounds. The world, the first one, may have lights.
    Bounds finishGeometry();

    const std::vector<Ellipsoid>& ellipsoids() const { return ellipsoids_; }
    // For the next compilation; once.
    std::multimap<const void*, KeptSurface> takeSurfaces() { return std::move(kept_); }
    // One line for each kind of thing that was dropped or is doubtful.
    void appendNotices(std::vector<std::string>& notices) const;

  private:
    struct SphereFrame;
    template <typename Spheres>
    SphereFrame frameOf(const Spheres& object, const Placement& at) const;
    void sphere(const glm::dvec3& center, const glm::dvec3& motion, double radius, const SphereFrame& frame);
    void ellipsoid(Affine toWorld, const SphereFrame& frame);
    void quad(const glm::dvec3& corner, const glm::dvec3& u, const glm::dvec3& v, const MaterialDesc& material,
              bool light, const Affine& map);
    void round(shared::Round record, const MaterialDesc& material, bool light);
    void makeRoomForTriangles();
    template <class Mesh>
    std::optional<KeptSurface> surface(Mesh& data, const MaterialDesc& material, bool light, const Affine& map,
                                       const std::string& place, bool mayBeDivided);
    const KeptSurface* known(const void* mesh, const Affine& map, bool mayBeDivided) const;
    template <class Real>
    KeptSurface takeOver(KeptSurface surface, const MeshOf<Real>& data, const MaterialDesc& material, bool light);
    void finishMesh(const shared::Mesh& mesh, KeptSurface& made);
    void appendTriangleLight(std::size_t triangle, const shared::vec3& a, const shared::vec3& b, const shared::vec3& c,
                             std::uint32_t material);
    struct VertexUse;
    template <class Real>
    shared::Mesh meshRecord(const MeshOf<Real>& data, const MaterialDesc& material, std::size_t triangleCount,
                            bool light) const;
    std::vector<VertexUse> appendTriangles(const shared::Mesh& mesh, const std::vector<shared::vec3>& positions,
                                           const WoundTriangles& triangles, const std::vector<std::uint32_t>& order);
    template <class Mesh>
    void appendAttributes(shared::Mesh& mesh, Mesh& data, const Affine& map, const std::vector<VertexUse>& uses);
    const MaterialDesc& materialOf(const std::string& name, const Placement& at) const;
    bool isInWorld() const { return out_.geometries.empty(); } // what is filled now: the geometry without instances
    bool isLight(std::uint32_t material, bool wanted) const;
    std::uint32_t appendLight(shared::Light light, std::uint32_t material);
    void appendPunctual(const shared::Light& light);

    CompiledScene& out_;
    MaterialTable& materials_;
    const CompileMemory* const memory_;
    std::multimap<const void*, KeptSurface> kept_; // of what is compiled now
    PrimitiveCounts expected_;
    Bounds bounds_;
    std::vector<Ellipsoid> ellipsoids_;
    struct {
        std::uint64_t spheres = 0, quads = 0, triangles = 0, rounds = 0, tinySpheres = 0, lights = 0;
    } dropped_;
    std::uint64_t unsampledEllipsoids_ = 0;
};

} // namespace rt::scene
