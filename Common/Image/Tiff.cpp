// TIFF, read by libtiff where it was there when this was built: the first picture of a file. Rows of grey or RGB are
// read as they are; what is stored otherwise is converted by the library, to 8 bits. Integers are taken for sRGB, floats
// for linear.
#include <algorithm>
#include <cstdint>
#include <string>

#include "Common/Core/Error.h"
#include "Common/Core/Printable.h"
#include "Common/Image/Codecs.h"

#ifdef RT_HAS_TIFF
#include <cstdarg>
#include <cstdio>
#include <cstring>
#include <limits>
#include <memory>
#include <tiffio.h>
#include <vector>
#endif

namespace rt::image {

bool isTiff(std::span<const std::byte> bytes) {
    if (bytes.size() < 4) return false;
    const std::string begin(reinterpret_cast<const char*>(bytes.data()), 4);
    return begin == std::string("II*\0", 4) || begin == std::string("MM\0*", 4) || begin == std::string("II+\0", 4) ||
           begin == std::string("MM\0+", 4);
}

#ifndef RT_HAS_TIFF

Texels decodeTiff(std::span<const std::byte>, const std::string& name) {
    throw InputError(name + ": TIFF files are not supported by this build, which had no libtiff");
}

#else

namespace {

constexpr std::size_t kMaxText = 200;               // bytes of the library's messages that are shown
constexpr double kUsualPixels = 64.0 * 1024 * 1024; // bytes of pixels that any file may ask for

// The bytes as the library reads them, and the first of its messages.
struct TiffSource {
    std::span<const std::byte> bytes;
    std::size_t at = 0;
    std::string message;
};

TiffSource& sourceOf(thandle_t handle) {
    return *static_cast<TiffSource*>(handle);
}

tmsize_t readTiff(thandle_t handle, void* to, tmsize_t count) {
    TiffSource& source = sourceOf(handle);
    const std::size_t left = source.bytes.size() - std::min(source.at, source.bytes.size());
    const std::size_t taken = std::min(left, static_cast<std::size_t>(std::max<tmsize_t>(count, 0)));
    if (taken > 0) std::memcpy(to, source.bytes.data() + source.at, taken);
    source.at += taken;
    return static_cast<tmsize_t>(taken);
}

tmsize_t writeNothing(thandle_t, void*, tmsize_t) {
    return 0;
}

toff_t seekTiff(thandle_t handle, toff_t offset, int whence) {
    TiffSource& source = sourceOf(handle);
    const std::size_t base = whence == SEEK_CUR ? source.at : whence == SEEK_END ? source.bytes.size() : 0;
    source.at = static_cast<std::size_t>(base + offset);
    return source.at;
}

int closeNothing(thandle_t) {
    return 0;
}

toff_t tiffSize(thandle_t handle) {
    return sourceOf(handle).bytes.size();
}

// For the library, which has no maps of memory then.
int mapNothing(thandle_t, void**, toff_t*) {
    return 0;
}

void unmapNothing(thandle_t, void*, toff_t) {}

int keepMessage(TIFF*, void* user, const char*, const char* format, va_list arguments) {
    char text[kMaxText];
    std::vsnprintf(text, sizeof text, format, arguments);
    std::string& message = static_cast<TiffSource*>(user)->message;
    if (message.empty()) message = text;
    return 1; // handled
}

int ignoreMessage(TIFF*, void*, const char*, const char*, va_list) {
    return 1;
}

struct CloseTiff {
    void operator()(TIFF* file) const { TIFFClose(file); }
};
using TiffFile = std::unique_ptr<TIFF, CloseTiff>;

TiffFile openTiff(TiffSource& source) {
    const std::unique_ptr<TIFFOpenOptions, void (*)(TIFFOpenOptions*)> options(TIFFOpenOptionsAlloc(),
                                                                               TIFFOpenOptionsFree);
    const double maximum = std::max(kUsualPixels, 16 * double(source.bytes.size()));
    TIFFOpenOptionsSetMaxSingleMemAlloc(options.get(), static_cast<tmsize_t>(maximum));
    TIFFOpenOptionsSetErrorHandlerExtR(options.get(), keepMessage, &source);
    TIFFOpenOptionsSetWarningHandlerExtR(options.get(), ignoreMessage, nullptr);
    constexpr const char* kOnlyRead = "rm"; // without maps of memory
    return TiffFile(TIFFClientOpenExt("", kOnlyRead, &source, readTiff, writeNothing, seekTiff, closeNothing, tiffSize,
                                      mapNothing, unmapNothing, options.get()));
}

class TiffReader {
  public:
    TiffReader(TIFF* file, TiffSource& source, const std::string& name) : file_(file), source_(source), name_(name) {}

    Texels read() {
        std::uint32_t width = 0, height = 0;
        TIFFGetField(file_, TIFFTAG_IMAGEWIDTH, &width);
        TIFFGetField(file_, TIFFTAG_IMAGELENGTH, &height);
        bits_ = field(TIFFTAG_BITSPERSAMPLE);
        samples_ = field(TIFFTAG_SAMPLESPERPIXEL);
        format_ = field(TIFFTAG_SAMPLEFORMAT);
        const double bytes = double(std::max(bits_ / 8u, 1u)) * std::max<unsigned>(samples_, 4) * width * height;
        checkDimensions(name_, width, height, std::max(bytes - kUsualPixels, 0.0), source_.bytes.size());
        texels_.width = width;
        texels_.height = height;
        alpha_ = alphaKind();
        if (format_ == SAMPLEFORMAT_IEEEFP) {
            if (!isPlain() || bits_ != 32)
                fail("TIFF files of floats are supported with 32 bits, as grey or RGB, in rows");
            readRows<float>(texels_.linear, nullptr);
        } else if (isPlain() && bits_ == 16) {
            readRows(texels_.srgb16, &texels_.alpha16);
        } else if (isPlain() && bits_ == 8) {
            readRows(texels_.srgb8, &texels_.alpha8);
        } else {
            readConverted();
        }
        return std::move(texels_);
    }

