#include "Common/Gui/Fonts.h"

#include <algorithm>

namespace rt::gui {
namespace {

std::vector<FontFile> findFonts() {
    namespace fs = std::filesystem;
    const FontFile candidates[] = {
        {"Inter", "/usr/share/fonts/opentype/inter/Inter-Regular.otf"},
        {"DejaVu Sans", "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf"},
        {"DejaVu Sans", "/usr/share/fonts/TTF/DejaVuSans.ttf"},
        {"Noto Sans", "/usr/share/fonts/truetype/noto/NotoSans-Regular.ttf"},
        {"Roboto", "/usr/share/fonts/truetype/roboto/unhinted/RobotoTTF/Roboto-Regular.ttf"},
        {"Liberation Sans", "/usr/share/fonts/truetype/liberation/LiberationSans-Regular.ttf"},
        {"DejaVu Sans Condensed", "/usr/share/fonts/truetype/dejavu/DejaVuSansCondensed.ttf"},
        {"DejaVu Serif", "/usr/share/fonts/truetype/dejavu/DejaVuSerif.ttf"},
        {"DejaVu Sans Mono", "/usr/share/fonts/truetype/dejavu/DejaVuSansMono.ttf"},
        {"Segoe UI", "C:/Windows/Fonts/segoeui.ttf"},
        {"Arial", "C:/Windows/Fonts/arial.ttf"},
        {"Arial", "/System/Library/Fonts/Supplemental/Arial.ttf"},
    };
    std::vector<FontFile> fonts;
    for (const FontFile& font : candidates) {
        std::error_code none;
        const bool known =
            std::any_of(fonts.begin(), fonts.end(), [&](const FontFile& f) { return f.name == font.name; });
        if (!known && fs::is_regular_file(font.file, none)) fonts.push_back(font);
    }
    fonts.push_back({"ImGui", {}});
    return fonts;
}

} // namespace

const std::vector<FontFile>& availableFonts() {
    static const std::vector<FontFile> fonts = findFonts();
    return fonts;
}

} // namespace rt::gui
