// The text of the windows' settings file: never an error, and what is read is kept as it is.
#include <cstdlib>

#include "Common/App/Interactive/GuiSettings.h"
#include "tests/fuzz/Fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace rt;
    const app::GuiSettings settings = app::parseGuiSettings(test::textOf(data, size));
    if (settings == app::GuiSettings()) return 0; // as of most inputs, and writing takes longer than reading
    if (app::parseGuiSettings(app::toText(settings)) != settings) std::abort();
    return 0;
}
