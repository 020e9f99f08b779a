#include "Common/Image/Flip.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <span>
#include <vector>

#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <glm/vec3.hpp>

#include "Common/Image/Metrics.h"

namespace rt::image {
namespace {

using glm::vec3;

constexpr double kPi = 3.14159265358979323846;

// ---- colour spaces: linear sRGB, XYZ relative to white, YCxCz (opponent, linear), L*a*b* ---------------------------

const glm::mat3& xyzFromRgb() {
    static const glm::mat3 matrix = [] {
        const glm::mat3 rows(0.4124564f, 0.3575761f, 0.1804375f, // of IEC 61966-2-1
                             0.2126729f, 0.7151522f, 0.0721750f, //
                             0.0193339f, 0.1191920f, 0.9503041f);
        glm::mat3 columns = glm::transpose(rows);
        const vec3 white = columns * vec3(1.0f);
        for (int c = 0; c < 3; ++c) columns[c] /= white; // so that white is (1, 1, 1)
        return columns;
    }();
    return matrix;
}

vec3 opponentFromRgb(vec3 rgb) {
    const vec3 xyz = xyzFromRgb() * rgb;
    return {116.0f * xyz.y - 16.0f, 500.0f * (xyz.x - xyz.y), 200.0f * (xyz.y - xyz.z)};
}

vec3 rgbFromOpponent(vec3 opponent) {
    static const glm::mat3 inverse = glm::inverse(xyzFromRgb());
    const float y = (opponent.x + 16.0f) / 116.0f;
    return inverse * vec3(y + opponent.y / 500.0f, y, y - opponent.z / 200.0f);
}

// L*a*b* with chroma shrunk in the dark (Hunt's effect): a and b times 0.01 L.
vec3 huntLab(vec3 rgb) {
    constexpr float kDelta = 6.0f / 29.0f;
    const vec3 xyz = xyzFromRgb() * rgb;
    const auto f = [](float t) {
        return t > kDelta * kDelta * kDelta ? std::cbrt(t) : t / (3.0f * kDelta * kDelta) + 4.0f / 29.0f;
    };
    const float y = f(xyz.y);
    const float lightness = 116.0f * y - 16.0f;
    return {lightness, 0.01f * lightness * 500.0f * (f(xyz.x) - y), 0.01f * lightness * 200.0f * (y - f(xyz.z))};
}

// HyAB: city-block in lightness, Euclidean in chroma.
float hyab(vec3 a, vec3 b) {
    return std::abs(a.x - b.x) + std::hypot(a.y - b.y, a.z - b.z);
}

// ---- filters -------------------------------------------------------------------------------------------------------

using Plane = Image;               // of one channel
using Kernel = std::vector<float>; // of odd length, centred

template <class Function> // (double x) -> double
Kernel sampled(int radius, Function function) {
    Kernel kernel(static_cast<std::size_t>(2 * radius + 1));
    for (int x = -radius; x <= radius; ++x)
        kernel[static_cast<std::size_t>(x + radius)] = static_cast<float>(function(static_cast<double>(x)));
    return kernel;
}

// Positive weights scaled to the sum 1 and negative ones to -1.
Kernel normalised(Kernel kernel) {
    double positive = 0, negative = 0;
    for (const float weight : kernel) (weight > 0 ? positive : negative) += weight;
    for (float& weight : kernel)
        weight = static_cast<float>(weight > 0 ? weight / positive : weight / std::abs(negative));
    return kernel;
}

// Pixels beyond the edge are those at the edge.
Plane convolveRows(const Plane& in, const Kernel& kernel) {
    const std::size_t width = in.width, radius = kernel.size() / 2;
    Plane out(in.width, in.height, 1);
    std::vector<float> padded(width + 2 * radius);
    for (std::uint32_t y = 0; y < in.height; ++y) {
        const float* row = in.pixel(0, y);
        std::fill_n(padded.begin(), radius, row[0]);
        std::copy_n(row, width, padded.begin() + static_cast<std::ptrdiff_t>(radius));
        std::fill_n(padded.end() - static_cast<std::ptrdiff_t>(radius), radius, row[width - 1]);
        float* to = out.pixel(0, y);
        for (std::size_t k = 0; k < kernel.size(); ++k)
            for (std::size_t x = 0; x < width; ++x) to[x] += kernel[k] * padded[x + k];
    }
    return out;
}

Plane convolveColumns(const Plane& in, const Kernel& kernel) {
    const int height = static_cast<int>(in.height), radius = static_cast<int>(kernel.size() / 2);
    Plane out(in.width, in.height, 1);
    for (int y = 0; y < height; ++y) {
        float* to = out.pixel(0, static_cast<std::uint32_t>(y));
        for (int k = -radius; k <= radius; ++k) {
            const float weight = kernel[static_cast<std::size_t>(k + radius)];
            const float* from = in.pixel(0, static_cast<std::uint32_t>(std::clamp(y + k, 0, height - 1)));
            for (std::uint32_t x = 0; x < in.width; ++x) to[x] += weight * from[x];
        }
    }
    return out;
}

Plane convolve(const Plane& in, const Kernel& horizontal, const Kernel& vertical) {
    return convolveColumns(convolveRows(in, horizontal), vertical);
}

// The paper's contrast sensitivity as a sum of Gaussians a sqrt(pi / b) exp(-(pi r)^2 / b), r in degrees (section 4.1).
struct Gaussian {
    double a, b;
};
constexpr Gaussian kToLuminance[] = {{1, 0.0047}};
constexpr Gaussian kToRedGreen[] = {{1, 0.0053}};
constexpr Gaussian kToBlueYellow[] = {{34.1, 0.04}, {13.5, 0.025}};
constexpr std::array<std::span<const Gaussian>, 3> kSensitivity = {kToLuminance, kToRedGreen, kToBlueYellow};
constexpr double kWidestB = 0.04;

Plane filterBySensitivity(const Plane& in, std::span<const Gaussian> gaussians, double pixelsPerDegree) {
    const int radius = static_cast<int>(std::ceil(3 * std::sqrt(kWidestB / (2 * kPi * kPi)) * pixelsPerDegree));
    Plane out(in.width, in.height, 1);
    double total = 0;
    for (const auto [a, b] : gaussians) {
        const Kernel kernel = sampled(radius, [&, b = b](double x) {
            return std::exp(-kPi * kPi * (x / pixelsPerDegree) * (x / pixelsPerDegree) / b);
        });
        const double sum = std::accumulate(kernel.begin(), kernel.end(), 0.0);
        const double factor = a * std::sqrt(kPi / b);
        total += factor * sum * sum;
        const Plane part = convolve(in, kernel, kernel);
        for (std::size_t i = 0; i < out.data.size(); ++i) out.data[i] += static_cast<float>(factor) * part.data[i];
    }
    for (float& value : out.data) value /= static_cast<float>(total);
    return out;
}

// ---- the two halves of the metric ----------------------------------------------------------------------------------

constexpr float kColorExponent = 0.7f;   // q_c
constexpr float kKnee = 0.4f;            // p_c: this share of the largest difference is mapped ...
constexpr float kKneeValue = 0.95f;      // p_t: ... to this value
constexpr double kFeatureWidth = 0.082;  // w, degrees
constexpr float kFeatureExponent = 0.5f; // q_f

struct Seen {              // of one image
    std::vector<vec3> lab; // after what the eye blurs
    Plane edges, points;   // strength of features
};

Seen see(const Image& image, double pixelsPerDegree) {
    std::array<Plane, 3> opponent;
    for (Plane& plane : opponent) plane = Plane(image.width, image.height, 1);
    Plane luminance(image.width, image.height, 1);
    for (std::size_t i = 0; i < luminance.data.size(); ++i) {
        const float* from = &image.data[i * image.channels];
        const std::size_t green = image.channels == 3 ? 1 : 0; // one channel is grey
        const vec3 rgb(from[0], from[green], from[2 * green]);
        const vec3 value = opponentFromRgb(glm::clamp(rgb, vec3(0.0f), vec3(1.0f)));
        for (std::size_t c = 0; c < 3; ++c) opponent[c].data[i] = value[static_cast<int>(c)];
        luminance.data[i] = (value.x + 16.0f) / 116.0f;
    }
    for (std::size_t c = 0; c < 3; ++c)
        opponent[c] = filterBySensitivity(opponent[c], kSensitivity[c], pixelsPerDegree);
    Seen seen;
    seen.lab.resize(luminance.data.size());
    for (std::size_t i = 0; i < seen.lab.size(); ++i) {
        const vec3 rgb = rgbFromOpponent({opponent[0].data[i], opponent[1].data[i], opponent[2].data[i]});
        seen.lab[i] = huntLab(glm::clamp(rgb, vec3(0.0f), vec3(1.0f)));
    }

    const double sigma = 0.5 * kFeatureWidth * pixelsPerDegree;
    const int radius = static_cast<int>(std::ceil(3 * sigma));
    const auto gauss = [sigma](double x) { return std::exp(-x * x / (2 * sigma * sigma)); };
    const Kernel smooth = normalised(sampled(radius, gauss));
    const Kernel first = normalised(sampled(radius, [&](double x) { return -x * gauss(x); }));
    const Kernel second =
        normalised(sampled(radius, [&](double x) { return (x * x / (sigma * sigma) - 1) * gauss(x); }));
    const auto strength = [&](const Kernel& derivative) {
        Plane across = convolve(luminance, derivative, smooth);
        const Plane down = convolve(luminance, smooth, derivative);
        for (std::size_t i = 0; i < across.data.size(); ++i) across.data[i] = std::hypot(across.data[i], down.data[i]);
        return across;
    };
    seen.edges = strength(first);
    seen.points = strength(second);
    return seen;
}

// Differences of colour in [0,1]: most of the range goes to those up to the knee (section 4.1, "Color difference").
float colorDifference(vec3 a, vec3 b) {
    static const float largest = std::pow(hyab(huntLab({0, 1, 0}), huntLab({0, 0, 1})), kColorExponent);
    const float difference = std::pow(hyab(a, b), kColorExponent);
    const float knee = kKnee * largest;
    const float mapped = difference < knee ? difference * kKneeValue / knee
                                           : kKneeValue + (difference - knee) / (largest - knee) * (1.0f - kKneeValue);
    return std::min(mapped, 1.0f);
}

} // namespace

Image flipMap(const Image& image, const Image& reference, double pixelsPerDegree) {
    compare(image, reference); // for its checks
    const Seen a = see(image, pixelsPerDegree), b = see(reference, pixelsPerDegree);
    Image map(image.width, image.height, 1);
    for (std::size_t i = 0; i < map.data.size(); ++i) {
        const float feature =
            std::max(std::abs(a.edges.data[i] - b.edges.data[i]), std::abs(a.points.data[i] - b.points.data[i]));
        const float featureDifference = std::min(std::pow(feature / std::sqrt(2.0f), kFeatureExponent), 1.0f);
        map.data[i] = std::pow(colorDifference(a.lab[i], b.lab[i]), 1.0f - featureDifference);
    }
    return map;
}

double flip(const Image& image, const Image& reference, double pixelsPerDegree) {
    return channelMeans(flipMap(image, reference, pixelsPerDegree))[0];
}

} // namespace rt::image
