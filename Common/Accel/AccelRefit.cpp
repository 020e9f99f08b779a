#include "Common/Accel/AccelRefit.h"

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <iterator>
#include <span>
#include <vector>

#include "Common/Accel/Box.h"
#include "Common/Accel/Build/BlockFill.h"
#include "Common/Accel/Build/PrimitiveBoxes.h"
#include "Common/Accel/Build/TreeItems.h"
#include "Common/Accel/SameGeometry.h"
#include "Common/Core/Parallel.h"

namespace rt::accel {
namespace {

constexpr std::size_t kRefillChunk = 1u << 9; // blocks that a thread fills at a time

bool isLeafReference(Reference reference) {
    return (reference & kLeafBit) != 0;
}

Box slabs(const WideNode& node, std::uint32_t child) {
    Box box;
    for (int a = 0; a < 3; ++a) {
        box.lower[a] = node.planes[2 * a][child];
        box.upper[a] = node.planes[2 * a + 1][child];
    }
    return box;
}

bool hasChild(const WideNode& node, std::uint32_t child) {
    return node.planes[0][child] <= node.planes[1][child];
}

Box boxOf(const WideNode& node) {
    Box box;
    for (std::uint32_t child = 0; child < kWidth; ++child)
        if (hasChild(node, child)) box.add(slabs(node, child));
    return box;
}

class Refit {
  public:
    // Takes all memory that it needs: once something has changed, nothing may fail.
    Refit(AccelStorage& storage, Reference root, std::uint32_t threads)
        : storage_(storage), root_(root), threads_(threads), nodeChanged_(storage.nodes.size()) {
        changedOf(LeafKind::Sphere).resize(storage.spheres.size());
        changedOf(LeafKind::NearSphere).resize(storage.nearSpheres.size());
        changedOf(LeafKind::MovingSphere).resize(storage.movingSpheres.size());
        changedOf(LeafKind::Quad).resize(storage.quads.size());
        changedOf(LeafKind::Triangle).resize(storage.triangles.size());
        changedOf(LeafKind::Round).resize(storage.rounds.size());
        changedOf(LeafKind::Instance).resize(storage.instances.size());
    }

    // Returns by how much areaOf() has grown.
    double run(const AccelInput& before, const AccelInput& now) {
        now_ = &now;
        std::fill(nodeChanged_.begin(), nodeChanged_.end(), std::uint8_t{0});
        for (std::vector<std::uint8_t>& changed : changed_) std::fill(changed.begin(), changed.end(), std::uint8_t{0});
        const auto refillKind = [&]<class Block>(const LargeArray<Block>& blocks, LeafKind kind, bool isSame) {
            if (!isSame) refill(blocks, changedOf(kind));
        };
        const bool isSame = sameArray(before.spheres, now_->spheres) && sameArray(before.motions, now_->motions);
        refillKind(storage_.spheres, LeafKind::Sphere, isSame);
        refillKind(storage_.nearSpheres, LeafKind::NearSphere, isSame);
        refillKind(storage_.movingSpheres, LeafKind::MovingSphere, isSame);
        refillKind(storage_.quads, LeafKind::Quad, sameArray(before.quads, now_->quads));
        refillKind(storage_.triangles, LeafKind::Triangle,
                   sameArray(before.triangles, now_->triangles) && sameArray(before.positions, now_->positions));
        refillKind(storage_.rounds, LeafKind::Round, sameArray(before.rounds, now_->rounds));
        // Trees stand one behind the other, the world's last.
        refitNodes(0, root_);
        moveInstances();
        growth_ = 0;
        refitNodes(root_, storage_.nodes.size());
        return growth_;
    }

  private:
    // Which blocks hold something that has changed.
    std::vector<std::uint8_t>& changedOf(LeafKind kind) { return changed_[static_cast<std::uint32_t>(kind)]; }

    template <class Block>
    void refill(const LargeArray<Block>& blocks, std::vector<std::uint8_t>& changed) const {
        parallelChunks(threads_, blocks.size(), kRefillChunk, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                Block fresh = emptyBlock<Block>();
                for (std::uint32_t lane = 0; lane < kWidth; ++lane)
                    if (blocks[i].primitive[lane] != shared::kNone)
                        fillLane(fresh, lane, *now_, blocks[i].primitive[lane]);
                if (std::memcmp(&blocks[i], &fresh, sizeof fresh) == 0) continue;
                blocks[i] = fresh;
                changed[i] = 1;
            }
        });
    }

    void moveInstances() {
        std::vector<std::uint8_t>& changed = changedOf(LeafKind::Instance);
        for (std::size_t i = 0; i < changed.size(); ++i) {
            PlacedGeometry& placed = storage_.instances[i];
            const auto& toObject = now_->instances[placed.instance].toObject;
            changed[i] = std::memcmp(placed.toObject, toObject, sizeof toObject) != 0 || hasChanged(placed.root);
            std::copy(std::begin(toObject), std::end(toObject), placed.toObject);
        }
    }

    bool hasChanged(Reference reference) const {
        if (!isLeafReference(reference)) return nodeChanged_[reference] != 0;
        const std::vector<std::uint8_t>& changed = changed_[kindOf(reference)];
        const auto first = changed.begin() + firstBlock(reference);
        return std::any_of(first, first + blockCount(reference), [](std::uint8_t is) { return is != 0; });
    }

