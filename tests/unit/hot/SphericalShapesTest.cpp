#include <algorithm>
#include <numbers>
#include <string>

#include "Common/Shared/Shape/SphericalShapes.h"
#include "tests/unit/Oracles.h"
#include "tests/unit/Statistics.h"

namespace rt::shared {
namespace {

using glm::dvec3;
using test::agrees;
using test::chiSquareP;
using test::kSignificance;
using test::Mean;
using test::Uniforms;

// ---- sphere --------------------------------------------------------------------------------------------------------

TEST(SphereCone, SolidAngleAtEveryDistance) {
    Uniforms uniform(1);
    double worst = 0;
    for (int i = 0; i < 1 << 18; ++i) {
        const auto radius = static_cast<float>(uniform.logBetween(1e-4, 1e4));
        const auto distance = static_cast<float>(radius * (1 + uniform.logBetween(5e-7, 1e5)));
        if (!(distance > radius)) continue;
        const vec3 toCenter(0, distance, 0);
        const double sine = double(radius) / distance;
        const double exact = 2 * std::numbers::pi * sine * sine / (1 + std::sqrt((1 - sine) * (1 + sine)));
        const double solidAngle = 1 / double(sphereConePdf(makeSphereCone(toCenter, radius)));
        worst = std::max(worst, std::abs(solidAngle / exact - 1));
    }
    EXPECT_LE(worst, 6e-7);
}

class SphereConeAt : public testing::TestWithParam<double> {};

TEST_P(SphereConeAt, IsUniformInTheCone) {
    Uniforms uniform(2);
    const float radius = 0.7f;
    // Far away a float direction resolves the cone only near an axis of coordinates.
    const dvec3 axis = GetParam() > 1e4 ? dvec3(0, 0, 1) : glm::normalize(dvec3(0.3, -0.5, 0.8));
    const vec3 center = vec3(axis * (GetParam() * double(radius)));
    const SphereCone cone = makeSphereCone(center, radius);
    const Frame frame = makeFrame(cone.axis);
    const dvec3 exactAxis = glm::normalize(dvec3(cone.axis));
    const double sine = double(radius) / glm::length(dvec3(center));
    const double whole = sine * sine / (1 + std::sqrt((1 - sine) * (1 + sine)));
    std::vector<std::uint64_t> counts(32 * 32);
    double worstBack = 0, worstPoint = 0, worstNormal = 0, worstTogether = 0;
    for (int i = 0; i < 1 << 20; ++i) {
        const vec2 u = uniform.pair();
        const ConeSample s = sampleSphereCone(cone, radius, u);
        const dvec3 w = dvec3(s.direction);
        const dvec3 chord = w - exactAxis;
        const double q = glm::dot(chord, chord) / (2 * whole); // share of the solid angle inside
        const int sector =
            static_cast<int>((std::atan2(glm::dot(w, dvec3(frame.bitangent)), glm::dot(w, dvec3(frame.tangent))) /
                                  (2 * std::numbers::pi) +
                              1) *
                             32) %
            32;
        ++counts[std::clamp(static_cast<int>(q * 32), 0, 31) * 32 + sector];
        worstBack = std::max(worstBack, std::abs(q - double(u.x)));
        const dvec3 point = w * double(s.distance);
        worstPoint = std::max(worstPoint, std::abs(glm::length(point - dvec3(center)) / radius - 1));
        worstNormal = std::max(worstNormal, std::abs(glm::length(dvec3(s.normal)) - 1));
        worstTogether =
            std::max(worstTogether, glm::length(dvec3(center) + dvec3(s.normal) * double(radius) - point) / radius);
    }
    EXPECT_GT(chiSquareP(counts), kSignificance);
    // A float direction resolves 2^-24 of a radian: the bounds grow with distance / radius.
    EXPECT_LE(worstBack, GetParam() <= 30 ? 1e-5 : 4 * double(kEpsilon) * GetParam());
    EXPECT_LE(worstPoint, 2e-6 + 4e-7 * GetParam());
    EXPECT_LE(worstTogether, 2e-6 + 4e-7 * GetParam());
    EXPECT_LE(worstNormal, 1e-6);
}

INSTANTIATE_TEST_SUITE_P(DistanceOverRadius, SphereConeAt, testing::Values(1.0001, 1.1, 2.0, 10.0, 1e3, 1e5));

// ---- triangle ------------------------------------------------------------------------------------------------------

SphericalTriangle seen(const dvec3& a, const dvec3& b, const dvec3& c) {
    return makeSphericalTriangle(vec3(a), vec3(b), vec3(c), vec3(glm::cross(b - a, c - a)));
}

TEST(SphericalTriangle, SolidAngleOfSmallTriangles) {
    Uniforms uniform(3);
    for (const double size : {1.0, 0.1, 1e-2, 1e-3, 1e-6}) {
        Mean squared;
        for (int i = 0; i < 1 << 15; ++i) {
            const dvec3 center = randomDirection(uniform);
            const dvec3 a(vec3(center + size * randomDirection(uniform)));
            const dvec3 u(vec3(size * randomDirection(uniform))), v(vec3(size * randomDirection(uniform)));
            const double exact =
                2 * std::atan2(std::abs(glm::dot(glm::cross(u, v), a)), [&] {
                    const dvec3 b = a + u, c = a + v;
                    const double la = glm::length(a), lb = glm::length(b), lc = glm::length(c);
                    return la * lb * lc + glm::dot(a, b) * lc + glm::dot(a, c) * lb + glm::dot(b, c) * la;
                }());
            // The normal of a light comes from the scene compiler's double precision.
            const SphericalTriangle t =
                makeSphericalTriangle(vec3(a), vec3(a + u), vec3(a + v), vec3(glm::cross(u, v)));
            const dvec3 n = glm::normalize(glm::cross(u, v));
            if (std::abs(glm::dot(n, glm::normalize(a))) < 0.05 || exact > 5) continue; // edge-on: N.a itself cancels
            squared.add(std::pow(t.solidAngle / exact - 1, 2));
        }
        EXPECT_LE(std::sqrt(squared.mean()), 5e-7) << size;
    }
}

TEST(SphericalTriangle, OctantsAndCubeFillTheSphere) {
    double octants = 0, cube = 0;
    for (int k = 0; k < 8; ++k) {
        const dvec3 x(k & 1 ? 1 : -1, 0, 0), y(0, k & 2 ? 1 : -1, 0), z(0, 0, k & 4 ? 1 : -1);
        EXPECT_NEAR(seen(x, y, z).solidAngle, std::numbers::pi / 2, 1e-6);
        octants += seen(x, y, z).solidAngle;
    }
    for (int axis = 0; axis < 3; ++axis) {
        for (const double side : {-1.0, 1.0}) {
            const auto corner = [&](double a, double b) {
                dvec3 p;
                p[axis] = side, p[(axis + 1) % 3] = a, p[(axis + 2) % 3] = b;
                return p;
            };
            cube += seen(corner(-1, -1), corner(1, -1), corner(1, 1)).solidAngle;
            cube += seen(corner(-1, -1), corner(1, 1), corner(-1, 1)).solidAngle;
        }
    }
    EXPECT_NEAR(octants, 4 * std::numbers::pi, 4e-6);
    EXPECT_NEAR(cube, 4 * std::numbers::pi, 4e-6);
}

struct TriangleCase {
    const char* name;
    dvec3 a, b, c;
};
void PrintTo(const TriangleCase& t, std::ostream* out) {
    *out << t.name;
}

class SphericalTriangleCase : public testing::TestWithParam<TriangleCase> {};

// Cells: the similar sub-triangles of a 16 x 16 subdivision, whose exact solid angles are known.
TEST_P(SphericalTriangleCase, IsUniformInSolidAngle) {
    const dvec3 a = GetParam().a, b = GetParam().b, c = GetParam().c;
    const SphericalTriangle t = seen(a, b, c);
    ASSERT_GE(t.solidAngle, 1e-8f);
    const dvec3 e1 = b - a, e2 = c - a, n = glm::cross(e1, e2);
    const int rows = 16;
    const auto at = [&](int i, int j) { return a + e1 * (double(i) / rows) + e2 * (double(j) / rows); };
    std::vector<double> weights(2 * rows * rows);
    for (int i = 0; i < rows; ++i) {
        for (int j = 0; i + j < rows; ++j) {
            weights[2 * (i * rows + j)] = test::triangleSolidAngle(at(i, j), at(i + 1, j), at(i, j + 1));
            if (i + j < rows - 1)
                weights[2 * (i * rows + j) + 1] =
                    test::triangleSolidAngle(at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
        }
    }
    Uniforms uniform(4);
    std::vector<std::uint64_t> counts(weights.size());
    double outside = 0, worstLength = 0;
    for (int i = 0; i < 1 << 19; ++i) {
        const dvec3 w(sampleSphericalTriangle(t, uniform.pair()));
        worstLength = std::max(worstLength, std::abs(glm::length(w) - 1));
        const dvec3 p = w * (glm::dot(a, n) / glm::dot(w, n)) - a;
        const double x = glm::dot(glm::cross(p, e2), n) / glm::dot(n, n),
                     y = glm::dot(glm::cross(e1, p), n) / glm::dot(n, n);
        outside = std::max({outside, -x, -y, x + y - 1});
        const int column = std::clamp(static_cast<int>(x * rows), 0, rows - 1);
        const int row = std::clamp(static_cast<int>(y * rows), 0, rows - 1 - column);
        const bool upper = x * rows - column + y * rows - row > 1 && column + row < rows - 1;
        ++counts[2 * (column * rows + row) + upper];
    }
    EXPECT_GT(chiSquareP(counts, weights), kSignificance);
    EXPECT_LE(worstLength, 1e-6);
    EXPECT_LE(outside, 1e-6 + 1e-7 / std::sqrt(double(t.solidAngle)) * 100);
}

INSTANTIATE_TEST_SUITE_P(
    Shapes, SphericalTriangleCase,
    testing::Values(TriangleCase{"octant", {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                    TriangleCase{"almost a hemisphere", {100, -100, 0.2}, {-100, -100, 0.2}, {0, 170, 0.2}},
                    TriangleCase{"medium", {0.2, 0.1, 1}, {0.6, 0.2, 1.1}, {0.3, 0.7, 0.9}},
                    TriangleCase{"small", {0.2, 0.1, 1}, {0.21, 0.1, 1}, {0.2, 0.11, 1.002}},
                    TriangleCase{"tiny", {0.2, 0.1, 1}, {0.2002, 0.1, 1}, {0.2, 0.1002, 1}},
                    TriangleCase{"sliver", {-0.5, 0.2, 1}, {0.5, 0.2, 1}, {0.1, 0.201, 1}},
                    TriangleCase{"grazing", {1, -0.5, 0.01}, {1, 0.5, 0.01}, {2, 0.1, 0.01}},
                    TriangleCase{"near a vertex", {0.01, 0.01, 0.02}, {1, 0.02, 0.5}, {0.1, 1, 0.5}},
                    TriangleCase{"other winding", {0.2, 0.1, 1}, {0.3, 0.7, 0.9}, {0.6, 0.2, 1.1}}),
    [](const auto& info) { return "Case" + std::to_string(info.index); });

TEST(SphericalTriangle, MapIsInvertible) {
    Uniforms uniform(5);
    for (const double size : {0.5, 0.05}) {
        double worst0 = 0, worst1 = 0;
        for (int i = 0; i < 1 << 14; ++i) {
            const dvec3 a(0, 0, 1), b(size, 0, 1), c(0, size, 1);
            const SphericalTriangle t = seen(a, b, c);
            const vec2 u = uniform.pair() * 0.9f + 0.05f;
            const dvec3 w(sampleSphericalTriangle(t, u));
            const dvec3 ua = glm::normalize(a), ub = glm::normalize(b), uc = glm::normalize(c);
            dvec3 split = glm::normalize(glm::cross(glm::cross(ub, w), glm::cross(uc, ua)));
            if (glm::dot(split, ua + uc) < 0) split = -split;
            const dvec3 whole = split - ub, part = w - ub;
            worst0 = std::max(
                worst0, std::abs(test::triangleSolidAngle(ua, ub, split) / test::triangleSolidAngle(ua, ub, uc) - u.x));
            worst1 = std::max(worst1, std::abs(glm::dot(part, part) / glm::dot(whole, whole) - u.y));
        }
        EXPECT_LE(std::max(worst0, worst1), size > 0.1 ? 2e-5 : 2e-4) << size;
    }
}

TEST(SphericalTriangle, CornersOfTheUnitSquareAreHarmless) {
    const float last = 0x0.ffffffp0f;
    const SphericalTriangle t = seen({0.2, 0.1, 1}, {0.6, 0.2, 1.1}, {0.3, 0.7, 0.9});
    for (const float x : {0.0f, last, 1.0f})
        for (const float y : {0.0f, last}) EXPECT_NEAR(length(sampleSphericalTriangle(t, vec2(x, y))), 1.0f, 1e-6f);
}

// ---- rectangle -----------------------------------------------------------------------------------------------------

SphericalRectangle seen(double x0, double x1, double y0, double y1, double h) {
    return makeSphericalRectangle(vec3(float(x0), float(y0), float(h)), vec3(float(x1 - x0), 0, 0),
                                  vec3(0, float(y1 - y0), 0), vec3(0, 0, 1));
}

struct RectangleCase {
    const char* name;
    double x0, x1, y0, y1, h;
};
void PrintTo(const RectangleCase& r, std::ostream* out) {
    *out << r.name;
}

class SphericalRectangleCase : public testing::TestWithParam<RectangleCase> {};

TEST_P(SphericalRectangleCase, IsUniformInSolidAngle) {
    const auto [name, x0, x1, y0, y1, h] = GetParam();
    const SphericalRectangle r = seen(x0, x1, y0, y1, h);
    const double exact = test::rectangleSolidAngle(x0, x1, y0, y1, h);
    EXPECT_NEAR(r.solidAngle, exact, 2e-6 * exact);
    const int cells = 24;
    std::vector<double> weights(cells * cells);
    const auto mixed = [](double a, double b, double t) { return a + (b - a) * t; };
    for (int i = 0; i < cells; ++i) {
        for (int j = 0; j < cells; ++j) {
            const double t0 = double(i) / cells, t1 = double(i + 1) / cells, s0 = double(j) / cells,
                         s1 = double(j + 1) / cells;
            weights[i * cells + j] = test::rectangleSolidAngle(mixed(x0, x1, t0), mixed(x0, x1, t1), mixed(y0, y1, s0),
                                                               mixed(y0, y1, s1), h);
        }
    }
    Uniforms uniform(6);
    std::vector<std::uint64_t> counts(weights.size());
    double worst = 0;
    for (int i = 0; i < 1 << 19; ++i) {
        const vec2 u = uniform.pair();
        const vec2 p = sampleSphericalRectangle(r, u);
        ASSERT_TRUE(p.x >= 0 && p.x <= r.width && p.y >= 0 && p.y <= r.height);
        const int column = std::min(static_cast<int>(double(p.x) / r.width * cells), cells - 1);
        const int row = std::min(static_cast<int>(double(p.y) / r.height * cells), cells - 1);
        ++counts[column * cells + row];
        if (i < 10000)
            worst = std::max(worst, std::abs(test::rectangleSolidAngle(x0, x0 + double(p.x), y0, y1, h) / exact - u.x));
    }
    EXPECT_GT(chiSquareP(counts, weights), kSignificance);
    EXPECT_LE(worst, 2e-4);
}

INSTANTIATE_TEST_SUITE_P(
    Shapes, SphericalRectangleCase,
    testing::Values(RectangleCase{"cube face", -1, 1, -1, 1, 1}, RectangleCase{"corner", 0, 1, 0, 2, 1},
                    RectangleCase{"off axis", 3, 3.5, 1, 2, 5}, RectangleCase{"grazing", 1, 2, -0.5, 0.5, 0.002},
                    RectangleCase{"grazing far", 10, 20, -5, 5, 0.05}, RectangleCase{"far 1 %", 30, 31, 20, 21, 100},
                    RectangleCase{"far 0.1 %", 300, 301, 200, 201, 1000},
                    RectangleCase{"thin in y", -2, 2, 0.3, 0.301, 0.5},
                    RectangleCase{"thin in x", 0.3, 0.301, -2, 2, 0.5},
                    RectangleCase{"foot inside, near", -1, 1, -1, 1, 0.01},
                    RectangleCase{"foot inside, very near", -1, 1, -1, 1, 1e-4},
                    RectangleCase{"below the foot", -5, -2, -3, -1, 1}),
    [](const auto& info) { return "Case" + std::to_string(info.index); });

// Both ways to the column over rectangles of every size and height.
TEST(SphericalRectangle, ColumnsAreExact) {
    Uniforms uniform(7);
    double worstClosed = 0, worstNewton = 0, worstOmega = 0;
    for (int i = 0; i < 20000; ++i) {
        const float width = float(uniform.logBetween(1e-2, 1e2)), height = float(uniform.logBetween(1e-2, 1e2));
        const float x0 = float(uniform.between(-1.5, 0.5)) * width, y0 = float(uniform.between(-1.5, 0.5)) * height;
        const float h = float(uniform.logBetween(1e-2, 1e2));
        const SphericalRectangle r =
            makeSphericalRectangle(vec3(x0, y0, h), vec3(width, 0, 0), vec3(0, height, 0), vec3(0, 0, 1));
        const double left = r.x0, right = left + r.width, y1 = double(r.y0) + r.height;
        const double exact = test::rectangleSolidAngle(left, right, r.y0, y1, r.h);
        const float u = uniform();
        const auto error = [&](float w) {
            return std::abs(
                test::rectangleSolidAngle(left, left + double(std::clamp(w, 0.0f, r.width)), r.y0, y1, r.h) / exact -
                u);
        };
        worstOmega = std::max(worstOmega, std::abs(double(r.solidAngle) / exact - 1));
        if (r.solidAngle >= 0.05f) worstClosed = std::max(worstClosed, error(rectangleColumn(r, u)));
        worstNewton = std::max(worstNewton, error(rectangleColumnNewton(r, u)));
    }
    EXPECT_LE(worstOmega, 1e-5);
    EXPECT_LE(worstClosed, 6e-4);
    EXPECT_LE(worstNewton, 6e-4);
}

TEST(SphericalRectangle, FacesOfACube) {
    EXPECT_NEAR(seen(-1, 1, -1, 1, 1).solidAngle, 2 * std::numbers::pi / 3, 1e-6);
    EXPECT_NEAR(seen(-1, 1, -1, 1, -1).solidAngle, 2 * std::numbers::pi / 3, 1e-6);
    EXPECT_EQ(seen(1, 2, 1, 2, 0).solidAngle, 0.0f);
}

// ---- strips --------------------------------------------------------------------------------------------------------

struct StripCase {
    double start, distance; // in units of the edge
};

class StripOf : public testing::TestWithParam<StripCase> {};

TEST_P(StripOf, DensityIsThatOfTheSamples) {
    const auto [start, distance] = GetParam();
    const vec3 middle(float(3 * start), 0, float(3 * distance));
    const Strip c = makeStrip(middle, vec3(3, 0, 0), 0);
    const double d = double(c.d);
    const auto rest = [d](double p) {
        return p > 0 ? d / (p * p + d + p * std::sqrt(p * p + d)) : 1 - p / std::sqrt(p * p + d);
    };
    Uniforms uniform(8);
    const int cells = 64;
    std::vector<double> weights(cells);
    const double s = double(c.start);
    // Mirrored where the segment lies on the negative side, to keep the digits of the difference.
    const auto at = [&](double a) { return s + 0.5 < 0 ? rest(-(s + a)) : -rest(s + a); };
    for (int i = 0; i < cells; ++i) weights[i] = std::abs(at((i + 1.0) / cells) - at(double(i) / cells));
    std::vector<std::uint64_t> counts(cells);
    Mean inverse;
    double worst = 0;
    for (int i = 0; i < 1 << 18; ++i) {
        const StripSample x = sampleStrip(c, uniform());
        ASSERT_TRUE(x.a >= 0 && x.a <= 1 && x.pdf > 0) << x.a << ' ' << x.pdf;
        ++counts[std::min(static_cast<int>(x.a * cells), cells - 1)];
        inverse.add(1 / double(x.pdf));
        worst = std::max(worst, std::abs(stripPdf(c, c.start + x.a) / double(x.pdf) - 1));
    }
    EXPECT_GT(chiSquareP(counts, weights), kSignificance);
    if (distance > 0.02) {
        EXPECT_TRUE(agrees(inverse, 1.0));
        EXPECT_LE(worst, 2e-4);
    }
}

INSTANTIATE_TEST_SUITE_P(Positions, StripOf,
                         testing::Values(StripCase{-0.5, 1}, StripCase{0, 0.3}, StripCase{-1, 0.3},
                                         StripCase{-0.3, 0.05}, StripCase{0.3, 0.01}, StripCase{-1.3, 0.01},
                                         StripCase{5, 0.1}, StripCase{-6, 3}, StripCase{2, 1e-3}, StripCase{-0.5, 10}),
                         [](const auto& info) { return "Case" + std::to_string(info.index); });

// ---- area ----------------------------------------------------------------------------------------------------------

TEST(Area, TriangleIsUniform) {
    Uniforms uniform(9);
    const int rows = 16;
    std::vector<std::uint64_t> counts(2 * rows * rows);
    std::vector<double> weights(counts.size());
    for (int i = 0; i < rows; ++i)
        for (int j = 0; i + j < rows; ++j)
            weights[2 * (i * rows + j)] = 1, weights[2 * (i * rows + j) + 1] = i + j < rows - 1;
    for (int i = 0; i < 1 << 19; ++i) {
        const vec2 p = sampleTriangleArea(uniform.pair());
        const int column = std::clamp(static_cast<int>(p.x * rows), 0, rows - 1);
        const int row = std::clamp(static_cast<int>(p.y * rows), 0, rows - 1 - column);
        const bool upper = p.x * rows - float(column) + p.y * rows - float(row) > 1 && column + row < rows - 1;
        ++counts[2 * (column * rows + row) + upper];
    }
    EXPECT_GT(chiSquareP(counts, weights), kSignificance);
    EXPECT_FLOAT_EQ(areaPdf(2, 3, -0.5f), 9);
    EXPECT_EQ(areaPdf(2, 3, 0), 0.0f);
}

} // namespace
} // namespace rt::shared
