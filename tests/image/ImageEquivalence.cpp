#include "tests/image/ImageEquivalence.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <vector>

#include "Common/Core/Error.h"
#include "Common/Image/Statistics.h"

namespace rt::image {

namespace {

constexpr double kFalseDiscoveryRate = 1e-3;
constexpr double kMinGlobalP = 1e-3;
constexpr double kLargestSpreadZ = 4;

// Means over squares of `side` pixels (fewer at the right and lower edge), channels kept apart.
Image shrink(const Image& image, std::uint32_t side) {
    Image small((image.width + side - 1) / side, (image.height + side - 1) / side, image.channels);
    for (std::uint32_t y = 0; y < small.height; ++y) {
        for (std::uint32_t x = 0; x < small.width; ++x) {
            const std::uint32_t endX = std::min((x + 1) * side, image.width);
            const std::uint32_t endY = std::min((y + 1) * side, image.height);
            for (std::uint32_t c = 0; c < image.channels; ++c) {
                double sum = 0;
                for (std::uint32_t v = y * side; v < endY; ++v)
                    for (std::uint32_t u = x * side; u < endX; ++u) sum += image.pixel(u, v)[c];
                const double count = double(endX - x * side) * double(endY - y * side);
                small.pixel(x, y)[c] = static_cast<float>(sum / count);
            }
        }
    }
    return small;
}

std::vector<Image> shrink(std::span<const Image> images, std::uint32_t side) {
    std::vector<Image> small;
    for (const Image& image : images) small.push_back(shrink(image, side));
    return small;
}

Estimate estimateValue(std::span<const Image> blocks, std::size_t index) {
    std::vector<double> samples;
    for (const Image& block : blocks) samples.push_back(block.data[index]);
    return estimate(samples);
}

std::vector<TTest> testValues(std::span<const Image> a, std::span<const Image> b) {
    std::vector<TTest> tests(a.front().data.size());
    for (std::size_t i = 0; i < tests.size(); ++i) tests[i] = welch(estimateValue(a, i), estimateValue(b, i));
    return tests;
}

std::size_t countDiscoveries(const std::vector<TTest>& tests) {
    std::vector<double> p(tests.size());
    std::transform(tests.begin(), tests.end(), p.begin(), [](const TTest& test) { return test.p; });
    return discoveries(p, kFalseDiscoveryRate).size();
}

// With equal numbers of blocks of equal variance, t has exactly Student's distribution with `dof` degrees of freedom,
// whose square has the mean dof / (dof - 2) and a variance that is finite above 4.
double spreadOf(const std::vector<TTest>& tests, std::size_t channel, std::size_t channels, double dof) {
    double sum = 0, count = 0;
    for (std::size_t i = channel; i < tests.size(); i += channels) {
        if (tests[i].dof <= 0) continue; // nothing varies there
        sum += tests[i].t * tests[i].t;
        count += 1;
    }
    if (dof < 6 || count == 0) return 0;
    const double mean = dof / (dof - 2);
    const double variance = 2 * dof * dof * (dof - 1) / ((dof - 2) * (dof - 2) * (dof - 4));
    return (sum / count - mean) / std::sqrt(variance / count);
}

void testGlobally(std::span<const Image> a, std::span<const Image> b, ImageTestResult& result) {
    const std::uint32_t whole = std::max(a.front().width, a.front().height);
    const auto meansA = shrink(a, whole), meansB = shrink(b, whole);
    const std::uint32_t channels = a.front().channels;
    for (std::uint32_t c = 0; c < channels; ++c) {
        const Estimate estimateA = estimateValue(meansA, c), estimateB = estimateValue(meansB, c);
        result.globalP = std::min(result.globalP, channels * welch(estimateA, estimateB).p);
        const double error = std::sqrt(estimateA.varianceOfMean + estimateB.varianceOfMean);
        if (estimateB.mean != 0)
            result.detectableBias = std::max(result.detectableBias, 4 * error / std::abs(estimateB.mean));
    }
}

void checkBlocks(std::span<const Image> a, std::span<const Image> b) {
    if (a.size() < 2 || b.empty())
        throw InputError("an image test needs two blocks and something to compare them with");
    const Image& first = a.front();
    for (const auto& images : {a, b})
        for (const Image& image : images)
            if (image.width != first.width || image.height != first.height || image.channels != first.channels)
                throw InputError("the images of a test differ in size");
}

} // namespace

bool ImageTestResult::passed() const {
    return globalP > kMinGlobalP && tileDiscoveries == 0 && pixelDiscoveries == 0 &&
           std::abs(spreadZ) <= kLargestSpreadZ;
}

std::string ImageTestResult::summary() const {
    std::ostringstream text;
    text << "global p " << globalP << ", tiles rejected " << tileDiscoveries << ", pixels rejected " << pixelDiscoveries
         << ", spread z " << spreadZ << ", detectable bias " << detectableBias;
    return text.str();
}

ImageTestResult testImages(std::span<const Image> a, std::span<const Image> b) {
    checkBlocks(a, b);
    ImageTestResult result;
    testGlobally(a, b, result);
    result.tileDiscoveries = countDiscoveries(testValues(shrink(a, 8), shrink(b, 8)));

    const std::vector<TTest> pixels = testValues(a, b);
    result.pixelDiscoveries = countDiscoveries(pixels);
    const std::size_t channels = a.front().channels;
    const double dof = static_cast<double>(a.size() - 1) + static_cast<double>(b.size() - 1);
    for (std::size_t c = 0; c < channels; ++c) {
        const double z = spreadOf(pixels, c, channels, dof);
        if (std::abs(z) > std::abs(result.spreadZ)) result.spreadZ = z;
    }
    result.pixelP = a.front();
    std::transform(pixels.begin(), pixels.end(), result.pixelP.data.begin(),
                   [](const TTest& test) { return static_cast<float>(test.p); });
    return result;
}

} // namespace rt::image