    // Of nodes whose children come behind them.
    void refitNodes(std::size_t begin, std::size_t end) {
        for (std::size_t i = end; i-- > begin;) {
            WideNode& node = storage_.nodes[i];
            for (std::uint32_t child = 0; child < kWidth; ++child) {
                if (!hasChild(node, child) || !hasChanged(node.child[child])) continue;
                const Box box = boxBelow(node.child[child]);
                growth_ += double{box.halfArea()} - double{slabs(node, child).halfArea()};
                for (int a = 0; a < 3; ++a) {
                    node.planes[2 * a][child] = box.lower[a];
                    node.planes[2 * a + 1][child] = box.upper[a];
                }
                nodeChanged_[i] = 1;
            }
        }
    }

    Box boxBelow(Reference reference) const {
        if (!isLeafReference(reference)) return boxOf(storage_.nodes[reference]);
        Box box;
        for (std::uint32_t i = firstBlock(reference); i < firstBlock(reference) + blockCount(reference); ++i)
            box.add(boxOfBlock(static_cast<LeafKind>(kindOf(reference)), i));
        return box;
    }

    // Small leaves share blocks: then it is also that of others, and larger than it would have to be.
    template <class Block, class BoxOfOne>
    Box boxOfLanes(const Block& block, const BoxOfOne& boxOfOne) const {
        Box box;
        for (const std::uint32_t primitive : block.primitive)
            if (primitive != shared::kNone) box.add(boxOfOne(primitive));
        return box;
    }

    Box boxOfBlock(LeafKind kind, std::uint32_t i) const {
        const auto sphere = [this](std::uint32_t s) { return accel::boxOf(now_->spheres[s]); };
        switch (kind) {
            case LeafKind::Sphere:
                return boxOfLanes(storage_.spheres[i], sphere);
            case LeafKind::NearSphere:
                return boxOfLanes(storage_.nearSpheres[i], sphere);
            case LeafKind::MovingSphere: {
                const auto moving = [this](std::uint32_t s) {
                    return accel::boxOf(now_->spheres[s], now_->motions[s]);
                };
                return boxOfLanes(storage_.movingSpheres[i], moving);
            }
            case LeafKind::Quad: {
                const auto quad = [this](std::uint32_t q) { return accel::boxOf(now_->quads[q]); };
                return boxOfLanes(storage_.quads[i], quad);
            }
            case LeafKind::Round: {
                const auto round = [this](std::uint32_t r) { return accel::boxOf(now_->rounds[r]); };
                return boxOfLanes(storage_.rounds[i], round);
            }
            case LeafKind::Instance: {
                const PlacedGeometry& placed = storage_.instances[i];
                return accel::boxOf(now_->instances[placed.instance], boxBelow(placed.root));
            }
            case LeafKind::Triangle:
                break;
        }
        const auto triangle = [this](std::uint32_t t) {
            const shared::uvec3 v = now_->triangles[t];
            return accel::boxOf(now_->positions[v.x], now_->positions[v.y], now_->positions[v.z]);
        };
        return boxOfLanes(storage_.triangles[i], triangle);
    }

    static std::uint32_t kindOf(Reference leaf) { return (leaf & ~kLeafBit) >> kKindShift; }
    static std::uint32_t blockCount(Reference leaf) { return (leaf >> kCountShift) % kMaxLeafBlocks + 1; }
    static std::uint32_t firstBlock(Reference leaf) { return leaf % kMaxBlocks; }

    AccelStorage& storage_;
    const Reference root_; // of the world
    const std::uint32_t threads_;
    const AccelInput* now_ = nullptr;
    std::vector<std::uint8_t> changed_[kLeafKinds]; // blocks of each kind
    std::vector<std::uint8_t> nodeChanged_;
    double growth_ = 0;
};

template <class T>
bool sameSize(std::span<const T> a, std::span<const T> b) {
    return a.size() == b.size();
}

} // namespace

bool canRefit(const AccelStorage& storage, Reference root, const AccelInput& before, const AccelInput& now) {
    if (isLeafReference(root) || storage.quantizedNodes.size() > 0) return false;
    const bool isAlike = sameSize(before.spheres, now.spheres) && sameSize(before.motions, now.motions) &&
                         sameSize(before.quads, now.quads) && sameSize(before.rounds, now.rounds) &&
                         sameSize(before.triangles, now.triangles) && sameSize(before.geometries, now.geometries) &&
                         sameSize(before.instances, now.instances);
    if (!isAlike) return false;
    for (std::size_t i = 0; i < now.geometries.size(); ++i)
        if (std::memcmp(&before.geometries[i], &now.geometries[i], sizeof now.geometries[i]) != 0) return false;
    for (std::size_t i = 0; i < now.instances.size(); ++i)
        if (before.instances[i].geometry != now.instances[i].geometry) return false;
    for (std::uint32_t i = 0; i < now.spheres.size(); ++i)
        if (sphereKind(before, i) != sphereKind(now, i)) return false;
    return true;
}

double areaOf(const LargeArray<WideNode>& nodes, Reference root) {
    double area = 0;
    for (std::size_t i = root; i < nodes.size(); ++i)
        for (std::uint32_t child = 0; child < kWidth; ++child) area += double{slabs(nodes[i], child).halfArea()};
    return area;
}

bool refit(AccelStorage& storage, Reference root, const AccelInput& before, const AccelInput& now, double maxArea,
           double& area, std::uint32_t threads) {
    Refit boxes(storage, root, threads);
    const double grown = area + boxes.run(before, now);
    if (grown > maxArea) {
        boxes.run(now, before);
        return false;
    }
    area = grown;
    return true;
}

} // namespace rt::accel
