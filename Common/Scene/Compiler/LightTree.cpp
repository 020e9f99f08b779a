#include "Common/Scene/Compiler/LightTree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>
#include <utility>

#include "Common/Core/Interruption.h"
#include "Common/Scene/Compiler/Bounds.h"

namespace rt::scene {

namespace {

using glm::dvec3;
using shared::kLightNodeChildren;

constexpr int kBins = 12;
constexpr std::size_t kFewItems = kLightNodeChildren * kLightNodeChildren; // that two levels of nodes can hold

// The normals of some lights: all within an angle of `axis`.
struct NormalCone {
    dvec3 axis{0};
    double angle = -1; // negative: empty
};

NormalCone unite(const NormalCone& a, const NormalCone& b) {
    if (b.angle > a.angle) return unite(b, a);
    if (b.angle < 0) return a;
    const double between = std::acos(std::clamp(glm::dot(a.axis, b.axis), -1.0, 1.0));
    if (between + b.angle <= a.angle) return a;
    const double angle = 0.5 * (a.angle + between + b.angle);
    if (angle >= std::numbers::pi) return {a.axis, std::numbers::pi};
    // Turn a's axis towards b's; opposite ones have no direction in between.
    const dvec3 across = b.axis - a.axis * glm::dot(a.axis, b.axis);
    const double length = glm::length(across);
    if (!(length > 1e-12)) return {a.axis, std::numbers::pi};
    const double turn = angle - a.angle;
    return {glm::normalize(a.axis * std::cos(turn) + across * (std::sin(turn) / length)), angle};
}

// One light, or several.
struct Cluster {
    Bounds box;
    NormalCone cone;
    double planarIntensity = 0;          // intensity of flat lights that emit to one side
    double omnidirectionalIntensity = 0; // of the others, mean over directions

    void add(const Cluster& other) {
        if (!other.box.empty()) box.add(other.box.lower), box.add(other.box.upper);
        cone = unite(cone, other.cone);
        planarIntensity += other.planarIntensity;
        omnidirectionalIntensity += other.omnidirectionalIntensity;
    }
};

Cluster clusterOf(const shared::LightBound& bound) {
    Cluster c;
    c.box.add(dvec3(bound.center), static_cast<double>(bound.radius));
    const double intensity = static_cast<double>(bound.intensity);
    if (bound.axis == shared::vec3(0.0f)) {
        c.omnidirectionalIntensity = intensity;
    } else if (bound.twoSided > 0.0f) {
        c.omnidirectionalIntensity = 0.5 * intensity; // mean of |cos|
    } else {
        c.planarIntensity = intensity;
        c.cone = {glm::normalize(dvec3(bound.axis)), 0};
    }
    return c;
}

// Of the directions that a cone of emitters serves, weighed by the cosine to the nearest normal (Conty Estevez &
// Kulla).
double orientationMeasure(const NormalCone& cone) {
    if (cone.angle < 0) return 0;
    const double wide = std::min(cone.angle + 0.5 * std::numbers::pi, std::numbers::pi);
    return 2 * std::numbers::pi * (1 - std::cos(cone.angle)) +
           0.5 * std::numbers::pi *
               (2 * wide * std::sin(cone.angle) - std::cos(cone.angle - 2 * wide) -
                2 * cone.angle * std::sin(cone.angle) + std::cos(cone.angle));
}

// What it costs to treat the lights of a cluster alike: their power times how far they spread in place and direction.
double spreadCost(const Cluster& c) {
    if (c.box.empty()) return 0;
    const dvec3 size = c.box.upper - c.box.lower;
    return (c.omnidirectionalIntensity * 4 * std::numbers::pi + c.planarIntensity * orientationMeasure(c.cone)) *
           glm::dot(size, size);
}

struct Item {
    std::uint32_t light;
    dvec3 center;
    Cluster cluster;
};

struct Group {
    std::span<Item> items;
    Cluster cluster;
    double cost;
};

Group makeGroup(std::span<Item> items) {
    Cluster all;
    for (const Item& item : items) all.add(item.cluster);
    return {items, all, spreadCost(all)};
}

struct Plane {
    int axis = -1;
    int bin = 0; // the first on the far side
    double cost = std::numeric_limits<double>::infinity();
};

int binOf(double x, double low, double scale) {
    return std::clamp(static_cast<int>((x - low) * scale), 0, kBins - 1);
}

// Of few items planes that leave less than a quarter on either side are passed over: nodes would not be filled.
void tryAxis(std::span<const Item> items, const Bounds& centers, int axis, Plane& best) {
    const double low = centers.lower[axis], extent = centers.upper[axis] - low;
    if (!(extent > 0)) return;
    const double scale = kBins / extent;
    std::array<Cluster, kBins> bins;
    std::array<std::size_t, kBins> counts{};
    for (const Item& item : items) {
        const auto bin = static_cast<std::size_t>(binOf(item.center[axis], low, scale));
        bins[bin].add(item.cluster);
        ++counts[bin];
    }
    std::array<double, kBins> below{};
    Cluster sum;
    for (std::size_t i = 0; i + 1 < kBins; ++i) {
        sum.add(bins[i]);
        below[i + 1] = spreadCost(sum);
    }
    sum = {};
    std::size_t above = 0;
    for (std::size_t i = kBins - 1; i > 0; --i) {
        sum.add(bins[i]);
        above += counts[i];
        if (items.size() <= kFewItems && std::min(above, items.size() - above) < items.size() / 4) continue;
        const double cost = below[i] + spreadCost(sum);
        if (cost < best.cost) best = {axis, static_cast<int>(i), cost};
    }
}

// Divides `items`, two or more, into two parts; where they lie in one place, into halves.
std::array<Group, 2> split(std::span<Item> items) {
    interruptionPoint();
    Bounds centers;
    for (const Item& item : items) centers.add(item.center);
    Plane best;
    for (int axis = 0; axis < 3; ++axis) tryAxis(items, centers, axis, best);
    std::size_t middle = items.size() / 2;
    if (best.axis >= 0) {
        const double low = centers.lower[best.axis], scale = kBins / (centers.upper[best.axis] - low);
        const auto farBegin = std::stable_partition(items.begin(), items.end(), [&](const Item& item) {
            return binOf(item.center[best.axis], low, scale) < best.bin;
        });
        const auto nearCount = static_cast<std::size_t>(farBegin - items.begin());
        if (nearCount > 0 && nearCount < items.size()) middle = nearCount;
    }
    return {makeGroup(items.first(middle)), makeGroup(items.subspan(middle))};
}

class TreeBuilder {
  public:
    explicit TreeBuilder(CompiledScene& out) : out_(out) {}

