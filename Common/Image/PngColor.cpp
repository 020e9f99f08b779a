// Chunks of a PNG before its pixels: length, type, data, sum. cICP overrides all others, then sRGB, and iCCP overrides
// gAMA and cHRM.
#include "Common/Image/PngColor.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <sstream>
#include <string_view>

#include "Common/Core/Primaries.h"
#include "Common/Core/Printable.h"

namespace rt::image {

namespace {

constexpr std::size_t kPngSignature = 8, kChunkHead = 8, kChunkSum = 4;
constexpr std::size_t kMaxName = 80; // bytes of a profile's name that are shown

std::uint32_t numberAt(std::span<const std::byte> bytes, std::size_t at) {
    std::uint32_t value = 0;
    for (std::size_t i = at; i < at + 4; ++i) value = value << 8 | std::to_integer<std::uint32_t>(bytes[i]);
    return value;
}

std::string profileName(std::span<const std::byte> data) {
    const auto end = std::find(data.begin(), data.end(), std::byte{0});
    return {reinterpret_cast<const char*>(data.data()), static_cast<std::size_t>(end - data.begin())};
}

// The power by which the file's values were encoded; that of sRGB on the whole is 1 / 2.2.
std::optional<std::string> otherGamma(std::span<const std::byte> data) {
    constexpr double kUnit = 1e-5, kUsual = 1 / 2.2, kRounding = 5e-3;
    const double gamma = data.size() == 4 ? kUnit * numberAt(data, 0) : kUsual;
    if (!(gamma > 0) || std::abs(gamma - kUsual) <= kRounding) return std::nullopt;
    std::ostringstream text;
    text << "gamma " << gamma << " (gAMA)";
    return text.str();
}

std::optional<std::string> otherPrimaries(std::span<const std::byte> data) {
    constexpr double kUnit = 1e-5;
    if (data.size() != 32) return std::nullopt;
    const auto point = [&](std::size_t i) {
        return glm::dvec2(kUnit * numberAt(data, 8 * i), kUnit * numberAt(data, 8 * i + 4));
    };
    const Primaries primaries{point(1), point(2), point(3), point(0)};
    return areSame(primaries, kRec709) ? std::nullopt : std::optional<std::string>("primaries of its own (cHRM)");
}

// By the numbers of ITU-T H.273 for primaries and transfer function.
std::optional<std::string> otherSpace(std::span<const std::byte> data) {
    constexpr std::byte kRec709Primaries{1}, kSrgbTransfer{13};
    if (data[0] == kRec709Primaries && data[1] == kSrgbTransfer) return std::nullopt;
    return "the colour space " + std::to_string(std::to_integer<int>(data[0])) + "/" +
           std::to_string(std::to_integer<int>(data[1])) + " of H.273 (cICP)";
}

} // namespace

std::optional<std::string> otherColorsOfPng(std::span<const std::byte> bytes) {
    if (bytes.size() < kPngSignature || std::memcmp(bytes.data(), "\x89PNG\r\n\x1a\n", kPngSignature) != 0)
        return std::nullopt;
    std::optional<std::string> profile, gamma, primaries;
    bool isSrgb = false;
    for (std::size_t at = kPngSignature; bytes.size() - at >= kChunkHead + kChunkSum;) {
        const std::size_t length = numberAt(bytes, at);
        if (length > bytes.size() - at - kChunkHead - kChunkSum) break;
        const std::string_view type(reinterpret_cast<const char*>(&bytes[at + 4]), 4);
        const std::span<const std::byte> data = bytes.subspan(at + kChunkHead, length);
        if (type == "IDAT") break;
        if (type == "cICP" && data.size() == 4) return otherSpace(data);
        if (type == "sRGB") isSrgb = true;
        if (type == "iCCP") profile = profileName(data);
        if (type == "gAMA") gamma = otherGamma(data);
        if (type == "cHRM") primaries = otherPrimaries(data);
        at += kChunkHead + length + kChunkSum;
    }
    if (isSrgb) return std::nullopt;
    if (profile) {
        if (profile->starts_with("sRGB")) return std::nullopt;
        return "the colour profile \"" + printable(*profile, kMaxName) + "\" (iCCP)";
    }
    if (gamma && primaries) return *gamma + " and " + *primaries;
    return gamma ? gamma : primaries;
}

} // namespace rt::image
