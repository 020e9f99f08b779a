#include "Common/Gui/Thumbnails.h"

#include <chrono>
#include <filesystem>
#include <system_error>
#include <utility>
#include <vector>

#include "Common/Core/Error.h"
#include "Common/Core/Log.h"
#include "Common/Core/Paths.h"
#include "Common/Image/ImageIo.h"

namespace rt::gui {

namespace {

namespace fs = std::filesystem;

// By their names without ".png"; where several folders of assets have one of a name, that of the first.
std::map<std::string, fs::path> picturesOf(const std::string& folder) {
    std::map<std::string, fs::path> files;
    for (const fs::path& assets : assetFolders()) {
        std::error_code error;
        for (fs::directory_iterator entry(assets / folder, error), end; !error && entry != end; entry.increment(error))
            if (entry->path().extension() == ".png") files.try_emplace(entry->path().stem().string(), entry->path());
    }
    return files;
}

} // namespace

Thumbnails::Thumbnails(GraphicsDevice& device, VkRenderPass renderPass, const std::string& folder, std::uint32_t side)
    : image_(device, renderPass), side_(side), loading_(std::async(std::launch::async, load, folder, side)) {}

Thumbnails::Sheet Thumbnails::load(const std::string& folder, std::uint32_t side) {
    Sheet sheet;
    std::vector<float> pixels;
    for (const auto& [name, file] : picturesOf(folder)) {
        try {
            const image::Image image = image::readImage(file);
            if (image.width != side || image.height != side || image.channels != 3) continue;
            sheet.places[name] = static_cast<std::uint32_t>(sheet.places.size());
            pixels.insert(pixels.end(), image.data.begin(), image.data.end());
        } catch (const Error& error) {
            logWarning(error.what()); // what it is of can be shown without
        }
    }
    if (sheet.places.empty()) return sheet;
    sheet.image = image::Image(side, side * static_cast<std::uint32_t>(sheet.places.size()));
    sheet.image.data = std::move(pixels);
    return sheet;
}

void Thumbnails::beginFrame() {
    image_.beginFrame();
    if (!loading_.valid() || loading_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return;
    Sheet sheet = loading_.get();
    if (sheet.image.width > 0) image_.set(std::move(sheet.image));
    places_ = std::move(sheet.places);
}

bool Thumbnails::draw(const std::string& name, ImVec2 corner, float side) {
    const auto place = places_.find(name);
    if (place == places_.end()) return false;
    image_.draw(corner, {side, side}, side_, place->second * side_);
    return true;
}

} // namespace rt::gui
