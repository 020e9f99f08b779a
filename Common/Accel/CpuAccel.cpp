#include "Common/Accel/CpuAccel.h"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <numeric>
#include <utility>
#include <vector>

#include "Common/Accel/AccelRefit.h"
#include "Common/Accel/AccelStorage.h"
#include "Common/Accel/Build/BlockFill.h"
#include "Common/Accel/Build/SceneTrees.h"
#include "Common/Accel/QuantizedBvh.h"
#include "Common/Accel/SameGeometry.h"
#include "Common/Accel/WideBvh.h"
#include "Common/Core/Parallel.h"
#include "Common/Core/SystemMemory.h"
#include "Common/Shared/Base/Features.h"

namespace rt::accel {
namespace {

constexpr std::size_t kBlockChunk = 1u << 9;      // blocks that a thread fills at a time
constexpr std::size_t kBlockSlice = 1u << 15;     // blocks after which it is worth to give back what told their lanes
constexpr std::size_t kLargeBytes = 1u << 20;     // of a tree that traversal fetches ahead
constexpr std::size_t kLeastRefitted = 1u << 12;  // primitives and instances: a new tree takes no time, and is better
constexpr double kMaxWear = 1.25;                 // of boxes in which rays look, before a new tree is due
constexpr std::size_t kManyPrimitives = 1u << 16; // beside whose memory it is worth a millisecond to give some back

template <class Block>
LinearList<Block> fillList(LargeArray<Block>& blocks, const AccelInput& input, std::uint32_t kind,
                           const std::vector<std::uint32_t>& primitives) {
    const auto count = static_cast<std::uint32_t>(primitives.size());
    blocks = LargeArray<Block>((count + kWidth - 1) / kWidth);
    for (std::uint32_t i = 0; i < count; ++i) {
        Block& block = blocks[i / kWidth];
        if (i % kWidth == 0) block = emptyBlock<Block>();
        fillLane(block, i % kWidth, input, primitives[i]);
        block.primitive[i % kWidth] = packPrimitive(kind, primitives[i]);
    }
    return {blocks.data(), (count + kWidth - 1) / kWidth};
}

void fillLists(AccelStorage& storage, const AccelInput& input, const shared::Geometry& world, AccelView& view) {
    const auto indices = [](std::uint32_t first, std::uint32_t count) {
        std::vector<std::uint32_t> all(count);
        std::iota(all.begin(), all.end(), first);
        return all;
    };
    const std::vector<std::uint32_t> all = indices(world.firstSphere, world.sphereCount);
    const auto spheresOf = [&](LeafKind kind) {
        std::vector<std::uint32_t> spheres;
        std::copy_if(all.begin(), all.end(), std::back_inserter(spheres),
                     [&](std::uint32_t sphere) { return sphereKind(input, sphere) == kind; });
        return spheres;
    };
    const auto listSpheres = [&](auto& blocks, const std::vector<std::uint32_t>& spheres) {
        return fillList(blocks, input, shared::kSphere, spheres);
    };
    std::vector<std::uint32_t> spheres = spheresOf(LeafKind::Sphere), nearSpheres = spheresOf(LeafKind::NearSphere);
    // Every ray meets all lanes of a block of near spheres, and others may be among these: what finds room there needs
    // no block of its own.
    const std::size_t room = (kWidth - nearSpheres.size() % kWidth) % kWidth, moved = std::min(room, spheres.size());
    nearSpheres.insert(nearSpheres.end(), spheres.end() - static_cast<std::ptrdiff_t>(moved), spheres.end());
    spheres.resize(spheres.size() - moved);
    view.listedSpheres = listSpheres(storage.listedSpheres, spheres);
    view.listedNearSpheres = listSpheres(storage.listedNearSpheres, nearSpheres);
    view.listedMovingSpheres = listSpheres(storage.listedMovingSpheres, spheresOf(LeafKind::MovingSphere));
    view.listedQuads = fillList(storage.listedQuads, input, shared::kQuad, indices(world.firstQuad, world.quadCount));
    view.listedTriangles =
        fillList(storage.listedTriangles, input, shared::kTriangle, indices(world.firstTriangle, world.triangleCount));
    view.listedRounds =
        fillList(storage.listedRounds, input, shared::kRound, indices(world.firstRound, world.roundCount));
}

// Lanes go as blocks come: these are the last large arrays, and nothing else is as much memory as they are.
template <class Block>
LargeArray<Block> fillBlocks(std::vector<std::uint32_t> lanes, const AccelInput& input, std::size_t threads) {
    LargeArray<Block> blocks(lanes.size() / kWidth);
    const auto fill = [&](std::size_t i) {
        blocks[i] = emptyBlock<Block>();
        for (std::uint32_t lane = 0; lane < kWidth; ++lane) {
            const std::uint32_t primitive = lanes[i * kWidth + lane];
            if (primitive != shared::kNone) fillLane(blocks[i], lane, input, primitive);
        }
    };
    const Chunks slices(blocks.size(), kBlockSlice);
    for (std::size_t slice = 0; slice < slices.count; ++slice) {
        const std::size_t first = slices.begin(slice), count = slices.end(slice) - first;
        parallelChunks(threads, count, kBlockChunk, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = first + begin; i < first + end; ++i) fill(i);
        });
        if (count == kBlockSlice) discard(&lanes[first * kWidth], count * kWidth * sizeof(lanes[0]));
    }
    return blocks;
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
    LargeArray<PlacedGeometry> placeInstances() const;

