#include "Common/Scene/Builtin/SurfaceNet.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include <glm/geometric.hpp>

#include "Common/Core/Interruption.h"

namespace rt::scene {

namespace {

constexpr std::uint32_t kNoVertex = 0xffffffffu;
constexpr int kBlock = 4; // samples along an edge of what is skipped together

// Goes through the grid slice by slice (constant y) and keeps the two latest of samples and of vertices.
class Net {
  public:
    Net(const std::function<double(const glm::dvec3&)>& field, const glm::dvec3& lower, const glm::dvec3& upper,
        double cell)
        : field_(field),
          lower_(lower),
          cell_(cell),
          count_(glm::ceil((upper - lower) / cell) + 1.0),
          blocksZ_((count_.z + kBlock - 1) / kBlock) {}

    MeshData build() {
        const auto area = static_cast<std::size_t>(count_.x) * static_cast<std::size_t>(count_.z);
        for (auto& slice : samples_) slice.resize(area);
        for (auto& slice : vertices_) slice.assign(area, kNoVertex);
        for (int y = 0; y < count_.y; ++y) {
            interruptionPoint();
            if (y % kBlock == 0) chooseBlocks(y);
            sampleSlice(y);
            if (y > 0) {
                placeVertices(y - 1);
                connect(y - 1);
            }
        }
        addNormals();
        return std::move(mesh_);
    }

  private:
    std::size_t at(int x, int z) const { return static_cast<std::size_t>(x) * static_cast<std::size_t>(count_.z) + z; }
    std::size_t blockAt(int x, int z) const { return static_cast<std::size_t>(x * blocksZ_ + z); }
    double sample(int x, int y, int z) const { return samples_[y & 1][at(x, z)]; }
    std::uint32_t vertex(int x, int y, int z) const { return vertices_[y & 1][at(x, z)]; }
    glm::dvec3 point(double x, double y, double z) const { return lower_ + cell_ * glm::dvec3(x, y, z); }

    // The blocks of the layer from y on near the surface. Samples on the faces between blocks belong to the upper one,
    // so a block reaches one cube below.
    void chooseBlocks(int y) {
        const double reach = 1.25 * cell_ * 0.5 * (kBlock + 2) * std::sqrt(3.0);
        const int blocksX = (count_.x + kBlock - 1) / kBlock;
        const std::vector<Block> below = std::move(blocks_);
        blocks_.resize(static_cast<std::size_t>(blocksX) * static_cast<std::size_t>(blocksZ_));
        for (std::size_t i = 0; i < blocks_.size(); ++i) {
            const int x = static_cast<int>(i) / blocksZ_ * kBlock, z = static_cast<int>(i) % blocksZ_ * kBlock;
            const double half = 0.5 * (kBlock - 1);
            const double value = field_(point(x + half, y + half, z + half));
            const bool isNear = std::abs(value) < reach;
            blocks_[i] = {value, isNear, isNear || (!below.empty() && below[i].isNear)};
        }
        // Cubes reach from their block into the next.
        for (int x = 0; x < blocksX; ++x)
            for (int z = 0; z < blocksZ_; ++z) {
                Block& block = blocks_[blockAt(x, z)];
                if (z + 1 < blocksZ_) block.isCrossed |= blocks_[blockAt(x, z + 1)].isCrossed;
                if (x + 1 < blocksX) block.isCrossed |= blocks_[blockAt(x + 1, z)].isCrossed;
                if (x + 1 < blocksX && z + 1 < blocksZ_) block.isCrossed |= blocks_[blockAt(x + 1, z + 1)].isCrossed;
            }
    }

    // Calls visit(x, z) for the columns of cubes from `first` on that the surface may cross, in order.
    template <class Visit>
    void forCrossed(int first, const Visit& visit) const {
        for (int x = first; x + 1 < count_.x; ++x)
            for (int z = first; z + 1 < count_.z; ++z) {
                if (blocks_[blockAt(x / kBlock, z / kBlock)].isCrossed)
                    visit(x, z);
                else
                    z |= kBlock - 1; // to the block's end
            }
    }

    // Away from the surface the block's value suffices, whose sign is that of all its samples.
    void sampleSlice(int y) {
        std::vector<double>& slice = samples_[y & 1];
        const bool isThere = y % kBlock > 1; // from two slices before
        for (int x = 0; x < count_.x; ++x)
            for (int z = 0; z < count_.z; ++z) {
                const Block& block = blocks_[blockAt(x / kBlock, z / kBlock)];
                if (block.isNear)
                    slice[at(x, z)] = field_(point(x, y, z));
                else if (!isThere)
                    slice[at(x, z)] = block.value;
            }
    }

