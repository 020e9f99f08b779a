#include "Common/Scene/Builtin/Placeholders.h"

#include <system_error>

#include "Common/Core/Error.h"
#include "Common/Core/OtherCase.h"
#include "Common/Core/Paths.h"

namespace rt::scene {

const std::vector<std::string>& imageStandInNames() {
    static const std::vector<std::string> names = [] {
        std::vector<std::string> all = planetMapNames();
        all.emplace_back(kWhiteStandIn);
        return all;
    }();
    return names;
}

std::optional<std::filesystem::path> locateAsset(const std::string& file, const std::string& standIn,
                                                 const CompileOptions& options, const std::string& id,
                                                 std::vector<std::string>& notices) {
    if (!standIn.empty() && standIn != kWhiteStandIn && options.generatedAssets) return std::nullopt;
    const std::filesystem::path path(file);
    std::error_code ignored;
    if (path.is_absolute() && std::filesystem::is_regular_file(path, ignored)) return path;
    if (const auto other = findInOtherCase(path); !other.empty()) {
        notices.push_back(file + ": there is no such file; read: " + other.filename().string());
        return other;
    }
    if (path.is_relative() && !path.empty())
        if (auto asset = findAsset(path)) return asset;
    if (standIn.empty())
        throw InputError(id + ": " + file + ": no such file, neither beside the scene nor among the assets");
    return std::nullopt;
}

} // namespace rt::scene
