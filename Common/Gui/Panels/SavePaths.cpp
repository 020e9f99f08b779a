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

// Of the scene, as part of a file's name.
std::string fileNameOf(const scene::CompiledScene& scene) {
    std::string name = scene.id;
    for (char& c : name)
        if (std::isalnum(static_cast<unsigned char>(c)) == 0 && c != '-' && c != '_') c = '-';
    return name;
}

// A .png, with a number behind the name where there is one already, or a file with the other extension beside it.
fs::path unusedPath(const fs::path& name, const char* otherExtension) {
    for (int i = 1;; ++i) {
        fs::path png = name;
        png += (i > 1 ? "-" + std::to_string(i) : "") + ".png";
        std::error_code none;
        if (!fs::exists(png, none) && !fs::exists(fs::path(png).replace_extension(otherExtension), none)) return png;
    }
}

} // namespace

std::filesystem::path saveFolder(const std::string& folder) {
    return folder.empty() ? defaultFolder() : fs::path(folder);
}

std::vector<std::string> savePaths(const std::string& folder, const app::SessionState& state, app::SavedPicture what) {
    std::string name = fileNameOf(*state.scene);
    name += state.picture.isPreview ? "-preview" : "-" + std::to_string(state.picture.spp) + "spp";
    if (what == app::SavedPicture::Denoised) name += "-denoised";
    const fs::path png = unusedPath(saveFolder(folder) / name, ".exr");
    return {png.string(), fs::path(png).replace_extension(".exr").string()};
}

std::string probePath(const std::string& folder, const app::SessionState& state,
                      const std::array<std::uint32_t, 2>& pixel) {
    const std::string name =
        fileNameOf(*state.scene) + "-probe-" + std::to_string(pixel[0]) + "-" + std::to_string(pixel[1]);
    return unusedPath(saveFolder(folder) / name, ".json").string();
}

app::SaveRequest filesOf(const app::Options& options, float exposure, app::Tonemap tonemap) {
    return {options.outputs, options.aovs, options.stats, exposure, tonemap};
}

std::optional<app::SaveRequest> endFiles(const app::Options& options, const app::GuiSettings& settings) {
    if (options.outputs.empty() && options.stats.empty()) return std::nullopt;
    return filesOf(options, settings.exposure, settings.tonemap);
}

} // namespace rt::gui