    void placeVertices(int y) {
        std::fill(vertices_[y & 1].begin(), vertices_[y & 1].end(), kNoVertex);
        forCrossed(0, [&](int x, int z) {
            std::array<double, 8> corner; // bit 0: x, bit 1: y, bit 2: z
            int inside = 0;
            for (int c = 0; c < 8; ++c) {
                corner[static_cast<std::size_t>(c)] = sample(x + (c & 1), y + (c >> 1 & 1), z + (c >> 2));
                inside += corner[static_cast<std::size_t>(c)] < 0;
            }
            if (inside == 0 || inside == 8) return;
            vertices_[y & 1][at(x, z)] = static_cast<std::uint32_t>(mesh_.positions.size());
            const glm::dvec3 offset = meanCrossing(corner);
            mesh_.positions.push_back(point(x + offset.x, y + offset.y, z + offset.z));
        });
    }

    static glm::dvec3 meanCrossing(const std::array<double, 8>& corner) {
        glm::dvec3 sum(0);
        int crossings = 0;
        for (int a = 0; a < 8; ++a)
            for (int axis = 0; axis < 3; ++axis) {
                const int b = a | 1 << axis;
                const double from = corner[static_cast<std::size_t>(a)], to = corner[static_cast<std::size_t>(b)];
                if (a == b || (from < 0) == (to < 0)) continue;
                glm::dvec3 p(a & 1, a >> 1 & 1, a >> 2);
                p[axis] = from / (from - to);
                sum += p;
                ++crossings;
            }
        return sum / double(crossings);
    }

    // Two triangles for each edge that the surface crosses, through the vertices of the four cubes around it: the
    // upright edges of the layer of cubes from y on, the level ones of its lower face.
    void connect(int y) {
        forCrossed(1, [&](int x, int z) {
            const bool isInside = sample(x, y, z) < 0;
            if (isInside != (sample(x, y + 1, z) < 0))
                addQuad({vertex(x, y, z), vertex(x, y, z - 1), vertex(x - 1, y, z - 1), vertex(x - 1, y, z)}, isInside);
            if (y == 0) return;
            if (isInside != (sample(x + 1, y, z) < 0))
                addQuad({vertex(x, y, z), vertex(x, y - 1, z), vertex(x, y - 1, z - 1), vertex(x, y, z - 1)}, isInside);
            if (isInside != (sample(x, y, z + 1) < 0))
                addQuad({vertex(x, y, z), vertex(x - 1, y, z), vertex(x - 1, y - 1, z), vertex(x, y - 1, z)}, isInside);
        });
    }

    // Cut along the shorter diagonal; `isForward`: as listed, counter-clockwise from the outside.
    void addQuad(std::array<std::uint32_t, 4> q, bool isForward) {
        if (!isForward) std::swap(q[1], q[3]);
        const auto length = [&](std::size_t a, std::size_t b) {
            return glm::length(mesh_.positions[q[a]] - mesh_.positions[q[b]]);
        };
        if (length(0, 2) > length(1, 3)) q = {q[1], q[2], q[3], q[0]};
        mesh_.triangles.emplace_back(q[0], q[1], q[2]);
        mesh_.triangles.emplace_back(q[0], q[2], q[3]);
    }

    // Means of the faces' normals, weighted by area.
    void addNormals() {
        mesh_.normals.assign(mesh_.positions.size(), glm::dvec3(0));
        for (const glm::uvec3& t : mesh_.triangles) {
            const glm::dvec3 a = mesh_.positions[t.x], b = mesh_.positions[t.y], c = mesh_.positions[t.z];
            const glm::dvec3 normal = glm::cross(b - a, c - a);
            for (int i = 0; i < 3; ++i) mesh_.normals[t[i]] += normal;
        }
        for (glm::dvec3& normal : mesh_.normals) normal = glm::normalize(normal);
    }

    struct Block {
        double value; // at its middle
        bool isNear;
        bool isCrossed; // the surface may cross cubes that begin in it or below it
    };

    const std::function<double(const glm::dvec3&)>& field_;
    const glm::dvec3 lower_;
    const double cell_;
    const glm::ivec3 count_; // samples along each axis
    std::array<std::vector<double>, 2> samples_;
    std::array<std::vector<std::uint32_t>, 2> vertices_; // of cubes, by their lowest corner
    const int blocksZ_;
    std::vector<Block> blocks_;
    MeshData mesh_;
};

} // namespace

MeshData surfaceNet(const std::function<double(const glm::dvec3&)>& field, const glm::dvec3& lower,
                    const glm::dvec3& upper, double cell) {
    return Net(field, lower, upper, cell).build();
}

} // namespace rt::scene
