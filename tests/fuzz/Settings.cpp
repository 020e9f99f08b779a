// The windows' settings file: never an error, and what is read can be kept.
#include "Common/App/Interactive/GuiSettings.h"
#include "tests/fuzz/Fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace rt;
    const auto file = test::fuzzFolder().write("settings.json", test::textOf(data, size));
    const app::GuiSettings settings = app::loadGuiSettings(file);
    app::saveGuiSettings(file, settings);
    app::loadGuiSettings(file);
    return 0;
}
