// BMP files compressed by runs, which stb does not read.
#pragma once
#include <cstddef>
#include <span>
#include <string>

#include "Common/Image/ImageIo.h"

namespace rt::image {

// Whether a BMP file ends within its header, of which stb takes what is missing for zeros.
bool endsInBmpHeader(std::span<const std::byte> bytes);

// By the header: BI_RLE8 or BI_RLE4.
bool isRunLengthBmp(std::span<const std::byte> bytes);

// Pixels that the header of such a file claims.
double runLengthBmpPixels(std::span<const std::byte> bytes);

// As decodeStb.
Texels decodeRunLengthBmp(std::span<const std::byte> bytes, const std::string& name);

} // namespace rt::image
