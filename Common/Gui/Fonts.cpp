#include "Common/Gui/Fonts.h"

#include <UiFont.h>
#include <algorithm>
#include <iterator>

namespace rt::gui {
namespace {

std::vector<FontFile> findFonts() {
    namespace fs = std::filesystem;
    const FontFile candidates[] = {
        {"Noto Sans", "/usr/share/fonts/truetype/noto/NotoSans-Regular.ttf", {}},
        {"Liberation Sans", "/usr/share/fonts/truetype/liberation/LiberationSans-Regular.ttf", {}},
        {"Roboto", "/usr/share/fonts/truetype/roboto/unhinted/RobotoTTF/Roboto-Regular.ttf", {}},
        {"Inter", "/usr/share/fonts/opentype/inter/Inter-Regular.otf", {}},
        {"DejaVu Sans Condensed", "/usr/share/fonts/truetype/dejavu/DejaVuSansCondensed.ttf", {}},
        {"DejaVu Serif", "/usr/share/fonts/truetype/dejavu/DejaVuSerif.ttf", {}},
        {"DejaVu Sans Mono", "/usr/share/fonts/truetype/dejavu/DejaVuSansMono.ttf", {}},
        {"Segoe UI", "C:/Windows/Fonts/segoeui.ttf", {}},
        {"Arial", "C:/Windows/Fonts/arial.ttf", {}},
        {"Arial", "/System/Library/Fonts/Supplemental/Arial.ttf", {}},
    };
    std::vector<FontFile> fonts;
    if (std::size(kUiFont) > 1) fonts.push_back({"DejaVu Sans", {}, kUiFont});
    for (const FontFile& font : candidates) {
        std::error_code none;
        const bool known =
            std::any_of(fonts.begin(), fonts.end(), [&](const FontFile& f) { return f.name == font.name; });
        if (!known && fs::is_regular_file(font.file, none)) fonts.push_back(font);
    }
    fonts.push_back({"ImGui", {}, {}});
    return fonts;
}

} // namespace

const std::vector<FontFile>& availableFonts() {
    static const std::vector<FontFile> fonts = findFonts();
    return fonts;
}

} // namespace rt::gui
