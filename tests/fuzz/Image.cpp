// Image files of one format, RT_FUZZ_EXTENSION: as images, as textures, and the description that PNG and EXR hold. From
// memory, as writing and reading a file takes most of the time of small ones.
#include <span>
#include <string_view>

#include "Common/Image/Codecs.h"
#include "tests/fuzz/Fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace rt;
    constexpr std::string_view kExtension = RT_FUZZ_EXTENSION;
    static const std::filesystem::path name = "f." RT_FUZZ_EXTENSION;
    const std::span<const std::byte> bytes = std::as_bytes(std::span(data, size));
    test::readOrRefuse([&] { image::decodeImage(bytes, name); });
    test::readOrRefuse([&] { image::decodeTexels(bytes, name); });
    if constexpr (kExtension == "png" || kExtension == "exr")
        test::readOrRefuse([&] { image::findDescription(bytes, name); });
    return 0;
}