    const AccelInput& input_;
    const BuildSettings& settings_;
    const std::atomic<bool>* cancel_;
    std::atomic<std::uint64_t>* primitivesDone_;
    std::vector<WideNode> nodes_;
    QuantizedBvh quantized_; // the world, if it gains from that
    BlockLanes lanes_;
    std::vector<Reference> roots_; // of each geometry
    bool hasWorld_ = false;
};

bool Assembly::buildTrees() {
    roots_.resize(input_.geometries.size());
    return buildSceneTrees(input_, settings_.tree, cancel_, primitivesDone_, [this](const SceneTree& tree) {
        LeafMaker leafMaker(tree.bvh, tree.items, lanes_);
        if (input_.instances.empty() && gainsFromQuantization(tree.bvh)) {
            quantized_ = quantize(tree.bvh, leafMaker);
        } else {
            roots_[tree.geometry] = appendWide(tree.bvh, leafMaker, nodes_);
        }
        leafMaker.finish();
        hasWorld_ = hasWorld_ || tree.geometry == 0;
    });
}

LargeArray<PlacedGeometry> Assembly::placeInstances() const {
    const std::vector<std::uint32_t>& order = lanes_.of[static_cast<std::uint32_t>(LeafKind::Instance)];
    LargeArray<PlacedGeometry> placed(order.size());
    for (std::size_t i = 0; i < order.size(); ++i) {
        const shared::Instance& instance = input_.instances[order[i]];
        std::copy(std::begin(instance.toObject), std::end(instance.toObject), placed[i].toObject);
        placed[i].root = roots_[instance.geometry];
        placed[i].instance = order[i];
    }
    return placed;
}

void Assembly::fill(AccelStorage& storage) {
    storage.nodes = LargeArray<WideNode>(std::exchange(nodes_, {}));
    storage.quantizedNodes = LargeArray<QuantizedNode>(std::exchange(quantized_.nodes, {}));
    // That of the trees, which were copied, and of what it took to build them.
    const std::size_t primitives =
        input_.spheres.size() + input_.quads.size() + input_.triangles.size() + input_.rounds.size();
    if (primitives > kManyPrimitives) releaseFreedMemory();
    const auto fillKind = [&]<class Block>(LargeArray<Block>& blocks, LeafKind kind) {
        blocks =
            fillBlocks<Block>(std::move(lanes_.of[static_cast<std::uint32_t>(kind)]), input_, settings_.tree.threads);
    };
    fillKind(storage.spheres, LeafKind::Sphere);
    fillKind(storage.nearSpheres, LeafKind::NearSphere);
    fillKind(storage.movingSpheres, LeafKind::MovingSphere);
    fillKind(storage.quads, LeafKind::Quad);
    fillKind(storage.triangles, LeafKind::Triangle);
    fillKind(storage.rounds, LeafKind::Round);
    storage.instances = placeInstances();
}

shared::Features featuresOf(const AccelInput& input) {
    shared::Features features;
    if (!input.spheres.empty()) {
        features |= input.motions.empty() ? shared::kFeatureSpheres : shared::kFeatureMovingSpheres;
    }
    if (!input.quads.empty()) features |= shared::kFeatureQuads;
    if (!input.triangles.empty()) features |= shared::kFeatureTriangles;
    if (!input.rounds.empty()) features |= shared::kRoundFeatures;
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
    const std::uint64_t primitives =
        std::uint64_t{world.sphereCount} + world.quadCount + world.triangleCount + world.roundCount;
    view.isLinear = input.instances.empty() && (primitives == 0 || primitives <= settings.maxLinear);
    if (view.isLinear) {
        fillLists(storage, input, world, view);
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
    view.nearSpheres = storage.nearSpheres.data();
    view.movingSpheres = storage.movingSpheres.data();
    view.quads = storage.quads.data();
    view.triangles = storage.triangles.data();
    view.rounds = storage.rounds.data();
    view.instances = storage.instances.data();
    return accel;
}

bool CpuAccel::follow(const AccelInput& before, const AccelInput& now, std::uint32_t threads) {
    if (sameInput(before, now)) return true;
    const std::size_t primitives = now.spheres.size() + now.quads.size() + now.triangles.size() + now.rounds.size();
    if (primitives + now.instances.size() < kLeastRefitted) return false;
    if (view_.isLinear || !canRefit(*storage_, view_.root, before, now)) return false;
    if (!builtArea_) area_ = builtArea_.emplace(areaOf(storage_->nodes, view_.root));
    return refit(*storage_, view_.root, before, now, kMaxWear * *builtArea_, area_, threads);
}

std::size_t CpuAccel::bytes() const {
    const AccelStorage& s = *storage_;
    return sizeof(*this) + sizeof(s) + s.nodes.bytes() + s.quantizedNodes.bytes() + s.spheres.bytes() +
           s.nearSpheres.bytes() + s.movingSpheres.bytes() + s.quads.bytes() + s.triangles.bytes() + s.rounds.bytes() +
           s.listedRounds.bytes() + s.instances.bytes() + s.listedSpheres.bytes() + s.listedNearSpheres.bytes() +
           s.listedMovingSpheres.bytes() + s.listedQuads.bytes() + s.listedTriangles.bytes();
}

} // namespace rt::accel
