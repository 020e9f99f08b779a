// A triangular lamp seen from a point covers a triangle on the sphere of directions. This program draws directions
// that are uniform in it, by Arvo's map of the unit square, checks what it drew, and plots it: each direction is a
// dot on a map of the upper hemisphere (seen from above, the horizon is the circle), coloured by where in the square
// it came from.
//
//     ./spherical-triangle [PLOT.png]
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <string>

#include "Common/Image/Image.h"
#include "Common/Image/ImageIo.h"
#include "Common/Shared/Base/Random.h"
#include "Common/Shared/Base/Sampling.h"
#include "Common/Shared/Shape/SphericalShapes.h"

using namespace rt::shared; // vec2, vec3, and the formulas

namespace {

// The lamp, relative to the point that it is seen from; z is up.
const vec3 kA(-1.5f, -0.5f, 0.4f), kB(1.2f, -0.9f, 0.8f), kC(0.1f, 1.3f, 1.1f);

// Whether the direction is on the inner side of the three planes through the point and an edge: a test that knows
// nothing of the map.
bool isInside(vec3 d) {
    const bool ab = dot(cross(kA, kB), d) > 0, bc = dot(cross(kB, kC), d) > 0, ca = dot(cross(kC, kA), d) > 0;
    return ab == bc && bc == ca && dot(kA + kB + kC, d) > 0;
}

// Two uniform numbers in [0,1): points of Sobol's sequence cover the square more evenly than independent ones.
vec2 uniforms(std::uint32_t index, std::uint32_t dimension) {
    constexpr std::uint32_t kKey = 1; // another one scrambles the sequence otherwise
    return toUniform2(sobolSample(kKey, index, dimension));
}

// Equal areas on the map are equal solid angles (Lambert's projection).
void plot(rt::image::Image& map, vec3 direction, vec2 u) {
    const float scale = std::sqrt(1.0f / (1.0f + direction.z)) * 0.48f * static_cast<float>(map.width);
    const float middle = 0.5f * static_cast<float>(map.width);
    const auto x = static_cast<std::uint32_t>(middle + direction.x * scale);
    const auto y = static_cast<std::uint32_t>(middle - direction.y * scale);
    for (std::uint32_t i = 0; i < 9; ++i) {
        float* pixel = map.pixel(std::min(x + i % 3, map.width - 1), std::min(y + i / 3, map.height - 1));
        pixel[0] = u.x, pixel[1] = 0.2f, pixel[2] = u.y;
    }
}

} // namespace

int main(int count, char** arguments) try {
    const std::string file = count > 1 ? arguments[1] : "spherical-triangle.png";
    constexpr std::uint32_t kSamples = 200'000;
    const SphericalTriangle triangle = makeSphericalTriangle(kA, kB, kC, cross(kB - kA, kC - kA));

    rt::image::Image map(512, 512);
    std::fill(map.data.begin(), map.data.end(), 1.0f);
    for (std::uint32_t i = 0; i < 20'000; ++i) { // the horizon
        const vec2 sc = sinCos2Pi(static_cast<float>(i) / 20'000.0f);
        plot(map, vec3(sc.y, sc.x, 0.0f), vec2(0.0f));
    }

    // What is drawn lies inside, and its mean is that of the lamp's directions: the solid angle times that mean is a
    // vector whose part along z is the irradiance of a lamp of radiance 1 (Lambert's formula sums it over the edges).
    std::uint32_t inside = 0, uniformInside = 0;
    double mean = 0;
    for (std::uint32_t i = 0; i < kSamples; ++i) {
        const vec2 u = uniforms(i, 1);
        const vec3 direction = sampleSphericalTriangle(triangle, u);
        inside += isInside(direction) ? 1 : 0;
        mean += direction.z / kSamples;
        if (i < 2000) plot(map, direction, u);
        uniformInside += isInside(sampleSphere(uniforms(i, 2))) ? 1 : 0;
    }
    double irradiance = 0;
    const vec3 corners[] = {normalize(kA), normalize(kB), normalize(kC)};
    for (int i = 0; i < 3; ++i) {
        const vec3 p = corners[i], q = corners[(i + 1) % 3];
        irradiance += 0.5 * std::acos(dot(p, q)) * normalize(cross(p, q)).z;
    }

    rt::image::writeImage(file, map);
    std::printf("solid angle: %.4f sr by the formula, %.4f of uniform directions\n", triangle.solidAngle,
                4 * 3.14159265 * uniformInside / kSamples);
    std::printf("irradiance: %.4f by Lambert's formula, %.4f of the samples\n", std::abs(irradiance),
                triangle.solidAngle * mean);
    std::printf("inside: %.3f %% of %u samples\n%s\n", 100.0 * inside / kSamples, kSamples, file.c_str());
    return 0;
} catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
}
