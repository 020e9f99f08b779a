#include "Common/Gui/Fonts.h"

#include <UiFont.h>
#include <algorithm>
#include <cmath>
#include <iterator>

namespace rt::gui {
namespace {

constexpr float kFontSize = 15; // at scale 1
// Latin, dashes, arrows, mathematical signs.
constexpr ImWchar kGlyphs[] = {0x20, 0xff, 0x2010, 0x2027, 0x2190, 0x2193, 0x2212, 0x2212, 0x2248, 0x2248, 0};

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

void addFont(ImFontAtlas& atlas, const FontFile& font, float scale) {
    const float size = std::round(kFontSize * scale);
    const ImFont* made = nullptr;
    if (!font.bytes.empty()) {
        ImFontConfig config;
        config.FontDataOwnedByAtlas = false; // which therefore only reads it
        made = atlas.AddFontFromMemoryTTF(const_cast<unsigned char*>(font.bytes.data()),
                                          static_cast<int>(font.bytes.size()), size, &config, kGlyphs);
    } else if (!font.file.empty()) {
        made = atlas.AddFontFromFileTTF(font.file.string().c_str(), size, nullptr, kGlyphs);
    }
    if (made != nullptr) return;
    ImFontConfig config;
    config.SizePixels = 13 * std::max(1.0f, std::round(scale));
    atlas.AddFontDefault(&config);
}

} // namespace rt::gui
