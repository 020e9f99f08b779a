// Image files. In memory everything is linear; the extension of the name, in any case, decides the format:
//   .png                    8 bits, sRGB-encoded, display-referred: [0,1] is what a screen can show
//   .exr .pfm               linear, 32-bit float, bit for bit; of an .exr of others also half and uint, any compression,
//                           tiles (the largest level), layers, other primaries, luminance with chroma, and the first
//                           of several parts, with a warning of the others
//   .hdr                    linear, shared exponent: 8 significant bits, nothing negative; of others also with
//                           exposure, colour correction and primaries, and XYZ
//   .jpg .jpeg .bmp .tga    like .png, read only
//   .tif .tiff .webp        the same, where the build had libtiff and libwebp; floats in .tif are linear
#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "Common/Image/ImageRows.h"

namespace rt::image {

// Texels as they are stored: exactly one of the first three vectors holds width * height * 3 values, rows from the top.
struct Texels {
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    std::vector<std::uint8_t> srgb8;    // sRGB-encoded RGB
    std::vector<std::uint16_t> srgb16;  // the same of a PNG with 16 bits a channel
    std::vector<float> linear;          // RGB
    std::vector<std::uint8_t> alpha8;   // beside srgb8: one value a texel; empty: all are opaque
    std::vector<std::uint16_t> alpha16; // beside srgb16: one value a texel; empty: all are opaque
};

// Throws InputError, naming the file and what is wrong, for a missing, damaged, truncated or unknown one. Three
// channels, or one where a PFM file has just one or an EXR file has Y but not R, G and B. Values are as in the file,
// infinities and NaN included. `layer`: of an EXR file, what its channels are called before a dot, or a part, or a
// single channel.
Image readImage(const std::filesystem::path& path, const std::string& layer = {});

// Layers by which readImage can be asked for others than the picture; none of formats without any.
std::vector<std::string> readLayers(const std::filesystem::path& path);

// The same for textures, always with three channels; values that are not finite are an error, negative ones become 0.
Texels loadTexels(const std::filesystem::path& path);

// In two steps, of which the second may be on another thread: the bytes of a file, and what they hold.
std::vector<std::byte> readTexels(const std::filesystem::path& path);
Texels decodeTexels(std::span<const std::byte> bytes, const std::filesystem::path& path);

// Of a PNG or JPEG in memory; errors name it `name`.
Texels decodeTexels(std::span<const std::byte> bytes, const std::string& name);

// Texels of a PNG or JPEG as its header says, at most what the bytes can hold; 0 for others.
std::size_t texelCount(std::span<const std::byte> bytes);

// Writes 1 or 3 channels, a row at a time, replacing the file atomically. NaN is written as 0 and an infinity, or what
// a format cannot hold, as the nearest value that it can. Throws UsageError for an extension that is unknown,
// RenderError when writing fails or memory for a few rows cannot be had. `description` is kept in a PNG (as iTXt
// "ray-tracing") and an EXR (attribute of that name), and left out elsewhere.
void writeImage(const std::filesystem::path& path, const ImageRows& image, const std::string& description = {});

// Texels of 8 bits, sRGB-encoded, 3 channels or 4 with opacity, rows from the top, as a PNG in memory.
std::vector<std::byte> toPng(std::uint32_t width, std::uint32_t height, std::uint32_t channels,
                             const std::vector<std::uint8_t>& texels);

// What writeImage was given as description; nothing where the file holds none. Throws InputError as readImage does.
std::optional<std::string> readDescription(const std::filesystem::path& path);

// Throws the UsageError of writeImage beforehand, so that a long render does not end with it.
void checkWritable(const std::filesystem::path& path);

// Whether writeImage takes what a screen shows rather than linear radiance. Throws like checkWritable.
bool isDisplayReferred(const std::filesystem::path& path);

} // namespace rt::image
