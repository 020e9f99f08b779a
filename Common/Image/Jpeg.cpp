// JPEG, read by libjpeg (libjpeg-turbo in every package collection that is named in cmake/Dependencies.cmake).
#include <algorithm>
#include <array>
#include <csetjmp>
#include <cstdio> // which jpeglib.h expects
#include <vector>

#include "Common/Core/Error.h"
#include "Common/Image/Codecs.h"

// In this order: the numbers in jerror.h depend on the version that jpeglib.h states.
// clang-format off
#include <jpeglib.h>
#include <jerror.h>
// clang-format on

namespace rt::image {

namespace {

// A progressive file may add to its coefficients as often as it likes, each time to all of them: without a limit a
// small file takes hours. Encoders make about ten scans.
constexpr int kMaxScans = 100;

// Fill bytes may precede any marker (ITU-T T.81, B.1.1.2), of which libjpeg takes none before a file's first.
std::span<const std::byte> withoutFill(std::span<const std::byte> bytes) {
    const auto second = std::find_if(bytes.begin(), bytes.end(), [](std::byte b) { return b != std::byte{0xff}; });
    const auto fill = std::max<std::ptrdiff_t>(second - bytes.begin() - 1, 0);
    return bytes.subspan(static_cast<std::size_t>(fill));
}

// Of what libjpeg only warns: data that is missing or means nothing, for which it fills in grey.
bool isDamage(int code) {
    constexpr int kDamage[] = {JWRN_JPEG_EOF, JWRN_HIT_MARKER, JWRN_HUFF_BAD_CODE, JWRN_ARITH_BAD_CODE,
                               JWRN_MUST_RESYNC};
    return std::find(std::begin(kDamage), std::end(kDamage), code) != std::end(kDamage);
}

// libjpeg leaves by longjmp when something fails; the jump passes over no object with a destructor, as there is none in
// the actions that are attempted.
class JpegReader {
  public:
    explicit JpegReader(const std::string& name) : name_(name) { // which has to outlive this
        jpeg_.err = jpeg_std_error(&errors_);
        jpeg_.client_data = this;
        errors_.error_exit = [](j_common_ptr jpeg) {
            JpegReader& reader = of(jpeg);
            jpeg->err->format_message(jpeg, reader.message_.data());
            std::longjmp(reader.failed_, 1);
        };
        errors_.emit_message = [](j_common_ptr jpeg, int level) {
            if (level < 0 && isDamage(jpeg->err->msg_code)) jpeg->err->error_exit(jpeg);
        };
        progress_.progress_monitor = [](j_common_ptr jpeg) {
            if (reinterpret_cast<j_decompress_ptr>(jpeg)->input_scan_number <= kMaxScans) return;
            JpegReader& reader = of(jpeg);
            std::snprintf(reader.message_.data(), reader.message_.size(), "more than %d scans", kMaxScans);
            std::longjmp(reader.failed_, 1);
        };
    }
    ~JpegReader() { jpeg_destroy_decompress(&jpeg_); }
    JpegReader(const JpegReader&) = delete;
    JpegReader& operator=(const JpegReader&) = delete;

    void readHeader(std::span<const std::byte> bytes) {
        attempt([&] {
            jpeg_create_decompress(&jpeg_);
            jpeg_.progress = &progress_;
            jpeg_mem_src(&jpeg_, reinterpret_cast<const unsigned char*>(bytes.data()),
                         static_cast<unsigned long>(bytes.size()));
            jpeg_read_header(&jpeg_, TRUE);
        });
    }

    std::uint32_t width() const { return jpeg_.image_width; }
    std::uint32_t height() const { return jpeg_.image_height; }

    // Four inks, as presses use them: without a profile, light that all of them let through.
    bool hasInks() const { return jpeg_.num_components == 4; }
    // Adobe's programs store the light that an ink lets through instead of its amount.
    bool storesLight() const { return jpeg_.saw_Adobe_marker != FALSE; }

    void begin() {
        attempt([&] {
            jpeg_.out_color_space = hasInks() ? JCS_CMYK : JCS_RGB;
            jpeg_start_decompress(&jpeg_);
        });
    }
    void readRow(std::uint8_t* row) { // three or four values a pixel
        attempt([&] { jpeg_read_scanlines(&jpeg_, &row, 1); });
    }
    void end() {
        attempt([&] { jpeg_finish_decompress(&jpeg_); });
    }

  private:
    static JpegReader& of(j_common_ptr jpeg) { return *static_cast<JpegReader*>(jpeg->client_data); }

    template <class Action>
    void attempt(const Action& action) {
        if (setjmp(failed_) == 0) return action();
        throw InputError(name_ + ": cannot be read as a JPEG image: " + message_.data());
    }

    const std::string& name_;
    jpeg_decompress_struct jpeg_{};
    jpeg_error_mgr errors_{};
    jpeg_progress_mgr progress_{};
    std::jmp_buf failed_{};
    std::array<char, JMSG_LENGTH_MAX> message_{};
};

void toRgb(const std::vector<std::uint8_t>& inks, bool storesLight, std::uint8_t* rgb) {
    const auto light = [storesLight](std::uint8_t value) { return storesLight ? value : 255 - value; };
    for (auto pixel = inks.begin(); pixel != inks.end(); pixel += 4)
        for (int channel = 0; channel < 3; ++channel)
            *rgb++ = static_cast<std::uint8_t>((light(pixel[channel]) * light(pixel[3]) + 127) / 255);
}

} // namespace

bool isJpeg(std::span<const std::byte> bytes) {
    const std::span<const std::byte> begin = withoutFill(bytes);
    return begin.size() >= 2 && begin[0] == std::byte{0xff} && begin[1] == std::byte{0xd8};
}

double jpegPixels(std::span<const std::byte> bytes) try {
    const std::string name;
    JpegReader reader(name);
    reader.readHeader(withoutFill(bytes));
    return double(reader.width()) * reader.height();
} catch (const InputError&) {
    return 0;
}

Texels decodeJpeg(std::span<const std::byte> bytes, const std::string& name) {
    JpegReader reader(name);
    reader.readHeader(withoutFill(bytes));
    Texels texels;
    texels.width = reader.width();
    texels.height = reader.height();
    const std::size_t stride = std::size_t{3} * texels.width;
    checkDimensions(name, texels.width, texels.height, double(stride) * texels.height, bytes.size());
    reader.begin();
    texels.srgb8.resize(stride * texels.height);
    std::vector<std::uint8_t> inks(reader.hasInks() ? std::size_t{4} * texels.width : 0);
    for (std::uint32_t y = 0; y < texels.height; ++y) {
        std::uint8_t* row = &texels.srgb8[y * stride];
        reader.readRow(inks.empty() ? row : inks.data());
        if (!inks.empty()) toRgb(inks, reader.storesLight(), row);
    }
    reader.end();
    return texels;
}

} // namespace rt::image