    void build() {
        std::vector<Item> items, distant;
        for (std::uint32_t i = 0; i < out_.globals.lightCount; ++i) {
            const shared::LightBound& bound = out_.lightBounds[i];
            if (!(bound.intensity > 0.0f) || i == out_.globals.skyLight) continue;
            const bool isDistant = out_.lights[i].kind == shared::kLightDirectional;
            (isDistant ? distant : items).push_back({i, dvec3(bound.center), clusterOf(bound)});
        }
        out_.lightToLeaf.assign(out_.globals.lightCount, shared::kNone);
        const bool sky = out_.globals.skyLight != shared::kNone;
        const std::uint32_t root = addNode(shared::kNone);
        std::uint32_t slot = 0;
        // The sky surrounds everything, so no group may hold it, and directional lights are too far away from all
        // others to be in a group with them.
        if (sky) placeLight(root, slot++, out_.globals.skyLight);
        if (!distant.empty()) place(root, slot++, makeGroup(distant));
        if (!items.empty()) fill(root, slot, makeGroup(items));
    }

  private:
    std::uint32_t addNode(std::uint32_t parent) {
        shared::LightNode node{};
        for (std::uint32_t i = 0; i < kLightNodeChildren; ++i) {
            node.radius[i] = 1.0f; // keeps the arithmetic of children that do not exist finite
            node.child[i] = shared::kLightLeaf;
        }
        out_.lightNodes.push_back(node);
        out_.lightToLeaf.push_back(parent);
        return static_cast<std::uint32_t>(out_.lightNodes.size() - 1);
    }

    // The group divided into at most `slots`. What is more than two levels of nodes can hold is divided where it
    // spreads most; the rest so that few nodes are needed: into groups that fit into a node, and then small groups
    // dissolve where there is room for their lights.
    static std::vector<Group> divide(const Group& whole, std::size_t slots) {
        const auto smaller = [](const Group& a, const Group& b) { return a.items.size() < b.items.size(); };
        const auto denser = [](const Group& a, const Group& b) {
            return std::pair(a.items.size() > 1, a.cost) < std::pair(b.items.size() > 1, b.cost);
        };
        const bool isLarge = whole.items.size() > slots * kLightNodeChildren;
        const std::size_t capacity = isLarge || whole.items.size() <= slots ? 1 : kLightNodeChildren;
        std::vector<Group> groups{whole};
        while (groups.size() < slots) {
            const auto next = isLarge ? std::max_element(groups.begin(), groups.end(), denser)
                                      : std::max_element(groups.begin(), groups.end(), smaller);
            if (next->items.size() <= capacity) break;
            const auto parts = split(next->items);
            *next = parts[0];
            groups.push_back(parts[1]);
        }
        std::stable_sort(groups.begin(), groups.end(), smaller);
        for (std::size_t i = 0; i < groups.size(); ++i) {
            const std::span<Item> items = groups[i].items;
            if (groups.size() + items.size() - 1 > slots) break;
            groups[i] = makeGroup(items.first(1));
            for (std::size_t k = 1; k < items.size(); ++k) groups.push_back(makeGroup(items.subspan(k, 1)));
        }
        return groups;
    }

