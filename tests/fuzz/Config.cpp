// The text of configuration files.
#include "Common/App/Options/ConfigText.h"
#include "tests/fuzz/Fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace rt;
    test::readOrRefuse([&] { app::readConfigText(std::string(test::textOf(data, size)), "f.toml"); });
    return 0;
}
