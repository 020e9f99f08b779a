// OpenEXR images, read by the format's own library: any compression and channel type, scan lines or tiles, the largest
// level of several, the first part of several or a layer. Colours of other primaries and those stored as luminance and
// chroma become linear RGB with the primaries of Rec. 709.
#include <Iex.h>
#include <ImfChannelList.h>
#include <ImfChromaticitiesAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputPart.h>
#include <ImfMultiPartInputFile.h>
#include <ImfPartType.h>
#include <ImfStandardAttributes.h>
#include <ImfStringAttribute.h>
#include <ImfTileDescription.h>
#include <ImfTiledInputPart.h>
#include <algorithm>
#include <cstdint>
#include <exception>
#include <new>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "Common/Core/Error.h"
#include "Common/Core/Log.h"
#include "Common/Core/Primaries.h"
#include "Common/Core/Printable.h"
#include "Common/Image/Codecs.h"
#include "Common/Image/ColorMatrix.h"
#include "Common/Image/ExrHeader.h"
#include "Common/Image/ExrLayers.h"

namespace rt::image {

namespace {

// The bytes of a file as the library reads them.
class ByteStream : public Imf::IStream {
  public:
    explicit ByteStream(std::span<const std::byte> bytes) : IStream(kNoName), bytes_(bytes) {}

    // What there is is read before the exception: newer versions of the library ask for more than they need.
    bool read(char to[], int count) override {
        const auto rest = bytes_.subspan(std::min<std::uint64_t>(at_, bytes_.size()));
        const auto wanted = static_cast<std::size_t>(std::max(count, 0));
        const std::size_t found = std::min(wanted, rest.size());
        std::copy_n(rest.begin(), found, reinterpret_cast<std::byte*>(to));
        at_ += found;
        if (found < wanted) {
            isTruncated_ = true;
            throw Iex::InputExc("Early end of file.");
        }
        return found < rest.size();
    }
    std::uint64_t tellg() override { return at_; }
    void seekg(std::uint64_t position) override { at_ = position; }

    // Whether the library wanted bytes beyond the end.
    bool isTruncated() const { return isTruncated_; }

    static constexpr const char* kNoName = ""; // our messages begin with the name

  private:
    std::span<const std::byte> bytes_;
    std::uint64_t at_ = 0;
    bool isTruncated_ = false;
};

// The library's message without what it puts before each: what it was doing, and the name, which it is not told.
std::string reasonOf(const std::exception& error) {
    constexpr std::string_view kNameEnd = "\"\". ";
    std::string text = error.what();
    if (const std::size_t at = text.rfind(kNameEnd); at != std::string::npos) text.erase(0, at + kNameEnd.size());
    while (text.ends_with('.')) text.pop_back();
    return printable(text, kMaxExrText);
}

// read(Imf::MultiPartInputFile&) of the file; what the library throws becomes an InputError.
template <class Read>
auto readExr(std::span<const std::byte> bytes, const std::string& name, const Read& read) {
    checkExrHeaders(bytes, name);
    ByteStream stream(bytes);
    try {
        constexpr int kThreads = 0;
        constexpr bool kMendsTables = false; // a file whose table of chunks was never written is incomplete
        Imf::MultiPartInputFile file(stream, kThreads, kMendsTables);
        return read(file);
    } catch (const Error&) {
        throw;
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& error) {
        throw InputError(name + ": " +
                         (stream.isTruncated() ? "truncated EXR file" : "cannot read EXR file: " + reasonOf(error)));
    }
}

// Sizes of a part, checked before memory is taken for its pixels.
class Part {
  public:
    Part(const Imf::Header& header, const std::string& name) : header_(header), name_(name) {}

    void checkType() const {
        if (!isTiled() && header_.type() != Imf::SCANLINEIMAGE)
            fail("EXR images of type \"" + printable(header_.type(), kMaxExrText) +
                 "\" are not supported (allowed: " + Imf::SCANLINEIMAGE + ", " + Imf::TILEDIMAGE + ")");
    }

    bool isTiled() const { return header_.type() == Imf::TILEDIMAGE; }
    const Imath::Box2i& window() const { return header_.dataWindow(); }
    double width() const { return 1.0 + window().max.x - window().min.x; }
    double height() const { return 1.0 + window().max.y - window().min.y; }

    void checkSizes(std::size_t fileBytes) const {
        // Blocks of one value take a few bits in DWA, and 2 bytes before deflate compresses those.
        constexpr double kDensityOfDwa = 64;
        const Imf::Compression compression = header_.compression();
        const bool isDwa = compression == Imf::DWAA_COMPRESSION || compression == Imf::DWAB_COMPRESSION;
        const double halves = bytesPerPixel(true) * width() * height();
        checkDimensions(name_, width(), height(), isDwa ? halves / kDensityOfDwa : halves, fileBytes);

        // The library takes memory for a whole chunk, however little of it there is.
        constexpr double kUsualChunk = 64 << 20;
        const double maximum = std::max(kUsualChunk, kDensest * double(fileBytes));
        if (bytesPerPixel(false) * chunkPixels() > maximum)
            fail("truncated EXR file: chunks of more than " + std::to_string(std::int64_t(maximum)) +
                 " bytes in a file of " + std::to_string(fileBytes));
    }

