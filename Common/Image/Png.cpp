// PNG, written row by row by libpng: 8 bits, sRGB-encoded and marked as such.
#include <algorithm>
#include <csetjmp>
#include <new>
#include <ostream>
#include <png.h>
#include <sstream>
#include <string>
#include <vector>

#include "Common/Image/Codecs.h"
#include "Common/Image/ImageIo.h"
#include "Common/Shared/Tonemap.h"

namespace rt::image {

namespace {

void writeBytes(png_structp png, png_bytep data, png_size_t size) {
    static_cast<std::ostream*>(png_get_io_ptr(png))
        ->write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
}

void flushNothing(png_structp) {}

// libpng's own prints to standard error.
[[noreturn]] void onError(png_structp png, png_const_charp) {
    png_longjmp(png, 1);
}

void onWarning(png_structp, png_const_charp) {}

// libpng leaves by longjmp when something fails, which for what is written here is want of memory; the jump passes over
// no object with a destructor, as there is none in this function and its actions.
template <class Action>
bool succeeds(png_structp png, const Action& action) {
    if (setjmp(png_jmpbuf(png)) != 0) return false;
    action();
    return true;
}

class PngWriter {
  public:
    explicit PngWriter(std::ostream& out) {
        png_ = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, onError, onWarning);
        if (png_ != nullptr) info_ = png_create_info_struct(png_);
        if (info_ == nullptr) {
            png_destroy_write_struct(&png_, nullptr);
            throw std::bad_alloc();
        }
        png_set_write_fn(png_, &out, writeBytes, flushNothing);
    }
    ~PngWriter() { png_destroy_write_struct(&png_, &info_); }
    PngWriter(const PngWriter&) = delete;
    PngWriter& operator=(const PngWriter&) = delete;

    void begin(std::uint32_t width, std::uint32_t height, std::uint32_t channels, const std::string& description) {
        constexpr int kColorTypes[] = {PNG_COLOR_TYPE_GRAY, PNG_COLOR_TYPE_GRAY_ALPHA, PNG_COLOR_TYPE_RGB,
                                       PNG_COLOR_TYPE_RGB_ALPHA};
        png_text text{};
        text.compression = PNG_ITXT_COMPRESSION_NONE;
        text.key = const_cast<char*>(kDescriptionKey); // neither is written to
        text.text = const_cast<char*>(description.c_str());
        attempt([&] {
            png_set_IHDR(png_, info_, width, height, 8, kColorTypes[channels - 1], PNG_INTERLACE_NONE,
                         PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
            png_set_sRGB_gAMA_and_cHRM(png_, info_, PNG_sRGB_INTENT_PERCEPTUAL);
            if (!description.empty()) png_set_text(png_, info_, &text, 1);
            png_write_info(png_, info_);
        });
    }
    void write(const std::uint8_t* row) {
        attempt([&] { png_write_row(png_, row); });
    }
    void end() {
        attempt([&] { png_write_end(png_, nullptr); });
    }

  private:
    template <class Action>
    void attempt(const Action& action) {
        if (!succeeds(png_, action)) throw std::bad_alloc();
    }

    png_structp png_ = nullptr;
    png_infop info_ = nullptr;
};

} // namespace

void encodePng(const ImageRows& rows, std::ostream& out, const std::string& description) {
    PngWriter writer(out);
    writer.begin(rows.width, rows.height, rows.channels, description);
    std::vector<float> linear(rows.rowValues());
    std::vector<std::uint8_t> encoded(rows.rowValues());
    for (std::uint32_t y = 0; y < rows.height; ++y) {
        rows.read(y, linear);
        std::transform(linear.begin(), linear.end(), encoded.begin(), [](float value) {
            return static_cast<std::uint8_t>(shared::srgbEncode(std::clamp(value, 0.0f, 1.0f)) * 255.0f + 0.5f);
        });
        writer.write(encoded.data());
    }
    writer.end();
}

std::vector<std::byte> toPng(std::uint32_t width, std::uint32_t height, std::uint32_t channels,
                             const std::vector<std::uint8_t>& texels) {
    std::ostringstream out;
    PngWriter writer(out);
    writer.begin(width, height, channels, {});
    for (std::uint32_t y = 0; y < height; ++y) writer.write(&texels[std::size_t{y} * width * channels]);
    writer.end();
    const std::string content = out.str();
    const auto* bytes = reinterpret_cast<const std::byte*>(content.data());
    return {bytes, bytes + content.size()};
}

} // namespace rt::image
