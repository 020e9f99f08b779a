#include "Common/Accel/GpuBvh.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <iterator>
#include <span>
#include <string>
#include <utility>

#include "Common/Accel/Build/Collapse.h"
#include "Common/Accel/Build/SceneTrees.h"
#include "Common/Accel/Cuboids.h"
#include "Common/Accel/SameGeometry.h"
#include "Common/Core/Error.h"
#include "Common/Shared/Shape/Rounds.h"
#include "Common/Shared/Shape/Shapes.h"

namespace rt::accel {
namespace {

using shared::vec3, shared::vec4;

static_assert(sizeof(shared::TreeNode) == 64 && sizeof(shared::WideTreeNode) == 128);
static_assert(sizeof(shared::TreeQuad) == 64 && sizeof(shared::TreeTriangle) == 48 && sizeof(shared::TreeRound) == 64);

// ---- primitives ----------------------------------------------------------------------------------------------------

vec4 sphereVector(const AccelInput& input, std::uint32_t index) {
    const shared::Sphere& sphere = input.spheres[index];
    return vec4(sphere.center, sphereKind(input, index) == LeafKind::NearSphere ? -sphere.radius : sphere.radius);
}

vec4 motionVector(const AccelInput& input, std::uint32_t index) {
    return vec4(input.motions.empty() ? vec3(0.0f) : input.motions[index], 0.0f);
}

shared::TreeQuad quadRecord(const AccelInput& input, std::uint32_t index) {
    const shared::Quad& quad = input.quads[index];
    const shared::QuadFrame frame = shared::quadFrame(quad.edgeU, quad.edgeV);
    return {vec4(quad.corner, 0.0f), vec4(frame.normal, std::bit_cast<float>(index)), vec4(frame.dualU, frame.margin.x),
            vec4(frame.dualV, frame.margin.y)};
}

shared::TreeTriangle triangleRecord(const AccelInput& input, std::uint32_t index) {
    const shared::uvec3 v = input.triangles[index];
    return {vec4(input.positions[v.x], std::bit_cast<float>(index)), vec4(input.positions[v.y], 0.0f),
            vec4(input.positions[v.z], 0.0f)};
}

shared::TreeRound roundRecord(const AccelInput& input, std::uint32_t index) {
    const shared::Round& round = input.rounds[index];
    const shared::RoundFrame frame = shared::roundFrame(round.edgeU, round.edgeV, round.axis);
    return {vec4(round.origin, round.hole), vec4(frame.dualU, std::bit_cast<float>(index)), vec4(frame.dualV, 0.0f),
            vec4(frame.dualW, 0.0f)};
}

// ---- lists ---------------------------------------------------------------------------------------------------------

// The axis that a quad whose edges run along axes is perpendicular to.
std::optional<int> perpendicularAxis(const shared::Quad& quad) {
    const auto isAlong = [](vec3 edge, int axis) { return edge[(axis + 1) % 3] == 0 && edge[(axis + 2) % 3] == 0; };
    for (int axis = 0; axis < 3; ++axis) {
        const int first = (axis + 1) % 3, second = (axis + 2) % 3;
        if ((isAlong(quad.edgeU, first) && isAlong(quad.edgeV, second)) ||
            (isAlong(quad.edgeU, second) && isAlong(quad.edgeV, first)))
            return axis;
    }
    return {};
}

// Of a rectangle along an axis: the middle, rounded, and how far its sides and their errors may be from that.
vec4 halfExtent(const shared::Quad& quad, vec3 center, int axis) {
    vec4 half(0.0f);
    for (int i = 0; i < 2; ++i) {
        const int along = (axis + 1 + i) % 3;
        const double begin = quad.corner[along];
        const double end = begin + double{quad.edgeU[along]} + double{quad.edgeV[along]};
        const double reach = std::max(std::abs(begin - center[along]), std::abs(end - center[along]));
        half[i] = static_cast<float>(reach + double{shared::kQuadError} * std::abs(end - begin));
    }
    return half;
}

// Of three faces, each in a byte.
float packFaces(const std::uint32_t* faces) {
    std::uint32_t packed = 0;
    for (int i = 0; i < 3; ++i) packed |= (faces[i] == shared::kNone ? shared::kNoFace : faces[i]) << (8 * i);
    return std::bit_cast<float>(packed);
}

std::array<vec4, 4> cuboidVectors(const Cuboid& cuboid) {
    const std::array<vec3, 3>& edges = cuboid.edges;
    const vec3 center = cuboid.corner + 0.5f * (edges[0] + edges[1] + edges[2]);
    const auto row = [&](int i) { return edges[i] * (2 / shared::dot(edges[i], edges[i])); };
    return {vec4(center, packFaces(&cuboid.faces[0])), vec4(row(0), packFaces(&cuboid.faces[3])), vec4(row(1), 0.0f),
            vec4(row(2), 0.0f)};
}

void addSphere(LinearLists& lists, const AccelInput& input, std::uint32_t index) {
    const vec4 sphere = sphereVector(input, index);
    lists.vectors.push_back(sphere);
    lists.vectors.emplace_back(vec3(motionVector(input, index)), std::bit_cast<float>(index));
    ++(sphere.w < 0 ? lists.nearSpheres : lists.spheres);
}

LinearLists makeLists(const AccelInput& input, const shared::Geometry& world) {
    LinearLists lists;
    lists.triangles = world.triangleCount;
    lists.rounds = world.roundCount;
    const auto add = [&](std::initializer_list<vec4> vectors) {
        lists.vectors.insert(lists.vectors.end(), vectors.begin(), vectors.end());
    };
    for (const bool areNear : {true, false})
        for (std::uint32_t i = world.firstSphere; i < world.firstSphere + world.sphereCount; ++i)
            if ((sphereKind(input, i) == LeafKind::NearSphere) == areNear) addSphere(lists, input, i);
    std::vector<std::uint32_t> slanted; // quads
    for (std::uint32_t i = world.firstQuad; i < world.firstQuad + world.quadCount; ++i) {
        if (!perpendicularAxis(input.quads[i])) slanted.push_back(i);
    }
    for (int axis = 0; axis < 3; ++axis) {
        for (std::uint32_t i = world.firstQuad; i < world.firstQuad + world.quadCount; ++i) {
            if (perpendicularAxis(input.quads[i]) != axis) continue;
            const shared::Quad& quad = input.quads[i];
            const vec3 center = quad.corner + 0.5f * (quad.edgeU + quad.edgeV);
            add({vec4(center, std::bit_cast<float>(i)), halfExtent(quad, center, axis)});
            ++lists.axisQuads[axis];
        }
    }
    std::vector<Cuboid> cuboids;
    if (world.firstQuad + world.quadCount <= shared::kNoFace) cuboids = findCuboids(input.quads, slanted);
    for (const Cuboid& cuboid : cuboids) {
        const std::array<vec4, 4> v = cuboidVectors(cuboid);
        add({v[0], v[1], v[2], v[3]});
        ++lists.cuboids;
    }
    for (const std::uint32_t i : slanted) {
        const shared::TreeQuad quad = quadRecord(input, i);
        add({quad.corner, quad.normal, quad.dualU, quad.dualV});
        ++lists.quads;
    }
    for (std::uint32_t i = 0; i < world.triangleCount; ++i) {
        const shared::TreeTriangle triangle = triangleRecord(input, world.firstTriangle + i);
        add({triangle.vertex0, triangle.vertex1, triangle.vertex2});
    }
    for (std::uint32_t i = 0; i < world.roundCount; ++i) {
        const shared::TreeRound round = roundRecord(input, world.firstRound + i);
        add({round.origin, round.dualU, round.dualV, round.dualW});
    }
    return lists;
}

// ---- trees ---------------------------------------------------------------------------------------------------------

// Among triangles nodes of four children take an H100 0.84 times as long as nodes of two (a statue of a million of
// them), and 0.96 times in a scene of as many spheres and quads; among spheres 1.03 to 1.14 times.
bool prefersWideNodes(const AccelInput& input) {
    return input.triangles.size() > input.spheres.size() + input.quads.size();
}

class Flattener {
  public:
    // Behind the trees that are there, if any.
    Flattener(const AccelInput& input, const PlacedTrees* there) : input_(input) {
        PlacedTrees& placed = trees_.placed;
        if (there != nullptr) {
            placed = *there;
        } else {
            placed.isWide = prefersWideNodes(input);
            placed.roots.resize(input.geometries.size(), 0);
            placed.depths.resize(input.geometries.size(), 0);
        }
        base_ = placed.counts;
        roots_ = placed.roots;
        depths_ = placed.depths;
    }

