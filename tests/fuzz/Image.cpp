// Image files of one format, RT_FUZZ_EXTENSION: as images, as textures, and the description that they hold.
#include "Common/Image/ImageIo.h"
#include "tests/fuzz/Fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace rt;
    const auto file = test::fuzzFolder().write("f." RT_FUZZ_EXTENSION, test::textOf(data, size));
    test::readOrRefuse([&] { image::readImage(file); });
    test::readOrRefuse([&] { image::loadTexels(file); });
    test::readOrRefuse([&] { image::readDescription(file); });
    return 0;
}