  private:
    std::uint16_t field(std::uint32_t tag) const {
        std::uint16_t value = 0;
        TIFFGetFieldDefaulted(file_, tag, &value);
        return value;
    }

    // EXTRASAMPLE_...; that of the sample behind the colour.
    std::uint16_t alphaKind() const {
        std::uint16_t count = 0, *kinds = nullptr;
        TIFFGetFieldDefaulted(file_, TIFFTAG_EXTRASAMPLES, &count, &kinds);
        return count > 0 && kinds != nullptr ? kinds[0] : std::uint16_t{EXTRASAMPLE_UNSPECIFIED};
    }

    // Grey or RGB, pixel by pixel, in rows from the top.
    bool isPlain() const {
        const std::uint16_t photometric = field(TIFFTAG_PHOTOMETRIC);
        const bool isGrey = photometric == PHOTOMETRIC_MINISBLACK && samples_ >= 1;
        const bool isColor = photometric == PHOTOMETRIC_RGB && samples_ >= 3;
        constexpr std::uint16_t kMaxSamples = 16;
        return (isGrey || isColor) && samples_ <= kMaxSamples && !TIFFIsTiled(file_) &&
               field(TIFFTAG_ORIENTATION) == ORIENTATION_TOPLEFT &&
               (samples_ == 1 || field(TIFFTAG_PLANARCONFIG) == PLANARCONFIG_CONTIG);
    }

    // `alphas`: null where opacity is left out.
    template <typename T>
    void readRows(std::vector<T>& colors, std::vector<T>* alphas) {
        const std::size_t values = std::size_t{texels_.width} * samples_;
        if (TIFFScanlineSize64(file_) != values * sizeof(T)) fail("damaged TIFF file: the size of its rows");
        const std::size_t colorSamples = field(TIFFTAG_PHOTOMETRIC) == PHOTOMETRIC_RGB ? 3 : 1;
        const bool hasAlpha = alphas != nullptr && samples_ > colorSamples && alpha_ != EXTRASAMPLE_UNSPECIFIED;
        std::vector<T> row(values);
        for (std::uint32_t y = 0; y < texels_.height; ++y) {
            if (TIFFReadScanline(file_, row.data(), y) < 0) failAsLibrary();
            for (std::size_t pixel = 0; pixel < values; pixel += samples_) {
                const T alpha = hasAlpha ? row[pixel + colorSamples] : T{};
                for (std::size_t c = 0; c < 3; ++c) {
                    const T value = row[pixel + (colorSamples == 3 ? c : 0)];
                    const bool isMultiplied = hasAlpha && alpha_ == EXTRASAMPLE_ASSOCALPHA;
                    colors.push_back(isMultiplied ? divided(value, alpha) : value);
                }
                if (hasAlpha) alphas->push_back(alpha);
            }
        }
    }

    // A colour without the opacity that it was multiplied by.
    template <typename T>
    static T divided(T color, T alpha) {
        if (!(alpha > T{})) return T{};
        const double maximum = double(std::numeric_limits<T>::max());
        return static_cast<T>(std::min(double(color) / double(alpha) * maximum + 0.5, maximum));
    }

    // By the library, which multiplies colours by opacity.
    void readConverted() {
        std::vector<std::uint32_t> pixels(std::size_t{texels_.width} * texels_.height);
        constexpr int kStopOnError = 1;
        if (TIFFReadRGBAImageOriented(file_, texels_.width, texels_.height, pixels.data(), ORIENTATION_TOPLEFT,
                                      kStopOnError) == 0)
            failAsLibrary();
        const bool hasAlpha = alpha_ != EXTRASAMPLE_UNSPECIFIED;
        texels_.srgb8.reserve(3 * pixels.size());
        for (const std::uint32_t pixel : pixels) {
            const auto alpha = static_cast<std::uint8_t>(TIFFGetA(pixel));
            for (const std::uint32_t value : {TIFFGetR(pixel), TIFFGetG(pixel), TIFFGetB(pixel)}) {
                const auto color = static_cast<std::uint8_t>(value);
                texels_.srgb8.push_back(hasAlpha ? divided(color, alpha) : color);
            }
            if (hasAlpha) texels_.alpha8.push_back(alpha);
        }
    }

    [[noreturn]] void fail(const std::string& what) const { throw InputError(name_ + ": " + what); }
    [[noreturn]] void failAsLibrary() const {
        fail("cannot read TIFF file: " + (source_.message.empty() ? "damaged" : printable(source_.message, kMaxText)));
    }

    TIFF* file_;
    TiffSource& source_;
    const std::string& name_;
    std::uint16_t bits_ = 0, samples_ = 0, format_ = 0, alpha_ = 0;
    Texels texels_;
};

} // namespace

Texels decodeTiff(std::span<const std::byte> bytes, const std::string& name) {
    TiffSource source{bytes, 0, {}};
    const TiffFile file = openTiff(source);
    if (!file)
        throw InputError(name + ": cannot read TIFF file: " +
                         (source.message.empty() ? "damaged" : printable(source.message, kMaxText)));
    return TiffReader(file.get(), source, name).read();
}

#endif

} // namespace rt::image
