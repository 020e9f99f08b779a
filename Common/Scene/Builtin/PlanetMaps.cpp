// Planet maps of fractal value noise on the sphere.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <system_error>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>

#include "Common/Core/Error.h"
#include "Common/Core/Parallel.h"
#include "Common/Core/Paths.h"
#include "Common/Scene/Builtin/Placeholders.h"
#include "Common/Shared/Base/Random.h"

namespace rt::scene {

namespace {

constexpr std::uint32_t kWidth = 1024;
constexpr std::uint32_t kHeight = 512;

// 256 numbers in [0,1) and a permutation of as many indices.
struct NoiseTable {
    std::array<double, 256> values;
    std::array<std::uint8_t, 256> order;

    NoiseTable() {
        for (std::uint32_t i = 0; i < 256; ++i) {
            values[i] = shared::hash3({i, 0x706c616eu, 0}).x * 0x1p-32;
            order[i] = static_cast<std::uint8_t>(i);
        }
        for (std::uint32_t i = 255; i > 0; --i)
            std::swap(order[i], order[shared::hash3({i, 0x706c616eu, 1}).x % (i + 1)]);
    }
    std::uint32_t orderOf(std::uint32_t i) const { return order[i & 255u]; }
    double valueOf(std::uint32_t i) const { return values[orderOf(i)]; }
};

// In [0,1], of feature size 1.
double valueNoise(const glm::dvec3& p, std::uint32_t seed) {
    static const NoiseTable table;
    glm::ivec3 low(p); // rounded down, without the library's function, which is slow
    low -= glm::ivec3(glm::lessThan(p, glm::dvec3(low)));
    const glm::dvec3 f = p - glm::dvec3(low), w = f * f * (3.0 - 2.0 * f);
    const glm::uvec3 c(low);
    const std::uint32_t a = table.orderOf(c.x + seed), b = table.orderOf(c.x + 1u + seed);
    const auto alongX = [&](std::uint32_t inA, std::uint32_t inB) {
        const double from = table.valueOf(inA), to = table.valueOf(inB);
        return from + w.x * (to - from);
    };
    const auto alongXAndZ = [&](std::uint32_t y) {
        const std::uint32_t inA = table.orderOf(a + y) + c.z, inB = table.orderOf(b + y) + c.z;
        return glm::dvec2(alongX(inA, inB), alongX(inA + 1u, inB + 1u));
    };
    const glm::dvec2 values = glm::mix(alongXAndZ(c.y), alongXAndZ(c.y + 1u), w.y);
    return glm::mix(values.x, values.y, w.z);
}

// In [0,1], about 0.5: octaves from feature size 1 downwards.
double fractal(glm::dvec3 p, int octaves, std::uint32_t seed) {
    double sum = 0, weight = 0.5, total = 0;
    for (int i = 0; i < octaves; ++i, weight *= 0.5, p *= 2.0) {
        sum += weight * valueNoise(p, seed + static_cast<std::uint32_t>(i));
        total += weight;
    }
    return sum / total;
}

double smoothStep(double low, double high, double x) {
    const double t = std::clamp((x - low) / (high - low), 0.0, 1.0);
    return t * t * (3 - 2 * t);
}

// sRGB colours in [0,1] of a direction.

glm::dvec3 earth(const glm::dvec3& d) {
    const double height = fractal(d * 1.9 + 7.0, 8, 11);
    const double warmth = 1 - std::abs(d.y) + 0.3 * (fractal(d * 4.0, 4, 23) - 0.5);
    const glm::dvec3 sea =
        glm::mix(glm::dvec3(0.03, 0.08, 0.25), glm::dvec3(0.08, 0.28, 0.46), smoothStep(0.3, 0.52, height));
    const glm::dvec3 dry =
        glm::mix(glm::dvec3(0.17, 0.33, 0.12), glm::dvec3(0.66, 0.55, 0.34),
                 smoothStep(0.45, 0.6, fractal(d * 3.0 + 3.0, 5, 31)) * smoothStep(0.3, 0.8, warmth));
    const glm::dvec3 land = glm::mix(dry, glm::dvec3(0.45, 0.4, 0.36), smoothStep(0.58, 0.7, height));
    glm::dvec3 color = glm::mix(sea, land, smoothStep(0.515, 0.522, height));
    color = glm::mix(glm::dvec3(0.93, 0.95, 0.97), color, smoothStep(0.03, 0.1, warmth));
    return glm::mix(color, glm::dvec3(0.96),
                    smoothStep(0.55, 0.72, fractal(d * 3.3 + glm::dvec3(0, 5.0 * d.y, 0), 7, 47)));
}

glm::dvec3 earthNight(const glm::dvec3& d) {
    const double height = fractal(d * 1.9 + 7.0, 8, 11);
    const double isLand = smoothStep(0.515, 0.522, height);
    const double towns =
        smoothStep(0.5, 0.68, fractal(d * 6.0, 4, 53)) * smoothStep(0.56, 0.76, fractal(d * 90.0, 2, 61));
    const glm::dvec3 ground = glm::mix(glm::dvec3(0.01, 0.015, 0.05), glm::dvec3(0.03, 0.035, 0.05), isLand);
    return ground + isLand * towns * glm::dvec3(1.0, 0.82, 0.5);
}

glm::dvec3 mars(const glm::dvec3& d) {
    const double dust = fractal(d * 2.3 + 1.0, 8, 71), plains = fractal(d * 1.4, 5, 83);
    glm::dvec3 color = glm::mix(glm::dvec3(0.36, 0.2, 0.13), glm::dvec3(0.8, 0.48, 0.28), smoothStep(0.35, 0.65, dust));
    color *= 0.7 + 0.5 * plains;
    return glm::mix(color, glm::dvec3(0.92, 0.9, 0.88), smoothStep(0.93, 0.96, std::abs(d.y) + 0.05 * dust));
}

glm::dvec3 venus(const glm::dvec3& d) {
    const glm::dvec3 swirl = d * 2.0 + 1.2 * fractal(d * 1.5, 4, 91) + glm::dvec3(0, 2.5 * d.y, 0);
    return glm::mix(glm::dvec3(0.62, 0.46, 0.26), glm::dvec3(0.97, 0.9, 0.72),
                    smoothStep(0.3, 0.7, fractal(swirl, 6, 97)));
}

struct PlanetMap {
    const char* name;
    glm::dvec3 (*color)(const glm::dvec3&);
    const char* installed; // file of planetMapFolder(); empty: packages have none
};
constexpr std::array<PlanetMap, 4> kMaps = {{{"earth", earth, "earth.jpg"},
                                             {"earth-night", earthNight, "night.jpg"},
                                             {"mars", mars, ""},
                                             {"venus", venus, ""}}};

const PlanetMap& mapOf(const std::string& name) {
    const auto map = std::find_if(kMaps.begin(), kMaps.end(), [&](const PlanetMap& m) { return m.name == name; });
    if (map == kMaps.end()) throw InputError("stand-in \"" + name + "\": no such map");
    return *map;
}

} // namespace

const std::vector<std::string>& planetMapNames() {
    static const std::vector<std::string> names = [] {
        std::vector<std::string> all;
        all.reserve(kMaps.size());
        for (const PlanetMap& map : kMaps) all.emplace_back(map.name);
        return all;
    }();
    return names;
}

std::filesystem::path installedPlanetMap(const std::string& name) {
    const std::filesystem::path folder = planetMapFolder();
    const std::string file = mapOf(name).installed;
    std::error_code ignored;
    if (folder.empty() || file.empty() || !std::filesystem::is_regular_file(folder / file, ignored)) return {};
    return folder / file;
}

TexelData makePlanetMap(const std::string& name) {
    const PlanetMap& map = mapOf(name);
    TexelData data{kWidth, kHeight, shared::kTexelSrgb8, {}};
    data.words.resize(std::size_t{kWidth} * kHeight);
    parallelFor(0, kHeight, [&](std::size_t y) {
        const double theta = std::numbers::pi * (static_cast<double>(y) + 0.5) / kHeight;
        for (std::uint32_t x = 0; x < kWidth; ++x) {
            const double phi = 2 * std::numbers::pi * (x + 0.5) / kWidth;
            const glm::dvec3 d(-std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi));
            const glm::dvec3 c = glm::clamp(map.color(d), 0.0, 1.0) * 255.0 + 0.5;
            data.words[y * kWidth + x] = static_cast<std::uint32_t>(c.x) | static_cast<std::uint32_t>(c.y) << 8 |
                                         static_cast<std::uint32_t>(c.z) << 16 | 0xff000000u;
        }
    });
    return data;
}

} // namespace rt::scene
