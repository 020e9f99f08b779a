// OpenEXR files of many kinds, written into memory by the format's library.
#pragma once
#include <ImfChannelList.h>
#include <ImfDeepFrameBuffer.h>
#include <ImfDeepScanLineOutputFile.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfMultiPartOutputFile.h>
#include <ImfOutputFile.h>
#include <ImfOutputPart.h>
#include <ImfPartType.h>
#include <ImfStdIO.h>
#include <ImfTiledOutputFile.h>
#include <algorithm>
#include <cstring>
#include <optional>
#include <string>
#include <vector>

#include "Common/Image/Image.h"

namespace rt::test {

struct ExrKind {
    std::vector<std::string> channels = {"R", "G", "B"}; // as many as the image has
    Imf::PixelType type = Imf::FLOAT;
    Imf::Compression compression = Imf::NO_COMPRESSION;
    Imf::LineOrder lineOrder = Imf::INCREASING_Y;
    Imath::V2i origin = {0, 0};                // of the data window; the display window begins at (0, 0)
    std::optional<Imf::LevelMode> levels = {}; // with tiles of 8 x 8 pixels; those behind the first level hold 99
};

constexpr std::size_t exrPixelBytes(Imf::PixelType type) {
    return type == Imf::HALF ? 2 : 4;
}

// The image in the type of the file, one channel after the other.
inline std::vector<char> exrPlanes(const image::Image& image, Imf::PixelType type) {
    std::vector<char> bytes;
    for (std::uint32_t c = 0; c < image.channels; ++c)
        for (std::size_t i = c; i < image.data.size(); i += image.channels) {
            const float value = image.data[i];
            const half narrow(value);
            const auto whole = static_cast<std::uint32_t>(value);
            const void* const from = type == Imf::HALF    ? static_cast<const void*>(&narrow)
                                     : type == Imf::FLOAT ? static_cast<const void*>(&value)
                                                          : &whole;
            bytes.resize(bytes.size() + exrPixelBytes(type));
            std::memcpy(bytes.data() + bytes.size() - exrPixelBytes(type), from, exrPixelBytes(type));
        }
    return bytes;
}

inline Imf::Header exrHeader(const image::Image& image, const ExrKind& kind) {
    const auto width = static_cast<int>(image.width), height = static_cast<int>(image.height);
    const Imath::Box2i data(kind.origin, kind.origin + Imath::V2i(width - 1, height - 1));
    Imf::Header header(Imath::Box2i({0, 0}, {width + 3, height + 5}), data);
    header.compression() = kind.compression;
    header.lineOrder() = kind.lineOrder;
    for (const std::string& name : kind.channels) header.channels().insert(name, Imf::Channel(kind.type));
    if (kind.levels) header.setTileDescription(Imf::TileDescription(8, 8, *kind.levels));
    return header;
}

inline Imf::FrameBuffer exrSlices(const image::Image& image, const ExrKind& kind, const std::vector<char>& planes) {
    const std::size_t bytes = exrPixelBytes(kind.type), pixels = std::size_t{image.width} * image.height;
    Imf::FrameBuffer slices;
    for (std::size_t c = 0; c < kind.channels.size(); ++c)
        slices.insert(kind.channels[c],
                      Imf::Slice::Make(kind.type, planes.data() + c * pixels * bytes,
                                       exrHeader(image, kind).dataWindow(), bytes, bytes * image.width));
    return slices;
}

inline void writeExrTiles(Imf::OStream& out, const image::Image& image, const ExrKind& kind) {
    image::Image other = image;
    std::fill(other.data.begin(), other.data.end(), 99.0f);
    const std::vector<char> first = exrPlanes(image, kind.type), others = exrPlanes(other, kind.type);
    Imf::TiledOutputFile file(out, exrHeader(image, kind), 0);
    for (int y = 0; y < file.numYLevels(); ++y)
        for (int x = 0; x < file.numXLevels(); ++x) {
            if (!file.isValidLevel(x, y)) continue;
            file.setFrameBuffer(exrSlices(image, kind, x == 0 && y == 0 ? first : others));
            file.writeTiles(0, file.numXTiles(x) - 1, 0, file.numYTiles(y) - 1, x, y);
        }
}

inline std::string exrFile(const image::Image& image, const ExrKind& kind = {}) {
    Imf::StdOSStream out;
    if (kind.levels) {
        writeExrTiles(out, image, kind);
    } else {
        const std::vector<char> planes = exrPlanes(image, kind.type);
        Imf::OutputFile file(out, exrHeader(image, kind), 0);
        file.setFrameBuffer(exrSlices(image, kind, planes));
        file.writePixels(static_cast<int>(image.height));
    }
    return out.str();
}

// Of parts "a", "b" and so on.
inline std::string exrFileOfParts(const std::vector<image::Image>& images, const ExrKind& kind = {}) {
    std::vector<Imf::Header> headers;
    for (const image::Image& image : images) {
        headers.push_back(exrHeader(image, kind));
        headers.back().displayWindow() = Imath::Box2i({0, 0}, {9, 9}); // the same in all parts
        headers.back().setName(std::string(1, static_cast<char>('a' + headers.size() - 1)));
        headers.back().setType(Imf::SCANLINEIMAGE);
    }
    Imf::StdOSStream out;
    {
        Imf::MultiPartOutputFile file(out, headers.data(), static_cast<int>(headers.size()), false, 0);
        for (std::size_t i = 0; i < images.size(); ++i) {
            const std::vector<char> planes = exrPlanes(images[i], kind.type);
            Imf::OutputPart part(file, static_cast<int>(i));
            part.setFrameBuffer(exrSlices(images[i], kind, planes));
            part.writePixels(static_cast<int>(images[i].height));
        }
    }
    return out.str();
}

// A deep image of one pixel without samples.
inline std::string deepExrFile() {
    Imf::Header header(1, 1);
    header.compression() = Imf::ZIPS_COMPRESSION;
    header.setType(Imf::DEEPSCANLINE);
    header.channels().insert("R", Imf::Channel(Imf::FLOAT));
    std::uint32_t count = 0;
    float* samples = nullptr;
    Imf::DeepFrameBuffer slices;
    slices.insertSampleCountSlice(Imf::Slice(Imf::UINT, reinterpret_cast<char*>(&count), sizeof count, 0));
    slices.insert("R", Imf::DeepSlice(Imf::FLOAT, reinterpret_cast<char*>(&samples), sizeof samples, 0, sizeof(float)));
    Imf::StdOSStream out;
    {
        Imf::DeepScanLineOutputFile file(out, header, 0);
        file.setFrameBuffer(slices);
        file.writePixels(1);
    }
    return out.str();
}

} // namespace rt::test
