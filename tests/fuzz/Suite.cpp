// Suite files of the benchmark.
#include "Common/Bench/Suite.h"

#include "tests/fuzz/Fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace rt;
    test::readOrRefuse([&] { bench::parseSuite(std::string(test::textOf(data, size)), "f.json"); });
    return 0;
}
