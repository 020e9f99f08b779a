// The small parts that the scene compiler is made of: distributions on a grid, orders along a curve, Perlin tables,
// polygons, assets that are generated or of packages.
#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <numeric>
#include <random>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "Common/Core/Error.h"
#include "Common/Scene/Builtin/Placeholders.h"
#include "Common/Scene/Builtin/SceneBuilder.h"
#include "Common/Scene/Compiler/GridCdf.h"
#include "Common/Scene/Compiler/MeshOrder.h"
#include "Common/Scene/Compiler/PerlinTable.h"
#include "Common/Scene/Obj/Polygon.h"
#include "tests/Environment.h"
#include "tests/TempFolder.h"

namespace rt::scene {
namespace {

TEST(GridCdf, IsExactOnTheGrid) {
    std::mt19937 random(1);
    for (const std::size_t count : {1u, 2u, 3u, 1000u, 100000u}) {
        std::vector<double> weights(count);
        double total = 0;
        for (double& weight : weights) {
            weight = random() % 4 == 0 ? 0 : std::exp(std::uniform_real_distribution<double>(-20, 5)(random));
            total += weight;
        }
        if (total == 0) weights[0] = total = 1;
        const std::vector<float> cdf = gridCdf(weights);
        ASSERT_EQ(cdf.size(), count + 1);
        EXPECT_EQ(cdf.front(), 0.0f);
        EXPECT_EQ(cdf.back(), 1.0f);
        for (std::size_t i = 0; i < count; ++i) {
            const double width = double(cdf[i + 1]) - cdf[i];
            EXPECT_EQ(std::fmod(width * kCdfCells, 1.0), 0.0);
            EXPECT_EQ(width > 0, weights[i] > 0);
            EXPECT_NEAR(width, weights[i] / total, (2.0 + double(count) * weights[i] / total) / kCdfCells);
        }
    }
}

TEST(GridCdf, WithoutWeightTheLastBinGetsAll) {
    EXPECT_EQ(gridCdf(std::vector<double>{0, 0, 0}), (std::vector<float>{0, 0, 0, 1}));
}

TEST(MeshOrder, KeepsTheTrianglesAndBringsNeighboursTogether) {
    const MeshData ball = icosphere(4);
    std::vector<glm::vec3> positions(ball.positions.begin(), ball.positions.end());
    std::vector<glm::uvec3> triangles = ball.triangles;
    std::shuffle(triangles.begin(), triangles.end(), std::mt19937(2));
    const auto step = [&] {
        double sum = 0;
        for (std::size_t i = 1; i < triangles.size(); ++i)
            sum += glm::length(positions[triangles[i].x] - positions[triangles[i - 1].x]);
        return sum / double(triangles.size());
    };
    const auto sorted = [](std::vector<glm::uvec3> all) {
        std::sort(all.begin(), all.end(), [](const glm::uvec3& a, const glm::uvec3& b) {
            return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
        });
        return all;
    };
    const std::vector<glm::uvec3> before = sorted(triangles);
    EXPECT_GT(step(), 1.0);
    std::vector<std::uint32_t> order(triangles.size());
    std::iota(order.begin(), order.end(), 0u);
    orderAlongCurve(positions, {triangles}, order);
    std::vector<glm::uvec3> ordered;
    ordered.reserve(order.size());
    for (const std::uint32_t i : order) ordered.push_back(triangles[i]);
    triangles = ordered;
    EXPECT_LT(step(), 0.1);
    EXPECT_EQ(sorted(triangles), before);
}

// scenes.md, defect S-25: gradients must be uniform on the sphere, not those of a normalised cube.
TEST(PerlinTable, GradientsAreUniformOnTheSphere) {
    CompiledScene scene;
    for (std::uint32_t seed = 0; seed < 64; ++seed) EXPECT_EQ(appendPerlinTable(seed, scene), seed);
    ASSERT_EQ(scene.perlinGradients.size(), 64u * shared::kPerlinSize);
    glm::dvec3 sum(0), fourth(0);
    for (const shared::vec3& g : scene.perlinGradients) {
        ASSERT_NEAR(glm::dot(g, g), 1, 1e-6);
        const glm::dvec3 d(g);
        sum += d;
        fourth += d * d * d * d;
    }
    const double n = double(scene.perlinGradients.size());
    // E x = 0, var 1/3; E x^4 = 1/5 (0.17 for the cube's corners), var 1/9 - 1/25.
    for (int axis = 0; axis < 3; ++axis) {
        EXPECT_LT(std::abs(sum[axis]), 4 * std::sqrt(n / 3));
        EXPECT_LT(std::abs(fourth[axis] - n / 5), 4 * std::sqrt(n * (1.0 / 9 - 1.0 / 25)));
    }
}

TEST(PerlinTable, PermutationsAreComplete) {
    CompiledScene scene;
    appendPerlinTable(5, scene);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        std::vector<std::uint32_t> all(scene.perlinPermutations.begin() + std::ptrdiff_t(axis * 256),
                                       scene.perlinPermutations.begin() + std::ptrdiff_t(axis * 256 + 256));
        EXPECT_FALSE(std::is_sorted(all.begin(), all.end()));
        std::sort(all.begin(), all.end());
        for (std::uint32_t i = 0; i < 256; ++i) EXPECT_EQ(all[i], i);
    }
}

double areaOf(const std::vector<glm::dvec3>& corners, const std::vector<glm::uvec3>& triangles, bool expectLeftTurns) {
    double sum = 0;
    for (const glm::uvec3& t : triangles) {
        const double area = 0.5 * glm::cross(corners[t.y] - corners[t.x], corners[t.z] - corners[t.x]).z;
        EXPECT_TRUE(area >= 0 || !expectLeftTurns);
        sum += area;
    }
    return sum;
}

TEST(Polygon, ConcaveOnesAreCoveredOnce) {
    const std::vector<glm::dvec3> arrow = {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {2, 1, 0}, {0, 4, 0}};
    EXPECT_NEAR(areaOf(arrow, cutPolygon(arrow), true), 16 - 6, 1e-12);
    for (int turns = 0; turns < 3; ++turns) { // whatever it faces
        std::vector<glm::dvec3> turned;
        turned.reserve(arrow.size());
        for (const glm::dvec3& p : arrow) turned.emplace_back(p[turns], p[(turns + 1) % 3], p[(turns + 2) % 3]);
        for (int side = 0; side < 2; ++side, std::reverse(turned.begin(), turned.end())) {
            glm::dvec3 sum(0), whole(0);
            double sizes = 0;
            for (const glm::uvec3& t : cutPolygon(turned)) {
                const glm::dvec3 area = glm::cross(turned[t.y] - turned[t.x], turned[t.z] - turned[t.x]);
                sum += 0.5 * area;
                sizes += 0.5 * glm::length(area);
            }
            for (std::size_t i = 0; i < turned.size(); ++i)
                whole += 0.5 * glm::cross(turned[i], turned[(i + 1) % turned.size()]);
            EXPECT_LT(glm::length(sum - whole), 1e-12);
            EXPECT_NEAR(sizes, 10, 1e-12);
        }
    }
    // A comb with 200 teeth.
    std::vector<glm::dvec3> comb;
    for (int i = 0; i < 200; ++i) comb.insert(comb.end(), {{i, 0, 0}, {i + 0.5, -3, 0}});
    comb.insert(comb.end(), {{200, 0, 0}, {200, 1, 0}, {0, 1, 0}});
    const auto triangles = cutPolygon(comb);
    EXPECT_EQ(triangles.size(), comb.size() - 2);
    EXPECT_NEAR(areaOf(comb, triangles, true), 200 * 1 + 200 * 1.5, 1e-9);
}

// Where cutting takes time in proportion to the square of the corners, this takes as long as a nightly run.
TEST(Polygon, HugeOnesAreCoveredOnce) {
    constexpr int kCorners = 200'000;
    constexpr double kTurn = 2 * 3.14159265358979323846 / kCorners;
    const auto around = [](const auto& radius) {
        std::vector<glm::dvec3> corners;
        for (int i = 0; i < kCorners; ++i) {
            const double r = radius(i);
            corners.emplace_back(r * std::cos(i * kTurn), r * std::sin(i * kTurn), 1);
        }
        return corners;
    };
    const double sector = 0.5 * std::sin(kTurn);
    const auto disc = around([](int) { return 1.0; });
    EXPECT_NEAR(areaOf(disc, cutPolygon(disc), true), kCorners * sector, 1e-9);
    const auto star = around([](int i) { return i % 2 == 0 ? 1.0 : 0.5; });
    EXPECT_NEAR(areaOf(star, cutPolygon(star), true), kCorners * 0.5 * sector, 1e-9);
    // A coast: radii at random.
    std::mt19937 random(1);
    std::vector<double> radii;
    radii.reserve(kCorners);
    for (int i = 0; i < kCorners; ++i) radii.push_back(std::uniform_real_distribution<double>(0.5, 1)(random));
    const auto coast = around([&](int i) { return radii[static_cast<std::size_t>(i)]; });
    double area = 0;
    for (std::size_t i = 0; i < radii.size(); ++i) area += radii[i] * radii[(i + 1) % radii.size()] * sector;
    EXPECT_NEAR(areaOf(coast, cutPolygon(coast), true), area, 1e-9);
    // A double spiral, a strip wound up: both ends are ears, and few others.
    std::vector<glm::dvec3> spiral;
    const auto at = [](int i, double inwards) {
        const double angle = 0.01 * i, r = 1 + 0.1 * angle - inwards;
        return glm::dvec3(r * std::cos(angle), r * std::sin(angle), 2);
    };
    constexpr int kSteps = 20'000;
    spiral.reserve(kSteps);
    for (int i = 0; i < kSteps; ++i) spiral.push_back(at(i, 0));
    for (int i = kSteps; i-- > 0;) spiral.push_back(at(i, 0.1));
    double strip = 0;
    for (std::size_t i = 0; i < spiral.size(); ++i)
        strip += 0.5 * glm::cross(spiral[i], spiral[(i + 1) % spiral.size()]).z;
    EXPECT_NEAR(areaOf(spiral, cutPolygon(spiral), true), strip, 1e-9 * strip);
}

TEST(Polygon, OddOnesAreCutToo) {
    const std::vector<glm::dvec3> bowTie = {{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}};
    EXPECT_EQ(cutPolygon(bowTie).size(), 2u);
    EXPECT_EQ(cutPolygon(std::vector<glm::dvec3>(7, glm::dvec3(1))).size(), 5u);
    const double nan = std::nan("");
    EXPECT_EQ(cutPolygon(std::vector<glm::dvec3>(5, glm::dvec3(nan))).size(), 3u);
}

TEST(Placeholders, TheStatueIsClosedAndOfTheSizeOfLucy) {
    const MeshData statue = makeMeshStandIn("statue");
    EXPECT_NEAR(double(statue.triangles.size()), 450000, 10000);
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
    double volume = 0;
    for (const glm::uvec3& t : statue.triangles) {
        for (int i = 0; i < 3; ++i) ++edges[{t[i], t[(i + 1) % 3]}], --edges[{t[(i + 1) % 3], t[i]}];
        volume += glm::dot(statue.positions[t.x], glm::cross(statue.positions[t.y], statue.positions[t.z])) / 6;
    }
    EXPECT_TRUE(std::all_of(edges.begin(), edges.end(), [](const auto& edge) { return edge.second == 0; }));
    EXPECT_GT(volume, 0) << "fronts must be outside";
    glm::dvec3 lower(1e9), upper(-1e9);
    for (const glm::dvec3& p : statue.positions) lower = glm::min(lower, p), upper = glm::max(upper, p);
    EXPECT_NEAR(lower.y, 15, 5);
    EXPECT_NEAR(upper.y, 885, 5);
    EXPECT_NEAR(upper.z - lower.z, 480, 20);
    EXPECT_NEAR(double(makeMeshStandIn("statue-fine").triangles.size()), 1000000, 20000);
    EXPECT_THROW(makeMeshStandIn("bunny"), InputError);
}

TEST(Placeholders, MapsOfPackagesAreTakenWhereAskedFor) {
    const test::TempFolder folder;
    std::ofstream(folder / "earth.jpg") << "a map";
    test::setVariable("RT_PLANET_MAPS", folder.path().string());
    SceneDesc desc;
    desc.textures["t"] = ImageTexture{"textures/none.jpg", "earth"};
    desc.materials["m"].albedo = "t";
    desc.objects = {{SphereDesc{{0, 0, -5}, 1, {}, "m"}}};
    std::vector<std::filesystem::path> read;
    CompileOptions options;
    options.loadTexels = [&](const std::filesystem::path& path, std::optional<std::uint32_t>) {
        read.push_back(path);
        return TexelData{1, 1, shared::kTexelSrgb8, {0xff0000ffu}};
    };
    EXPECT_EQ(compileScene(desc, options)->images[0].width, 1024u) << "tests take generated maps";
    options.installedMaps = true;
    const auto compiled = compileScene(desc, options);
    EXPECT_EQ(compiled->images[0].width, 1u);
    EXPECT_EQ(compiled->notices.at(0), "textures/none.jpg: " + (folder / "earth.jpg").string() + " stands in");
    ASSERT_EQ(read.size(), 1u);
    EXPECT_EQ(read[0], folder / "earth.jpg");
    options.generatedAssets = true; // as benchmarks do: nothing is installed for them
    EXPECT_EQ(installedPlanetMap("earth-night"), std::filesystem::path());
    std::get<ImageTexture>(desc.textures["t"]).standIn = "mars";
    EXPECT_EQ(compileScene(desc, options)->images[0].width, 1024u);
    test::setVariable("RT_PLANET_MAPS", "");
    EXPECT_THROW(installedPlanetMap("pluto"), InputError);
}

TEST(Placeholders, PlanetMapsDiffer) {
    std::vector<std::vector<std::uint32_t>> maps;
    for (const std::string& name : planetMapNames()) {
        TexelData map = makePlanetMap(name);
        ASSERT_EQ(map.words.size(), std::size_t{map.width} * map.height);
        EXPECT_EQ(std::count(maps.begin(), maps.end(), map.words), 0);
        maps.push_back(std::move(map.words));
    }
    EXPECT_THROW(makePlanetMap("pluto"), InputError);
}

} // namespace
} // namespace rt::scene
