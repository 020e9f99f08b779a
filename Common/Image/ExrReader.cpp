// OpenEXR images, read by the format's own library: any compression and channel type, scan lines or tiles, the largest
// level of several, the first part of several.
#include <Iex.h>
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputPart.h>
#include <ImfMultiPartInputFile.h>
#include <ImfPartType.h>
#include <ImfStringAttribute.h>
#include <ImfTileDescription.h>
#include <ImfTiledInputPart.h>
#include <algorithm>
#include <cstdint>
#include <exception>
#include <new>
#include <string_view>

#include "Common/Core/Error.h"
#include "Common/Core/Log.h"
#include "Common/Core/Printable.h"
#include "Common/Image/Codecs.h"
#include "Common/Image/ExrHeader.h"

namespace rt::image {

namespace {

constexpr std::size_t kMaxText = 200; // bytes of names in files and of the library's messages that are shown

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
    return printable(text, kMaxText);
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
    Part(const Imf::Header& header, const std::string& name) : header_(header), name_(name) {
        if (!isTiled() && header.type() != Imf::SCANLINEIMAGE)
            fail("EXR images of type \"" + printable(header.type(), kMaxText) +
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

    // R, G, B, or else Y alone; throws when there is neither.
    std::string chooseChannels() const {
        const Imf::ChannelList& channels = header_.channels();
        const bool isColour = has("R") && has("G") && has("B");
        const std::string chosen = isColour ? "RGB" : "Y";
        if (!isColour && !has("Y")) fail("EXR file has neither channels R, G, B nor Y (it has: " + names() + ")");
        for (const char name : chosen)
            if (const Imf::Channel& channel = channels[std::string(1, name)];
                channel.xSampling != 1 || channel.ySampling != 1)
                fail(std::string("EXR channel ") + name + " is subsampled, which is not supported");
        if (!isColour && (has("RY") || has("BY")))
            logWarning(name_ + ": luminance alone is read (channel Y); the colour of channels RY and BY is left out");
        return chosen;
    }

  private:
    bool has(const char* channel) const { return header_.channels().findChannel(channel) != nullptr; }
    std::string names() const {
        std::string list;
        for (auto i = header_.channels().begin(); i != header_.channels().end(); ++i)
            list += (list.empty() ? "" : ", ") + std::string(i.name());
        return printable(list, kMaxText);
    }
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

Image readPart(Imf::MultiPartInputFile& file, std::size_t fileBytes, const std::string& name) {
    const Part part(file.header(0), name);
    part.checkSizes(fileBytes);
    const std::string channels = part.chooseChannels();
    warnOfOtherParts(file, name);

    Image image(static_cast<std::uint32_t>(part.width()), static_cast<std::uint32_t>(part.height()),
                static_cast<std::uint32_t>(channels.size()));
    const std::size_t pixelBytes = channels.size() * sizeof(float);
    Imf::FrameBuffer pixels;
    for (std::size_t c = 0; c < channels.size(); ++c)
        pixels.insert(std::string(1, channels[c]), Imf::Slice::Make(Imf::FLOAT, image.data.data() + c, part.window(),
                                                                    pixelBytes, pixelBytes * image.width));
    if (part.isTiled()) {
        Imf::TiledInputPart in(file, 0);
        in.setFrameBuffer(pixels);
        in.readTiles(0, in.numXTiles() - 1, 0, in.numYTiles() - 1);
    } else {
        Imf::InputPart in(file, 0);
        in.setFrameBuffer(pixels);
        in.readPixels(part.window().min.y, part.window().max.y);
    }
    return image;
}

} // namespace

Image decodeExr(std::span<const std::byte> bytes, const std::string& name) {
    return readExr(bytes, name, [&](Imf::MultiPartInputFile& file) { return readPart(file, bytes.size(), name); });
}

std::optional<std::string> findExrText(std::span<const std::byte> bytes, const std::string& name) {
    return readExr(bytes, name, [](const Imf::MultiPartInputFile& file) -> std::optional<std::string> {
        const auto* text = file.header(0).findTypedAttribute<Imf::StringAttribute>(kDescriptionKey);
        return text ? std::optional(text->value()) : std::nullopt;
    });
}

} // namespace rt::image
