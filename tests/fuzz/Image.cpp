// Image files of one format, RT_FUZZ_EXTENSION: pixels, and the description that PNG and EXR hold. From memory, as
// writing and reading a file takes most of the time of small ones.
#include <span>
#include <string_view>

#include "Common/Image/Codecs.h"
#include "tests/fuzz/Fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace rt;
    constexpr std::string_view kExtension = RT_FUZZ_EXTENSION;
    static const std::filesystem::path name = "f." RT_FUZZ_EXTENSION;
    const std::span<const std::byte> bytes = std::as_bytes(std::span(data, size));
    constexpr bool kIsLinear = kExtension == "exr" || kExtension == "hdr" || kExtension == "pfm";
    if constexpr (!kIsLinear) {
        // What begins otherwise is read as the formats that it may be, which have their own targets.
        constexpr std::string_view kBegin = kExtension == "png" ? "\x89PNG" : kExtension == "bmp" ? "BM" : "";
        if (!test::textOf(data, size).starts_with(kBegin)) return -1; // not for the corpus
        // Where a few bytes may stand for many pixels, those take nearly all of the time. What is refused as too large
        // stays.
        constexpr std::size_t kMany = 1 << 12;
        const std::size_t count = image::texelCount(bytes);
        if (count > kMany && 3 * double(count) <= image::kDensest * double(size)) return -1;
    }
    // Textures of linear formats are made from images, images of the others from textures: one decodes once and tests
    // both.
    test::readOrRefuse([&] {
        if constexpr (kIsLinear)
            image::decodeTexels(bytes, name);
        else
            image::decodeImage(bytes, name);
    });
    if constexpr (kExtension == "png" || kExtension == "exr")
        test::readOrRefuse([&] { image::findDescription(bytes, name); });
    if constexpr (kExtension == "exr")
        test::readOrRefuse([&] {
            const auto layers = image::findExrLayers(bytes, name.string());
            if (!layers.empty()) image::decodeImage(bytes, name, layers.front());
        });
    return 0;
}
