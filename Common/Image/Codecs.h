// Encoders and decoders of single formats, for ImageIo. Decoders throw InputError naming `name`; they allocate no more
// than the bytes at hand can fill, whatever the header claims (EXR: or a few times a chunk of 64 MiB). Encoders expect
// finite values, and hold no more than a few rows in memory; whether `out` took it all is asked of that.
#pragma once
#include <cstddef>
#include <iosfwd>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "Common/Image/ImageIo.h"
#include "Common/Image/ImageRows.h"

namespace rt::image {

inline constexpr const char* kDescriptionKey = "ray-tracing"; // under which PNG and EXR keep a description

inline constexpr double kDensest = 1100; // bytes from one: deflate reaches 1032

// Throws unless both sides are in 1 to 65536 and `fileBytes` can hold `decodedBytes` in the densest compression there
// is.
void checkDimensions(const std::string& name, double width, double height, double decodedBytes, std::size_t fileBytes);

// What readImage does with the bytes of a file of that name.
Image decodeImage(std::span<const std::byte> bytes, const std::filesystem::path& path, const std::string& layer = {});

// What readDescription finds in a PNG or EXR of that name.
std::optional<std::string> findDescription(std::span<const std::byte> bytes, const std::filesystem::path& path);

Image decodePfm(std::span<const std::byte> bytes, const std::string& name);
void encodePfm(const ImageRows& rows, std::ostream& out);

Image decodeExr(std::span<const std::byte> bytes, const std::string& name, const std::string& layer = {});
std::vector<std::string> findExrLayers(std::span<const std::byte> bytes, const std::string& name);
void encodeExr(const ImageRows& rows, std::ostream& out, const std::string& description = {});
std::optional<std::string> findExrText(std::span<const std::byte> bytes, const std::string& name); // its description

Image decodeHdr(std::span<const std::byte> bytes, const std::string& name);
void encodeHdr(const ImageRows& rows, std::ostream& out);

// The pixels that a header claims; 0 where there is none.
bool isJpeg(std::span<const std::byte> bytes); // by its first bytes
double jpegPixels(std::span<const std::byte> bytes);
double stbPixels(std::span<const std::byte> bytes);

// sRGB. A JPEG has no opacity; one of four inks without a profile is taken for light through all of them.
Texels decodeJpeg(std::span<const std::byte> bytes, const std::string& name);
Texels decodeStb(std::span<const std::byte> bytes, const std::string& name); // PNG, BMP, TGA

bool isTiff(std::span<const std::byte> bytes); // by its first bytes
bool isWebP(std::span<const std::byte> bytes);
Texels decodeTiff(std::span<const std::byte> bytes, const std::string& name); // sRGB, or linear of floats
Texels decodeWebP(std::span<const std::byte> bytes, const std::string& name);

void encodePng(const ImageRows& rows, std::ostream& out, const std::string& description = {});

} // namespace rt::image