    // Only chroma may have fewer pixels than the picture.
    void checkSampling(const ExrChannels& chosen) const {
        for (const std::string& channel : chosen.names) {
            const Imf::Channel& known = header_.channels()[channel];
            const bool isChroma = chosen.kind == ExrChannels::Kind::LuminanceChroma && &channel != &chosen.names[0];
            if (!isChroma && (known.xSampling != 1 || known.ySampling != 1))
                fail("EXR channel " + printable(channel, kMaxExrText) + " is subsampled, which is not supported");
        }
    }

  private:
    // Of all channels, as they are stored or as if all were of the narrowest type.
    double bytesPerPixel(bool isNarrow) const {
        double sum = 0;
        for (auto i = header_.channels().begin(); i != header_.channels().end(); ++i)
            sum +=
                (isNarrow || i.channel().type == Imf::HALF ? 2.0 : 4.0) / i.channel().xSampling / i.channel().ySampling;
        return sum;
    }
    double chunkPixels() const {
        if (isTiled()) return double(header_.tileDescription().xSize) * header_.tileDescription().ySize;
        switch (header_.compression()) {
            case Imf::NO_COMPRESSION:
            case Imf::RLE_COMPRESSION:
            case Imf::ZIPS_COMPRESSION:
                return width();
            case Imf::ZIP_COMPRESSION:
            case Imf::PXR24_COMPRESSION:
                return 16 * width();
            case Imf::PIZ_COMPRESSION:
            case Imf::B44_COMPRESSION:
            case Imf::B44A_COMPRESSION:
            case Imf::DWAA_COMPRESSION:
                return 32 * width();
            default: // DWAB, which has the most
                return 256 * width();
        }
    }
    [[noreturn]] void fail(const std::string& what) const { throw InputError(name_ + ": " + what); }

    const Imf::Header& header_;
    const std::string& name_;
};

void warnOfOtherParts(const Imf::MultiPartInputFile& file, const std::string& name) {
    std::string others;
    for (int part = 1; part < file.parts(); ++part)
        others += (others.empty() ? "\"" : ", \"") + file.header(part).name() + '"';
    if (!others.empty())
        logWarning(name + ": of several parts the first is read, \"" + file.header(0).name() +
                   "\"; left out: " + others);
}

void readPixels(Imf::MultiPartInputFile& file, const Part& part, int index, const Imf::FrameBuffer& pixels) {
    if (part.isTiled()) {
        Imf::TiledInputPart in(file, index);
        in.setFrameBuffer(pixels);
        in.readTiles(0, in.numXTiles() - 1, 0, in.numYTiles() - 1);
    } else {
        Imf::InputPart in(file, index);
        in.setFrameBuffer(pixels);
        in.readPixels(part.window().min.y, part.window().max.y);
    }
}

Primaries primariesOf(const Imf::Header& header) {
    if (!Imf::hasChromaticities(header)) return kRec709;
    const Imf::Chromaticities& c = Imf::chromaticities(header);
    const auto point = [](const Imath::V2f& v) { return glm::dvec2(v.x, v.y); };
    return {point(c.red), point(c.green), point(c.blue), point(c.white)};
}

// One channel with what it needs to be read and looked up: chroma may have one value for several pixels.
class ChannelPlane {
  public:
    ChannelPlane(const Imf::Header& header, const std::string& channel)
        : window_(header.dataWindow()),
          xSampling_(header.channels()[channel].xSampling),
          ySampling_(header.channels()[channel].ySampling),
          width_(count(window_.min.x, window_.max.x, xSampling_)),
          height_(count(window_.min.y, window_.max.y, ySampling_)),
          values_(width_ * height_) {}

    Imf::Slice slice() {
        return Imf::Slice::Make(Imf::FLOAT, values_.data(), window_, sizeof(float), sizeof(float) * width_, xSampling_,
                                ySampling_);
    }

    // Linear between the pixels that have a value, which are those at multiples of the sampling.
    float at(std::uint32_t x, std::uint32_t y) const {
        const Place across = place(x, xSampling_, width_), down = place(y, ySampling_, height_);
        const float* const upper = &values_[down.first * width_];
        const float* const lower = &values_[down.second * width_];
        const auto between = [&](const float* row) {
            return row[across.first] + (row[across.second] - row[across.first]) * across.part;
        };
        return between(upper) + (between(lower) - between(upper)) * down.part;
    }

