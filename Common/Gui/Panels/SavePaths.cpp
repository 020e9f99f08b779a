#include "Common/Gui/Panels/SavePaths.h"

#include <cctype>
#include <cstdlib>

namespace rt::gui {
namespace {

namespace fs = std::filesystem;

fs::path defaultFolder() {
    std::error_code none;
    if (const char* pictures = std::getenv("XDG_PICTURES_DIR");
        pictures != nullptr && fs::is_directory(pictures, none)) {
        return pictures;
    }
    for (const char* variable : {"HOME", "USERPROFILE"}) {
        const char* home = std::getenv(variable);
        if (home == nullptr || *home == '\0') continue;
        const fs::path pictures = fs::path(home) / "Pictures";
        return fs::is_directory(pictures, none) ? pictures : fs::path(home);
    }
    return fs::temp_directory_path(none);
}

} // namespace

std::filesystem::path saveFolder(const std::string& folder) {
    return folder.empty() ? defaultFolder() : fs::path(folder);
}

std::vector<std::string> savePaths(const std::string& folder, const app::SessionState& state, app::SavedPicture what) {
    const fs::path place = saveFolder(folder);
    std::string name = state.scene->id;
    for (char& c : name)
        if (std::isalnum(static_cast<unsigned char>(c)) == 0 && c != '-' && c != '_') c = '-';
    name += state.picture.isPreview ? "-preview" : "-" + std::to_string(state.picture.spp) + "spp";
    if (what == app::SavedPicture::Denoised) name += "-denoised";
    for (int i = 1;; ++i) {
        const fs::path png = place / (name + (i > 1 ? "-" + std::to_string(i) : "") + ".png");
        const fs::path exr = fs::path(png).replace_extension(".exr");
        std::error_code none;
        if (!fs::exists(png, none) && !fs::exists(exr, none)) return {png.string(), exr.string()};
    }
}

app::SaveRequest filesOf(const app::Options& options, float exposure, app::Tonemap tonemap) {
    return {options.outputs, options.aovs, options.stats, exposure, tonemap};
}

std::optional<app::SaveRequest> endFiles(const app::Options& options, const app::GuiSettings& settings) {
    if (options.outputs.empty() && options.stats.empty()) return std::nullopt;
    return filesOf(options, settings.exposure, settings.tonemap);
}

} // namespace rt::gui
