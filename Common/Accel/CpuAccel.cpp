#include "Common/Accel/CpuAccel.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "Common/Accel/AccelStorage.h"
#include "Common/Accel/Build/BlockFill.h"
#include "Common/Accel/Build/SceneTrees.h"
#include "Common/Accel/QuantizedBvh.h"
#include "Common/Accel/WideBvh.h"
#include "Common/Core/Parallel.h"
#include "Common/Core/SystemMemory.h"
#include "Common/Shared/Base/Features.h"

namespace rt::accel {
namespace {

constexpr std::size_t kLeafChunk = 1u << 10;      // leaves whose blocks are filled at a time
constexpr std::size_t kLargeBytes = 1u << 20;     // of a tree that traversal fetches ahead
constexpr std::size_t kManyPrimitives = 1u << 16; // beside whose memory it is worth a millisecond to give some back

// One geometry's tree between its construction and the filling of its leaf blocks.
struct BuiltTree {
    TreeItems items;
    LeafFilling filling;
};

template <class Block>
LinearList<Block> fillList(LargeArray<Block>& blocks, const AccelInput& input, std::uint32_t kind, std::uint32_t first,
                           std::uint32_t count) {
    blocks = LargeArray<Block>((count + kWidth - 1) / kWidth);
    for (std::uint32_t i = 0; i < count; ++i) {
        Block& block = blocks[i / kWidth];
        if (i % kWidth == 0) block = emptyBlock<Block>();
        fillLane(block, i % kWidth, input, first + i);
        block.primitive[i % kWidth] = packPrimitive(kind, first + i);
    }
    return {blocks.data(), (count + kWidth - 1) / kWidth};
}

template <class Block>
void fillLeaf(const LargeArray<Block>& blocks, const LeafItems& leaf, const BuiltTree& tree, const AccelInput& input) {
    for (std::uint32_t i = 0; i < leaf.count; ++i) {
        Block& block = blocks[leaf.firstBlock + i / kWidth];
        if (i % kWidth == 0) block = emptyBlock<Block>();
        fillLane(block, i % kWidth, input, tree.items.index(tree.filling.items[leaf.firstItem + i]));
    }
}

class Assembly {
  public:
    Assembly(const AccelInput& input, const BuildSettings& settings, const std::atomic<bool>* cancel,
             std::atomic<std::uint64_t>* primitivesDone)
        : input_(input), settings_(settings), cancel_(cancel), primitivesDone_(primitivesDone) {}

    bool buildTrees(); // false: cancelled
    void fill(AccelStorage& storage);
    bool hasWorld() const { return hasWorld_; } // instances may all be of empty geometries
    Reference root() const { return roots_[0]; }
    const QuantizationGrid& quantizationGrid() const { return quantized_.grid; }

  private:
    void fillLeaves(const BuiltTree& tree, const AccelStorage& storage) const;

    const AccelInput& input_;
    const BuildSettings& settings_;
    const std::atomic<bool>* cancel_;
    std::atomic<std::uint64_t>* primitivesDone_;
    std::vector<WideNode> nodes_;
    QuantizedBvh quantized_; // the world, if it gains from that
    BlockCounts blocks_;
    std::vector<BuiltTree> trees_;
    std::vector<Reference> roots_; // of each geometry
    bool hasWorld_ = false;
};

bool Assembly::buildTrees() {
    roots_.resize(input_.geometries.size());
    return buildSceneTrees(input_, settings_.tree, cancel_, primitivesDone_, [this](SceneTree tree) {
        LeafFilling filling;
        LeafMaker leafMaker(tree.bvh, tree.kinds, blocks_, filling);
        if (input_.instances.empty() && gainsFromQuantization(tree.bvh)) {
            quantized_ = quantize(tree.bvh, leafMaker);
        } else {
            roots_[tree.geometry] = appendWide(tree.bvh, leafMaker, nodes_);
        }
        leafMaker.finish();
        hasWorld_ = hasWorld_ || tree.geometry == 0;
        trees_.push_back({std::move(tree.items), std::move(filling)});
    });
}

void Assembly::fillLeaves(const BuiltTree& tree, const AccelStorage& storage) const {
    const std::size_t leaves = tree.filling.leaves.size();
    parallelChunks(settings_.tree.threads, leaves, kLeafChunk, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const LeafItems& leaf = tree.filling.leaves[i];
            switch (leaf.kind) {
                case LeafKind::Sphere:
                    fillLeaf(storage.spheres, leaf, tree, input_);
                    break;
                case LeafKind::MovingSphere:
                    fillLeaf(storage.movingSpheres, leaf, tree, input_);
                    break;
                case LeafKind::Quad:
                    fillLeaf(storage.quads, leaf, tree, input_);
                    break;
                case LeafKind::Triangle:
                    fillLeaf(storage.triangles, leaf, tree, input_);
                    break;
                case LeafKind::Instance: {
                    const std::uint32_t index = tree.items.index(tree.filling.items[leaf.firstItem]);
                    const shared::Instance& instance = input_.instances[index];
                    PlacedGeometry& placed = storage.instances[leaf.firstBlock];
                    std::copy(std::begin(instance.toObject), std::end(instance.toObject), placed.toObject);
                    placed.root = roots_[instance.geometry];
                    placed.instance = index;
                    break;
                }
            }
        }
    });
}