    // Children from `slot` on: the group, divided.
    void fill(std::uint32_t node, std::uint32_t slot, const Group& whole) {
        for (const Group& group : divide(whole, kLightNodeChildren - slot)) {
            place(node, slot, group);
            ++slot;
        }
    }

    // A light, or a group with all that is below it.
    void place(std::uint32_t node, std::uint32_t slot, const Group& group) {
        if (group.items.size() == 1) {
            placeLight(node, slot, group.items[0].light);
            return;
        }
        placeGroup(node, slot, group);
        const std::uint32_t child = addNode(node * kLightNodeChildren + slot);
        out_.lightNodes[node].child[slot] = child;
        fill(child, 0, group);
    }

    void placeLight(std::uint32_t node, std::uint32_t slot, std::uint32_t light) {
        const shared::LightBound& bound = out_.lightBounds[light];
        shared::LightNode& n = out_.lightNodes[node];
        placeSphere(n, slot, bound.center, -bound.radius);
        placeCone(n, slot, bound.axis, 1.0f, 0.0);
        const bool isFlat = bound.axis != shared::vec3(0.0f);
        n.planarIntensity[slot] = !isFlat ? 0.0f : bound.twoSided > 0.0f ? -bound.intensity : bound.intensity;
        n.omnidirectionalIntensity[slot] = isFlat ? 0.0f : bound.intensity;
        n.child[slot] = light | shared::kLightLeaf;
        out_.lightToLeaf[light] = node * kLightNodeChildren + slot;
    }

    void placeGroup(std::uint32_t node, std::uint32_t slot, const Group& group) {
        shared::LightNode& n = out_.lightNodes[node];
        const dvec3 center = group.cluster.box.center();
        double radius = 0;
        dvec3 normals(0);
        for (const Item& item : group.items) {
            const double reach = static_cast<double>(out_.lightBounds[item.light].radius);
            radius = std::max(radius, glm::length(item.center - center) + reach);
            normals += item.cluster.cone.axis * item.cluster.planarIntensity;
        }
        // Rounding must not leave a light outside.
        const auto rounded = static_cast<float>(radius * (1 + 1e-6) + 1e-7 * glm::length(center));
        placeSphere(n, slot, shared::vec3(center), rounded);
        // The cone is that around the mean normal.
        const double planarIntensity = group.cluster.planarIntensity, length = glm::length(normals);
        dvec3 axis = length > 1e-6 * planarIntensity ? normals / length : group.cluster.cone.axis;
        double widest = 0;
        for (const Item& item : group.items) {
            if (!(item.cluster.planarIntensity > 0)) continue;
            // By the chord, which is exact for small angles too.
            const dvec3 normal = item.cluster.cone.axis;
            widest = std::max(widest, 2 * std::atan2(glm::length(normal - axis), glm::length(normal + axis)));
        }
        placeCone(n, slot, shared::vec3(axis),
                  planarIntensity > 0 ? static_cast<float>(std::min(1.0, length / planarIntensity)) : 0.0f,
                  std::min(widest + 1e-6, std::numbers::pi));
        n.planarIntensity[slot] = static_cast<float>(planarIntensity);
        n.omnidirectionalIntensity[slot] = static_cast<float>(group.cluster.omnidirectionalIntensity);
    }

    static void placeSphere(shared::LightNode& n, std::uint32_t slot, const shared::vec3& center, float radius) {
        n.centerX[slot] = center.x;
        n.centerY[slot] = center.y;
        n.centerZ[slot] = center.z;
        n.radius[slot] = radius;
    }

    static void placeCone(shared::LightNode& n, std::uint32_t slot, const shared::vec3& axis, float meanResultantLength,
                          double angle) {
        n.axisX[slot] = axis.x;
        n.axisY[slot] = axis.y;
        n.axisZ[slot] = axis.z;
        n.meanResultantLength[slot] = meanResultantLength;
        // Rounding must not narrow the cone.
        n.spreadCosine[slot] = angle > 0 ? std::nextafter(static_cast<float>(std::cos(angle)), -1.0f) : 1.0f;
    }

    CompiledScene& out_;
};

} // namespace

void buildLightTree(CompiledScene& out) {
    if (out.globals.lightCount > shared::kContributionLights) TreeBuilder(out).build();
}

} // namespace rt::scene