  private:
    struct Place {
        std::size_t first, second;
        float part; // of the way from the first to the second
    };
    static std::size_t count(int minimum, int maximum, int sampling) {
        return static_cast<std::size_t>((std::int64_t{maximum} - minimum) / sampling + 1);
    }
    static Place place(std::uint32_t i, int sampling, std::size_t count) {
        const auto step = static_cast<std::uint32_t>(sampling);
        const std::size_t first = std::min<std::size_t>(i / step, count - 1);
        return {first, std::min(first + 1, count - 1), float(i % step) / float(step)};
    }

    Imath::Box2i window_;
    int xSampling_, ySampling_;
    std::size_t width_, height_;
    std::vector<float> values_;
};

// RY = (R - Y) / Y and BY = (B - Y) / Y, with Y by the primaries of the file.
Image readLuminanceChroma(Imf::MultiPartInputFile& file, const Part& part, const ExrChannels& chosen,
                          const glm::dmat3& toXyz) {
    const Imf::Header& header = file.header(chosen.part);
    ChannelPlane planes[] = {{header, chosen.names[0]}, {header, chosen.names[1]}, {header, chosen.names[2]}};
    Imf::FrameBuffer pixels;
    for (std::size_t i = 0; i < 3; ++i) pixels.insert(chosen.names[i], planes[i].slice());
    readPixels(file, part, chosen.part, pixels);

    Image image(static_cast<std::uint32_t>(part.width()), static_cast<std::uint32_t>(part.height()));
    for (std::uint32_t y = 0; y < image.height; ++y)
        for (std::uint32_t x = 0; x < image.width; ++x) {
            const double luminance = planes[0].at(x, y);
            const double red = (double(planes[1].at(x, y)) + 1) * luminance;
            const double blue = (double(planes[2].at(x, y)) + 1) * luminance;
            const double green = (luminance - toXyz[0][1] * red - toXyz[2][1] * blue) / toXyz[1][1];
            float* const pixel = image.pixel(x, y);
            pixel[0] = static_cast<float>(red);
            pixel[1] = static_cast<float>(green);
            pixel[2] = static_cast<float>(blue);
        }
    return image;
}

Image readChannels(Imf::MultiPartInputFile& file, const Part& part, const ExrChannels& chosen) {
    Image image(static_cast<std::uint32_t>(part.width()), static_cast<std::uint32_t>(part.height()),
                static_cast<std::uint32_t>(chosen.names.size()));
    const std::size_t pixelBytes = chosen.names.size() * sizeof(float);
    Imf::FrameBuffer pixels;
    for (std::size_t c = 0; c < chosen.names.size(); ++c)
        pixels.insert(chosen.names[c], Imf::Slice::Make(Imf::FLOAT, image.data.data() + c, part.window(), pixelBytes,
                                                        pixelBytes * image.width));
    readPixels(file, part, chosen.part, pixels);
    return image;
}

Image readLayer(Imf::MultiPartInputFile& file, const std::string& layer, std::size_t fileBytes,
                const std::string& name) {
    if (layer.empty()) Part(file.header(0), name).checkType();
    const ExrChannels chosen = chooseExrChannels(file, layer, name);
    const Imf::Header& header = file.header(chosen.part);
    const Part part(header, name);
    part.checkType();
    part.checkSizes(fileBytes);
    part.checkSampling(chosen);
    if (layer.empty()) warnOfOtherParts(file, name);
    if (chosen.kind == ExrChannels::Kind::Other) return readChannels(file, part, chosen);

    const Primaries primaries = primariesOf(header);
    const std::optional<glm::dmat3> xyz = toXyz(primaries);
    const bool isLuminanceChroma = chosen.kind == ExrChannels::Kind::LuminanceChroma;
    if (!xyz || (isLuminanceChroma && !((*xyz)[1][1] > 0)))
        throw InputError(name + ": EXR attribute chromaticities: primaries that span no colours");
    Image image = isLuminanceChroma ? readLuminanceChroma(file, part, chosen, *xyz) : readChannels(file, part, chosen);
    if (!areSame(primaries, kRec709)) multiplyColors(image, xyzToRec709() * *xyz);
    return image;
}

} // namespace

Image decodeExr(std::span<const std::byte> bytes, const std::string& name, const std::string& layer) {
    return readExr(bytes, name,
                   [&](Imf::MultiPartInputFile& file) { return readLayer(file, layer, bytes.size(), name); });
}

std::vector<std::string> findExrLayers(std::span<const std::byte> bytes, const std::string& name) {
    return readExr(bytes, name, [](const Imf::MultiPartInputFile& file) { return exrLayers(file); });
}

std::optional<std::string> findExrText(std::span<const std::byte> bytes, const std::string& name) {
    return readExr(bytes, name, [](const Imf::MultiPartInputFile& file) -> std::optional<std::string> {
        const auto* text = file.header(0).findTypedAttribute<Imf::StringAttribute>(kDescriptionKey);
        return text ? std::optional(text->value()) : std::nullopt;
    });
}

} // namespace rt::image