    void add(const SceneTree& tree);
    void finishPlaced(std::vector<Box> boxes); // of all that was added, the world being next
    const PlacedTrees& placed() const { return trees_.placed; }
    GpuBvh finish();

  private:
    bool isForList(const SceneTree& tree, const BvhNode& leaf) const;
    std::uint32_t addLeaf(const SceneTree& tree, const BvhNode& leaf);
    template <class Node, class Children>
    void addNodes(const SceneTree& tree, std::vector<Node>& nodes, const Children& childrenOf);
    std::uint32_t depthBelow(const SceneTree& tree, const BvhNode& leaf) const;

    const AccelInput& input_;
    GpuTrees trees_;
    LinearLists lists_;                 // of what is in no leaf
    TreeCounts base_;                   // of what is there already
    std::vector<std::uint32_t> roots_;  // of each geometry
    std::vector<std::uint32_t> depths_; // of each geometry: references that a traversal of it has to remember
};

void checkRoom(std::size_t items) {
    if (items > shared::kTreeItems) {
        throw RenderError("the scene has more primitives of a kind than the compute engine's tree can hold (" +
                          std::to_string(shared::kTreeItems) + ")");
    }
}

// Whether a leaf that is not alone has near spheres of the world whose box most rays enter, a ground say. Their test
// takes long: all lanes make it together, and first.
bool Flattener::isForList(const SceneTree& tree, const BvhNode& leaf) const {
    constexpr std::uint32_t kMaxListed = 4;
    return tree.geometry == 0 && tree.items.kind(tree.bvh.items[leaf.first]) == LeafKind::NearSphere &&
           leaf.box.halfArea() > 0.5f * tree.bvh.nodes[0].box.halfArea() &&
           lists_.nearSpheres + leaf.count <= kMaxListed;
}

// A leaf's primitives become neighbours in the array of their kind.
std::uint32_t Flattener::addLeaf(const SceneTree& tree, const BvhNode& leaf) {
    const std::span<const std::uint32_t> items = std::span(tree.bvh.items).subspan(leaf.first, leaf.count);
    const auto append = [&](std::uint32_t kind, std::size_t base, auto& array, const auto& make) {
        const std::size_t first = base + array.size();
        for (const std::uint32_t item : items) array.push_back(make(input_, tree.items.index(item)));
        checkRoom(base + array.size());
        return shared::treeLeaf(kind, static_cast<std::uint32_t>(first), leaf.count);
    };
    switch (tree.items.kind(items[0])) {
        case LeafKind::Quad:
            return append(shared::kQuad, base_.quads, trees_.quads, quadRecord);
        case LeafKind::Triangle:
            return append(shared::kTriangle, base_.triangles, trees_.triangles, triangleRecord);
        case LeafKind::Round: {
            const std::uint32_t all = append(shared::kRound, base_.rounds, trees_.rounds, roundRecord);
            return shared::roundLeaf(shared::treeLeafFirst(all), leaf.count);
        }
        case LeafKind::Instance:
            return shared::treeLeaf(shared::kInstanceLeaf, tree.items.index(items[0]), 1);
        case LeafKind::Sphere:
        case LeafKind::NearSphere:
        case LeafKind::MovingSphere:
            break;
    }
    if (!input_.motions.empty()) append(shared::kSphere, base_.spheres, trees_.sphereMotions, motionVector);
    append(shared::kSphere, base_.spheres, trees_.sphereIndices,
           [](const AccelInput&, std::uint32_t index) { return index; });
    return append(shared::kSphere, base_.spheres, trees_.spheres, sphereVector);
}

// The middle, rounded, and how far a box reaches from that, with what the shaders' test loses of it. No ray enters an
// empty box.
void setSlab(float lower, float upper, float& middle, float& half) {
    if (lower > upper) {
        middle = 0.0f;
        half = -shared::kInfinity;
        return;
    }
    middle = static_cast<float>(0.5 * (double{lower} + upper));
    const double reach = std::max(double{upper} - middle, middle - double{lower});
    const double needed = reach * (1 + double{shared::kHalfExtentError});
    half = static_cast<float>(needed);
    if (half < needed) half = std::nextafter(half, shared::kInfinity);
}

void setBounds(shared::TreeNode& node, int child, const Box& box) {
    vec4* const axes[3] = {&node.x, &node.y, &node.z};
    for (int a = 0; a < 3; ++a) {
        setSlab(box.lower[a], box.upper[a], (*axes[a])[2 * child], (*axes[a])[2 * child + 1]);
    }
}

void setBounds(shared::WideTreeNode& node, int child, const Box& box) {
    vec4* const middle[3] = {&node.middleX, &node.middleY, &node.middleZ};
    vec4* const half[3] = {&node.halfX, &node.halfY, &node.halfZ};
    for (int a = 0; a < 3; ++a) setSlab(box.lower[a], box.upper[a], (*middle[a])[child], (*half[a])[child]);
}

// References that a traversal has to remember below a leaf: where it came from when it enters an instance.
std::uint32_t Flattener::depthBelow(const SceneTree& tree, const BvhNode& leaf) const {
    const std::uint32_t item = tree.bvh.items[leaf.first];
    if (tree.items.kind(item) != LeafKind::Instance) return 0;
    return 1 + depths_[input_.instances[tree.items.index(item)].geometry];
}

// Of a tree whose root is no leaf; childrenOf(node of the binary tree): which of its descendants become children.
// Depth first, so that what is visited together lies together. A traversal remembers all children but one of every node
// on its way down.
template <class Node, class Children>
void Flattener::addNodes(const SceneTree& tree, std::vector<Node>& nodes, const Children& childrenOf) {
    const std::vector<BvhNode>& binary = tree.bvh.nodes;
    std::uint32_t& depth = depths_[tree.geometry];
    roots_[tree.geometry] = static_cast<std::uint32_t>(base_.nodes + nodes.size());
    struct Open {
        std::uint32_t binary, parent;
        int child;
        std::uint32_t above; // references that are remembered
    };
    std::vector<Open> open{{0, 0, 0, 0}};
    while (!open.empty()) {
        const Open next = open.back();
        open.pop_back();
        const BvhNode& node = binary[next.binary];
        if (node.isLeaf() && next.binary != 0 && isForList(tree, node)) {
            for (std::uint32_t i = node.first; i < node.first + node.count; ++i)
                addSphere(lists_, input_, tree.items.index(tree.bvh.items[i]));
            setBounds(nodes[next.parent - base_.nodes], next.child, Box{});
            continue;
        }
        const auto index = static_cast<std::uint32_t>(base_.nodes + nodes.size());
        const std::uint32_t reference = node.isLeaf() ? addLeaf(tree, node) : index;
        if (next.binary != 0) nodes[next.parent - base_.nodes].children[next.child] = reference;
        if (node.isLeaf()) {
            depth = std::max(depth, next.above + depthBelow(tree, node));
            continue;
        }
        const auto children = childrenOf(next.binary);
        Node record{};
        record.children = shared::uvec4(shared::kTreeNothing);
        for (std::size_t i = std::size(children.node); i-- > 0;) {
            const int child = static_cast<int>(i);
            setBounds(record, child, i < children.count ? binary[children.node[i]].box : Box{});
            if (i < children.count) open.push_back({children.node[i], index, child, next.above + children.count - 1});
        }
        nodes.push_back(record);
    }
}

void Flattener::add(const SceneTree& tree) {
    const std::vector<BvhNode>& nodes = tree.bvh.nodes;
    if (nodes[0].isLeaf()) {
        roots_[tree.geometry] = addLeaf(tree, nodes[0]);
        depths_[tree.geometry] = depthBelow(tree, nodes[0]);
    } else if (trees_.placed.isWide) {
        const Collapse<4> collapse(tree.bvh, 0.0f, [&](std::uint32_t node) { return nodes[node].isLeaf(); });
        addNodes(tree, trees_.wideNodes, [&](std::uint32_t node) { return collapse.children(node); });
    } else {
        using Children = Collapse<2>::Children;
        const auto pair = [&](std::uint32_t node) { return Children{{nodes[node].first, nodes[node].first + 1}, 2}; };
        addNodes(tree, trees_.nodes, pair);
    }
}

void Flattener::finishPlaced(std::vector<Box> boxes) {
    PlacedTrees& placed = trees_.placed;
    placed.counts = {trees_.nodes.size() + trees_.wideNodes.size(), trees_.spheres.size(), trees_.quads.size(),
                     trees_.triangles.size(), trees_.rounds.size()};
    placed.roots = roots_;
    placed.depths = depths_;
    placed.boxes = std::move(boxes);
}

GpuBvh Flattener::finish() {
    checkRoom(input_.instances.size());
    for (const shared::Instance& instance : input_.instances) trees_.instanceRoots.push_back(roots_[instance.geometry]);
    trees_.root = roots_[0];
    trees_.depth = depths_[0];
    return {false, std::move(lists_), std::move(trees_)};
}

} // namespace

GpuBvhSettings::GpuBvhSettings() : maxLinear(48) {
    tree.blockSize = 1;
    tree.maxLeafSize = 4;
    tree.nodeCost = 1.0f;
}

std::optional<GpuBvh> buildGpuBvh(const AccelInput& input, const GpuBvhSettings& settings,
                                  const std::atomic<bool>* cancel, const PlacedTrees* placed) {
    GpuBvh bvh;
    const shared::Geometry& world = input.geometries[0];
    const std::uint64_t primitives =
        std::uint64_t{world.sphereCount} + world.quadCount + world.triangleCount + world.roundCount;
    const std::uint32_t maximum = std::min(settings.maxLinear, shared::kMaxListedPrimitives);
    bvh.isLinear = input.instances.empty() && primitives <= maximum;
    if (bvh.isLinear) {
        bvh.lists = makeLists(input, world);
        return bvh;
    }
    BvhSettings tree = settings.tree;
    tree.maxLeafSize =
        std::min(tree.maxLeafSize, input.rounds.empty() ? shared::kTreeLeafSize : shared::kMaxRoundsOfLeaf);
    Flattener flattener(input, placed);
    bool hasWorld = false;
    const auto add = [&](const SceneTree& built) {
        flattener.add(built);
        hasWorld = hasWorld || built.geometry == 0;
    };
    if (placed == nullptr) {
        std::optional<std::vector<Box>> boxes = buildPlacedTrees(input, tree, cancel, nullptr, add);
        if (!boxes) return std::nullopt;
        flattener.finishPlaced(std::move(*boxes));
    }
    if (!buildWorldTree(input, flattener.placed().boxes, tree, cancel, nullptr, add)) return std::nullopt;
    bvh = flattener.finish();
    bvh.isLinear = !hasWorld; // instances may all be of empty geometries
    return bvh;
}

bool canKeep(const PlacedTrees& placed, const AccelInput& before, const AccelInput& now) {
    return !now.instances.empty() && placed.roots.size() == now.geometries.size() &&
           placed.isWide == prefersWideNodes(now) && samePlacedGeometries(before, now);
}

} // namespace rt::accel