void Assembly::fill(AccelStorage& storage) {
    const auto blocks = [&](LeafKind kind) { return blocks_.of[static_cast<std::uint32_t>(kind)]; };
    storage.nodes = LargeArray<WideNode>(std::exchange(nodes_, {}));
    storage.quantizedNodes = LargeArray<QuantizedNode>(std::exchange(quantized_.nodes, {}));
    // That of the trees, which were copied, and of what it took to build them.
    if (input_.spheres.size() + input_.quads.size() + input_.triangles.size() > kManyPrimitives) releaseFreedMemory();
    storage.spheres = LargeArray<SphereBlock>(blocks(LeafKind::Sphere));
    storage.movingSpheres = LargeArray<MovingSphereBlock>(blocks(LeafKind::MovingSphere));
    storage.quads = LargeArray<QuadBlock>(blocks(LeafKind::Quad));
    storage.triangles = LargeArray<TriangleBlock>(blocks(LeafKind::Triangle));
    storage.instances = LargeArray<PlacedGeometry>(blocks(LeafKind::Instance));
    for (const BuiltTree& tree : trees_) {
        fillLeaves(tree, storage);
    }
}

std::uint32_t featuresOf(const AccelInput& input) {
    std::uint32_t features = 0;
    if (!input.spheres.empty()) {
        features |= input.motions.empty() ? shared::kFeatureSpheres : shared::kFeatureMovingSpheres;
    }
    if (!input.quads.empty()) features |= shared::kFeatureQuads;
    if (!input.triangles.empty()) features |= shared::kFeatureTriangles;
    if (!input.instances.empty()) features |= shared::kFeatureInstances;
    return features;
}

} // namespace

CpuAccel::CpuAccel() : storage_(std::make_unique<AccelStorage>()) {}
CpuAccel::~CpuAccel() = default;

std::unique_ptr<CpuAccel> CpuAccel::build(const AccelInput& input, const BuildSettings& settings,
                                          const std::atomic<bool>* cancel, std::atomic<std::uint64_t>* primitivesDone) {
    std::unique_ptr<CpuAccel> accel(new CpuAccel);
    AccelStorage& storage = *accel->storage_;
    AccelView& view = accel->view_;
    view.kinds = featuresOf(input);

    const shared::Geometry world = input.geometries[0];
    const std::uint64_t primitives = std::uint64_t{world.sphereCount} + world.quadCount + world.triangleCount;
    view.isLinear = input.instances.empty() && (primitives == 0 || primitives <= settings.maxLinear);
    if (view.isLinear) {
        if (input.motions.empty()) {
            view.listedSpheres =
                fillList(storage.listedSpheres, input, shared::kSphere, world.firstSphere, world.sphereCount);
        } else {
            view.listedMovingSpheres =
                fillList(storage.listedMovingSpheres, input, shared::kSphere, world.firstSphere, world.sphereCount);
        }
        view.listedQuads = fillList(storage.listedQuads, input, shared::kQuad, world.firstQuad, world.quadCount);
        view.listedTriangles =
            fillList(storage.listedTriangles, input, shared::kTriangle, world.firstTriangle, world.triangleCount);
        if (primitivesDone != nullptr) primitivesDone->fetch_add(primitives);
        return accel;
    }

    Assembly assembly(input, settings, cancel, primitivesDone);
    if (!assembly.buildTrees()) return nullptr;
    assembly.fill(storage);
    view.isLinear = !assembly.hasWorld();
    view.root = assembly.root();
    view.isLarge = accel->bytes() > kLargeBytes;
    view.quantizedNodes = storage.quantizedNodes.data();
    view.quantizationGrid = assembly.quantizationGrid();
    view.nodes = storage.nodes.data();
    view.spheres = storage.spheres.data();
    view.movingSpheres = storage.movingSpheres.data();
    view.quads = storage.quads.data();
    view.triangles = storage.triangles.data();
    view.instances = storage.instances.data();
    return accel;
}

std::size_t CpuAccel::bytes() const {
    const AccelStorage& s = *storage_;
    return sizeof(*this) + sizeof(s) + s.nodes.bytes() + s.quantizedNodes.bytes() + s.spheres.bytes() +
           s.movingSpheres.bytes() + s.quads.bytes() + s.triangles.bytes() + s.instances.bytes() +
           s.listedSpheres.bytes() + s.listedMovingSpheres.bytes() + s.listedQuads.bytes() + s.listedTriangles.bytes();
}

} // namespace rt::accel
