#include "Common/Accel/QuantizedBvh.h"

#include <algorithm>
#include <cmath>

#include "Common/Accel/WideBvh.h"

namespace rt::accel {
namespace {

constexpr std::size_t kManyNodes = 1u << 11; // binary ones, of a tree for which it pays
constexpr double kLeafShare = 0.1;           // surface of the leaves in that of the inner nodes

constexpr double kSteps = 65535;
// What planes are moved outwards before they are rounded: more than the rounding of a ray's origin relative to the
// grid, 2^-24 of its extent. (That of an origin outside the grid is in proportion to the distance, as is the margin of
// slabs.)
constexpr double kMargin = 1.0 / 64;

QuantizationGrid makeGrid(const Box& box) {
    QuantizationGrid grid;
    grid.origin = box.lower;
    const shared::vec3 size = box.size();
    const double extent = static_cast<double>(std::max({size.x, size.y, size.z}));
    int exponent = 0; // the extent will be 2^14 to 2^15 steps, so that nothing is cut off at either end
    std::frexp(extent, &exponent);
    grid.stepsPerUnit = std::ldexp(1.0f, std::min(15 - exponent, 100));
    return grid;
}

// In double differences of floats are exact enough: their error is far below the margin.
std::uint16_t below(double steps) {
    return static_cast<std::uint16_t>(std::clamp(std::floor(steps - kMargin), 0.0, kSteps));
}
std::uint16_t above(double steps) {
    return static_cast<std::uint16_t>(std::clamp(std::ceil(steps + kMargin), 0.0, kSteps));
}

QuantizedNode convert(const WideNode& wide, const QuantizationGrid& grid, Reference anyLeaf) {
    QuantizedNode node;
    for (std::uint32_t i = 0; i < kWidth; ++i) {
        const bool exists = wide.planes[0][i] <= wide.planes[1][i];
        node.child[i] = exists ? wide.child[i] : anyLeaf;
        for (int a = 0; a < 3; ++a) {
            const auto steps = [&](float x) {
                return (static_cast<double>(x) - static_cast<double>(grid.origin[a])) *
                       static_cast<double>(grid.stepsPerUnit);
            };
            node.planes[2 * a][i] = exists ? below(steps(wide.planes[2 * a][i])) : static_cast<std::uint16_t>(kSteps);
            node.planes[2 * a + 1][i] = exists ? above(steps(wide.planes[2 * a + 1][i])) : std::uint16_t{0};
        }
    }
    return node;
}

} // namespace

bool gainsFromQuantization(const Bvh& bvh) {
    if (bvh.nodes.size() < kManyNodes) return false;
    double leaves = 0, inner = 0;
    for (const BvhNode& node : bvh.nodes) (node.isLeaf() ? leaves : inner) += static_cast<double>(node.box.halfArea());
    return leaves < kLeafShare * inner;
}

QuantizedBvh quantize(const Bvh& bvh, LeafMaker& leafMaker) {
    std::vector<WideNode> wide;
    appendWide(bvh, leafMaker, wide);
    QuantizedBvh quantized;
    quantized.grid = makeGrid(bvh.nodes[0].box);
    Reference anyLeaf = 0;
    for (const WideNode& node : wide)
        for (const Reference child : node.child)
            if ((child & kLeafBit) != 0) anyLeaf = child;
    quantized.nodes.reserve(wide.size());
    for (const WideNode& node : wide) quantized.nodes.push_back(convert(node, quantized.grid, anyLeaf));
    return quantized;
}

} // namespace rt::accel
