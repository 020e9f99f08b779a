// The pages of all four programs, from their own parsers.
#pragma once
#include <string>
#include <vector>

#include "Common/App/Options/Options.h"
#include "Common/Bench/BenchOptions.h"
#include "Common/Manual/Formats.h"
#include "Common/Manual/Page.h"
#include "Common/Scene/Builtin/BuiltinScenes.h"
#include "Common/Tools/Image/ImageArguments.h"

namespace rt::tools {

inline std::vector<manual::Page> allPages() {
    return {app::OptionParser(app::kCpuProgram).page(), app::OptionParser(app::kGpuProgram).page(), imagePage(),
            bench::benchPage()};
}

inline std::vector<std::string> sceneIds() {
    std::vector<std::string> ids;
    for (const scene::BuiltinScene& scene : scene::builtinScenes()) ids.emplace_back(scene.id);
    return ids;
}

// docs/reference.md.
inline std::string referenceText() {
    std::string text =
        "# Reference of the flags\n\n"
        "Made from the flags themselves: `cmake --build build --target reference` writes it anew.\n\n"
        "Every program ends with one of these exit codes:\n\n| code | meaning |\n|---|---|\n";
    for (const manual::Term& code : manual::exitCodes()) text += "| " + code.name + " | " + code.help + " |\n";
    for (const manual::Page& page : allPages()) text += manual::referenceChapter(page);
    return text;
}

} // namespace rt::tools
